"""How good regions are, against the planar faces that a camera truly sees.

A face is found where a region's polygon covers it with an intersection over union above 0.5; pixels of other faces in
the same plane count neither for nor against. A region is false where it lies in the plane of no face that it covers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lookstep.bench.perception.fill import fill
from lookstep.bench.perception.truth import BEYOND, VOID, Truth
from skills.geometry.camera import DepthImage
from skills.geometry.pose import Array
from skills.regions import PlanarRegion, PlanarRegions

FACE_PIXELS = 1500
"""Faces with fewer visible pixels are not asked for."""
FALSE_ANGLE, FALSE_OFFSET = np.deg2rad(10.0), 0.020
"""A region further from a face than this is not of that face [rad, m]."""

_FOUND = 0.5  # intersection over union
_COVERS = 0.05  # A region covers a face that holds this share of its pixels.


@dataclass(frozen=True, slots=True, eq=False)
class Quality:
    """Figures of one frame, or of several pooled.

    Attributes:
        found: whether a region covers each face, (N,) bool.
        iou: intersection over union of the polygons of the faces found, (M,).
        angle, offset: between the planes of region and face, the offset at the face's middle, (M,) [rad, m].
        label_iou: intersection over union of the best label of each face, (N,); empty without labels.
        area: of all regions [m^2].
        false_area: of the regions that are in the plane of no face they cover [m^2].
        stray_area: of the pieces of regions over a surface that is off the region's plane [m^2].
    """

    found: NDArray[np.bool_]
    iou: Array
    angle: Array
    offset: Array
    label_iou: Array
    area: float
    false_area: float
    stray_area: float


def judge(truth: Truth, regions: PlanarRegions, labels: NDArray[np.integer] | None = None) -> Quality:
    """Compare the regions of one frame with what there was to see.

    Args:
        truth: of the frame.
        regions: found in a noisy image from the same camera pose.
        labels: region of each pixel as the extraction labelled it, (height, width); negative for none.
    """
    asked = truth.pixels >= FACE_PIXELS
    counts, middles = _overlaps(truth, regions)
    planes = _planes(regions)
    iou = _iou(counts, truth)[:, asked]
    best = iou.argmax(axis=0) if len(iou) else np.zeros(iou.shape[1], dtype=np.int64)
    best_iou = iou[best, np.arange(iou.shape[1])] if len(iou) else np.zeros(iou.shape[1])
    found = best_iou > _FOUND
    matched, faces = planes[best[found]], truth.planes[asked][found]
    angle = np.arccos(np.clip(np.einsum("ni,ni->n", matched[:, :3], faces[:, :3]), -1.0, 1.0))
    offset = np.abs(np.einsum("ni,ni->n", matched[:, :3], truth.middles[asked][found]) - matched[:, 3])
    false, stray = _false_and_stray(counts, middles, planes, truth)
    areas = np.array([region.area for region in regions.regions])
    return Quality(
        found=found,
        iou=best_iou[found],
        angle=angle,
        offset=offset,
        label_iou=np.zeros(0) if labels is None else _label_iou(truth, labels)[asked],
        area=float(areas.sum()),
        false_area=float(areas @ false),
        stray_area=float(areas @ stray),
    )


def pool(qualities: Sequence[Quality]) -> Quality:
    """The figures of several frames as if of one."""
    return Quality(
        *(np.concatenate([getattr(q, name) for q in qualities]) for name in ("found", "iou", "angle", "offset")),
        label_iou=np.concatenate([q.label_iou for q in qualities]),
        area=sum(q.area for q in qualities),
        false_area=sum(q.false_area for q in qualities),
        stray_area=sum(q.stray_area for q in qualities),
    )


def figures(quality: Quality) -> dict[str, float]:
    """The numbers to publish, by name; angles in degrees, offsets in millimetres."""
    angle, offset = np.rad2deg(quality.angle), 1e3 * quality.offset
    table = {
        "recall": quality.found.mean() if len(quality.found) else np.nan,
        "iou": _percentile(quality.iou, 50),
        "label_iou": _percentile(quality.label_iou, 50),
        "normal_deg_median": _percentile(angle, 50),
        "normal_deg_p90": _percentile(angle, 90),
        "offset_mm_median": _percentile(offset, 50),
        "offset_mm_p90": _percentile(offset, 90),
        "false_area": quality.false_area / max(quality.area, 1e-12),
        "stray_area": quality.stray_area / max(quality.area, 1e-12),
        "faces": len(quality.found),
    }
    return {name: float(value) for name, value in table.items()}


def region_mask(region: PlanarRegion, image: DepthImage) -> tuple[NDArray[np.bool_], int, int]:
    """The pixels whose centres a region's polygon covers: a window of the image, its first row and first column."""
    camera, T_camera_region = image.camera, image.T_world_camera.inverse @ region.T_world_region
    rings = []
    for ring in (region.hull_region, *region.holes_region):
        points = T_camera_region @ np.column_stack((ring, np.zeros(len(ring))))
        ahead = np.maximum(points[:, 2:], camera.near)
        rings.append(points[:, :2] / ahead * (camera.fx, camera.fy) + (camera.cx, camera.cy))
    return fill(rings, (camera.height, camera.width))


