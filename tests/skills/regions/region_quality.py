"""How good extracted regions are, against the boxes that were looked at."""

from dataclasses import dataclass

import cv2
import numpy as np
from block_fields import Box, View

from skills.regions import PlanarRegions


@dataclass(frozen=True)
class Quality:
    """Figures of one frame.

    Attributes:
        recalled: for each block top in sight, whether a region covers it with IoU > 0.5.
        iou, angle, offset: of the recalled ones; angle [rad], offset at the top's middle [m].
        covered: share of the area of block tops in sight that regions cover.
        wrong_height, wrong_slope: share of the regions' area that is off by > 15 mm, by > 5 degrees.
    """

    recalled: np.ndarray
    iou: np.ndarray
    angle: np.ndarray
    offset: np.ndarray
    covered: float
    wrong_height: float
    wrong_slope: float


def judge(boxes: list[Box], view: View, regions: PlanarRegions, depth_max=2.5, pixels_min=3000) -> Quality:
    """Compare polygons with the truth at every other pixel; the last region wins where several cover a pixel."""
    every = np.s_[::2, ::2]
    depth, seen_box, is_top = view.image.depth[every], view.box[every], view.is_top[every]
    inside = (depth > 0.0) & (depth < depth_max)
    owner = rasterise(view, regions)[every]
    planes = np.array([(*r.normal_world, r.normal_world @ r.T_world_region.p) for r in regions.regions]).reshape(-1, 4)
    tops = np.array([(*b.top.R[:, 2], b.top.R[:, 2] @ b.top.p) for b in boxes])
    points = back_project(view)[every]
    area = depth.astype(np.float64) ** 2

    seen = inside & (owner >= 0)
    off = np.abs(np.sum(points[seen] * planes[owner[seen], :3], axis=1) - planes[owner[seen], 3])
    facing = np.sum(planes[owner[seen], :3] * tops[seen_box[seen], :3], axis=1)
    # Seen from above, pixels on the side of a block near its edge have no area: height alone judges them.
    tilted = is_top[seen] & (facing < np.cos(np.deg2rad(5.0)))
    total = area[seen].sum() + 1e-9

    recalled, iou, angle, offset = [], [], [], []
    for k in np.unique(seen_box[inside & is_top]):
        mask = inside & is_top & (seen_box == k)
        if 4 * mask.sum() < pixels_min:
            continue
        owners, counts = np.unique(owner[mask & (owner >= 0)], return_counts=True)
        best = int(owners[np.argmax(counts)]) if len(owners) else -1
        middle = points[mask].mean(axis=0)
        # Neighbours in the same plane may share a region.
        off_top = np.abs(points @ tops[k, :3] - tops[k, 3])
        parallel = tops[:, :3] @ tops[k, :3] > np.cos(np.deg2rad(2.5))
        neutral = is_top & parallel[seen_box] & (off_top < 0.008) & ~mask
        found = (owner == best) & ~neutral & inside
        value = (found & mask).sum() / max((found | mask).sum(), 1) if best >= 0 else 0.0
        recalled.append(value > 0.5)
        if value > 0.5:
            iou.append(value)
            angle.append(np.arccos(min(planes[best, :3] @ tops[k, :3], 1.0)))
            offset.append(abs(middle @ planes[best, :3] - planes[best, 3]))
    top = inside & is_top
    return Quality(
        np.array(recalled),
        np.array(iou),
        np.array(angle),
        np.array(offset),
        float(area[top & (owner >= 0)].sum() / area[top].sum()),
        float(area[seen][off > 0.015].sum() / total),
        float(area[seen][tilted].sum() / total),
    )


def rasterise(view: View, regions: PlanarRegions) -> np.ndarray:
    """Index of the region whose outline covers each pixel, -1 where none does."""
    camera, T_camera_world = view.image.camera, view.image.T_world_camera.inverse
    owner = np.full(view.box.shape, -1, np.int32)
    for index, region in enumerate(regions.regions):
        contours = []
        for ring in (region.hull_region, *region.holes_region):
            points = T_camera_world @ (region.T_world_region @ np.column_stack((ring, np.zeros(len(ring)))))
            uv = points[:, :2] / points[:, 2:] * (camera.fx, camera.fy) + (camera.cx, camera.cy)
            contours.append(np.round(uv * 16).astype(np.int32).reshape(-1, 1, 2))
        cv2.fillPoly(owner, contours, (index,), cv2.LINE_8, 4)
    return owner


def back_project(view: View) -> np.ndarray:
    """World points of the noise-free depth, (height, width, 3)."""
    camera = view.image.camera
    v, u = np.indices(view.box.shape)
    rays = np.stack(((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, np.ones(u.shape)), axis=-1)
    points = rays * view.image.depth[..., None].astype(np.float64)
    return points @ view.image.T_world_camera.R.T + view.image.T_world_camera.p