def _planes(regions: PlanarRegions) -> Array:
    """Unit normal and offset of each region, as in `Truth`, (R, 4)."""
    poses = [region.T_world_region for region in regions.regions]
    return np.array([(*pose.R[:, 2], pose.R[:, 2] @ pose.p) for pose in poses]).reshape(-1, 4)


def _overlaps(truth: Truth, regions: PlanarRegions) -> tuple[NDArray[np.int64], Array]:
    """Pixels that each region shares with each face, (R, F + 1), the last column with nothing; and their mean points.

    Pixels that are too deep to be judged count nowhere.
    """
    shape = (len(regions.regions), len(truth.planes) + 2)
    counts, sums = np.zeros(shape, dtype=np.int64), np.zeros((*shape, 3))
    for index, region in enumerate(regions.regions):
        mask, row, column = region_mask(region, truth.image)
        window = np.s_[row : row + mask.shape[0], column : column + mask.shape[1]]
        face = truth.face[window][mask] - BEYOND
        points = truth.points[window][mask]
        counts[index] = np.bincount(face, minlength=shape[1])
        for k in range(3):
            sums[index, :, k] = np.bincount(face, points[:, k], shape[1])
    order = [*range(2, shape[1]), VOID - BEYOND]
    counts, sums = counts[:, order], sums[:, order]
    return counts, sums / np.maximum(counts, 1)[..., None]


def _iou(counts: NDArray[np.int64], truth: Truth) -> Array:
    """Intersection over union of each region and each face, (R, F)."""
    shared = counts[:, :-1]
    own = counts.sum(axis=1, keepdims=True) - shared @ (truth.same_plane & ~np.eye(len(truth.planes), dtype=np.bool_))
    return shared / np.maximum(own + truth.pixels - shared, 1)


def _label_iou(truth: Truth, labels: NDArray[np.integer]) -> Array:
    """Intersection over union of the best label of each face, (F,)."""
    width = len(truth.planes) + 2
    judged = labels >= 0
    pairs = labels[judged].astype(np.int64) * width + (truth.face[judged] - BEYOND)
    counts = np.bincount(pairs, minlength=width * (int(labels.max(initial=0)) + 1)).reshape(-1, width)
    return _iou(counts[:, [*range(2, width), VOID - BEYOND]], truth).max(axis=0)


def _false_and_stray(counts: NDArray[np.int64], middles: Array, planes: Array, truth: Truth) -> tuple[Array, Array]:
    """Whether each region is false (R,), and the share of it that lies over something else (R,)."""
    total = counts.sum(axis=1)
    cosine = planes[:, :3] @ truth.planes[:, :3].T
    off = np.abs(np.einsum("rfi,ri->rf", middles[:, :-1], planes[:, :3]) - planes[:, 3:])
    of_face = (cosine >= np.cos(FALSE_ANGLE)) & (off <= FALSE_OFFSET)
    covers = counts[:, :-1] >= _COVERS * total[:, None]
    # A region beyond the judged depth, or thinner than a pixel, says nothing.
    false = (total > 0) & ~(of_face & covers).any(axis=1)
    stray = 1.0 - (counts[:, :-1] * of_face).sum(axis=1) / np.maximum(total, 1)
    return false.astype(np.float64), np.where(total > 0, stray, 0.0)


def _percentile(values: Array, percent: float) -> float:
    return float(np.percentile(values, percent)) if len(values) else np.nan
