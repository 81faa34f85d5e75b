"""Labels of pixels, and planes fitted once more to them.

A patch inside a region hands its label to its pixels. In the band along borders each pixel takes, of the regions in the
3 x 3 patches around it, the plane that a small window about it fits best. What a pixel adds to the window's misfit is
capped at a tolerance: across a depth edge the majority wins, exactly at a straight one; along a crease, where two
planes meet, the misfits cross where the planes do, and the window averages the noise away. The planes are then fitted
again to all pixels but those next to a border, patch by patch inside a region.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skills.geometry.camera import DepthImage
from skills.geometry.pose import Array
from skills.kernels import kernel
from skills.regions.growing import PatchRegions
from skills.regions.parameters import RegionParameters
from skills.regions.patches import SUMS, Patches, fit_plane, intrinsics, off_plane

PixelLabels = NDArray[np.int16]
_EROSION = 2  # pixels this near to another label are left out of the last fit [px]


@dataclass(frozen=True, slots=True, eq=False)
class Segmentation:
    """Which pixel belongs to which plane.

    Attributes:
        labels: index into planes for each pixel, (height, width) int16; -1 for none.
        planes: plane of each region, (R, 3) [1/m], as in `Patches`.
        sigma: spread of each region's pixels about its plane, (R,) [m].
        bend: spread of the means of its inner patches about its plane, (R,) [m]; infinite where it has no plane.
    """

    labels: PixelLabels
    planes: Array
    sigma: Array
    bend: Array


def refine_regions(
    image: DepthImage, patches: Patches, coarse: PatchRegions, parameters: RegionParameters
) -> Segmentation:
    """Label the pixels of an image whose patches are labelled, and fit the planes to them."""
    lens = intrinsics(image.camera)
    labels = np.full(image.depth.shape, -1, dtype=np.int16)
    limits = np.array([image.camera.near, min(image.camera.far, parameters.depth_max), parameters.pixel_offset])
    inner = np.zeros(coarse.labels.shape, dtype=np.bool_)
    pixel_planes = _planes_in_pixels(coarse.planes, lens)
    _label_pixels(image.depth, patches.size, limits, patches.sums, coarse.labels, pixel_planes, inner, labels)
    planes, sigma, bend = coarse.planes.copy(), np.zeros(len(coarse.planes)), np.zeros(len(coarse.planes))
    sums = np.zeros((len(planes), SUMS))
    _sum_inner(patches.sums, coarse.labels, inner, sums)
    _sum_band(image.depth, patches.size, limits, lens, inner, labels, pixel_planes, sums)
    _refit(patches.sums, coarse.labels, inner, sums, planes, sigma, bend)
    return Segmentation(labels, planes, sigma, bend)


def _planes_in_pixels(planes: Array, lens: Array) -> NDArray[np.float32]:
    """Planes as inverse depth over pixel coordinates, w = a u + b v + c, (R, 3)."""
    fx, fy, cx, cy = lens
    a, b = planes[:, 0] / fx, planes[:, 1] / fy
    return np.column_stack((a, b, planes[:, 2] - a * cx - b * cy)).astype(np.float32)


@kernel
def _label_pixels(
    depth: NDArray[np.float32],
    size: int,
    limits: Array,
    patch_sums: Array,
    patch_labels: NDArray[np.int32],
    planes: NDArray[np.float32],
    inner: NDArray[np.bool_],
    labels: PixelLabels,
) -> None:
    """Label the pixels of patches that have a region or a neighbour with one; tell which patches are inner ones."""
    rows, columns = patch_labels.shape
    height, width = depth.shape
    radius = max(size // 4, 1)
    candidates = np.empty(9, np.int32)
    edge = size + 2 * radius
    costs = np.empty((9, edge, edge), np.float32)
    valid = np.empty((edge, edge), np.float32)
    column_sums = np.empty((10, edge), np.float32)
    near, far = np.float32(limits[0]), np.float32(limits[1])
    one, zero = np.float32(1.0), np.float32(0.0)
    for row in range(rows):
        for column in range(columns):
            count, uniform = 0, True
            here = patch_labels[row, column]
            for i in range(max(row - 1, 0), min(row + 2, rows)):
                for j in range(max(column - 1, 0), min(column + 2, columns)):
                    label = patch_labels[i, j]
                    uniform &= label == here
                    known = label < 0
                    for k in range(count):
                        known |= candidates[k] == label
                    if not known:
                        candidates[count] = label
                        count += 1
            if count == 0:
                continue
            v0, u0 = row * size, column * size
            v1, u1 = min(v0 + size, height), min(u0 + size, width)
            if uniform:
                inner[row, column] = True
                for v in range(v0, v1):
                    for u in range(u0, u1):
                        labels[v, u] = here
                continue
            top, left = max(v0 - radius, 0), max(u0 - radius, 0)
            bottom, right = min(v1 + radius, height), min(u1 + radius, width)
            deepest = patch_sums[row, column, 0] / patch_sums[row, column, 3] if patch_sums[row, column, 3] > 0 else 1.0
            cap = np.float32((limits[2] / deepest) ** 2)
            for v in range(top, bottom):
                for u in range(left, right):
                    z = depth[v, u]
                    valid[v - top, u - left] = one if (z >= near) & (z <= far) else zero
            for k in range(count):
                a, b, c = planes[candidates[k]]
                for v in range(top, bottom):
                    base = b * np.float32(v) + c
                    for u in range(left, right):
                        f = depth[v, u] * (a * np.float32(u) + base) - one
                        e = min(f * f, cap)
                        costs[k, v - top, u - left] = e if valid[v - top, u - left] > zero else zero
            _choose(
                candidates,
                count,
                costs,
                valid,
                cap,
                radius,
                (top, left, bottom, right),
                (v0, u0, v1, u1),
                column_sums,
                labels,
            )


@kernel
def _choose(
    candidates: NDArray[np.int32],
    count: int,
    costs: NDArray[np.float32],
    valid: NDArray[np.float32],
    cap: np.float32,
    radius: int,
    outer: tuple[int, int, int, int],
    box: tuple[int, int, int, int],
    column_sums: NDArray[np.float32],
    labels: PixelLabels,
) -> None:
    """Give each pixel of a patch the candidate that the window about it fits best."""
    top, left, bottom, right = outer
    v0, u0, v1, u1 = box
    zero = np.float32(0.0)
    wide = right - left
    for k in range(count + 1):
        for j in range(wide):
            column_sums[k, j] = zero
    added = top
    for v in range(v0, v1):
        while added < min(v + radius + 1, bottom):
            for k in range(count):
                for j in range(wide):
                    column_sums[k, j] += costs[k, added - top, j]
            for j in range(wide):
                column_sums[count, j] += valid[added - top, j]
            added += 1
        gone = v - radius - 1
        if gone >= top:
            for k in range(count):
                for j in range(wide):
                    column_sums[k, j] -= costs[k, gone - top, j]
            for j in range(wide):
                column_sums[count, j] -= valid[gone - top, j]
        for u in range(u0, u1):
            first, last = max(u - radius, left) - left, min(u + radius + 1, right) - left
            total = zero
            for j in range(first, last):
                total += column_sums[count, j]
            if total < 4.5:
                continue
            least = np.float32(0.5) * cap * total
            for k in range(count):
                cost = zero
                for j in range(first, last):
                    cost += column_sums[k, j]
                if cost < least:
                    least = cost
                    labels[v, u] = candidates[k]


@kernel
def _sum_inner(patch_sums: Array, patch_labels: NDArray[np.int32], inner: NDArray[np.bool_], sums: Array) -> None:
    for row in range(inner.shape[0]):
        for column in range(inner.shape[1]):
            if inner[row, column]:
                s = sums[patch_labels[row, column]]
                for k in range(10):
                    s[k] += patch_sums[row, column, k]


@kernel
def _sum_band(
    depth: NDArray[np.float32],
    size: int,
    limits: Array,
    lens: Array,
    inner: NDArray[np.bool_],
    labels: PixelLabels,
    planes: NDArray[np.float32],
    sums: Array,
) -> None:
    """Add the pixels of the band that lie in their region's plane and next to no border."""
    rows, columns = inner.shape
    height, width = depth.shape
    for row in range(rows):
        for column in range(columns):
            if inner[row, column]:
                continue
            for v in range(max(row * size, _EROSION), min((row + 1) * size, height - _EROSION)):
                y = (v - lens[3]) / lens[1]
                for u in range(max(column * size, _EROSION), min((column + 1) * size, width - _EROSION)):
                    label = labels[v, u]
                    z = depth[v, u]
                    if label < 0 or not (z >= limits[0] and z <= limits[1]):
                        continue
                    if (
                        labels[v - _EROSION, u] != label
                        or labels[v + _EROSION, u] != label
                        or labels[v, u - _EROSION] != label
                        or labels[v, u + _EROSION] != label
                    ):
                        continue
                    f = z * (planes[label, 0] * u + planes[label, 1] * v + planes[label, 2]) - 1.0
                    if abs(f) * z > limits[2]:
                        continue
                    w, x = 1.0 / z, (u - lens[2]) / lens[0]
                    s = sums[label]
                    s[0] += 1.0
                    s[1] += x
                    s[2] += y
                    s[3] += w
                    s[4] += x * x
                    s[5] += x * y
                    s[6] += y * y
                    s[7] += x * w
                    s[8] += y * w
                    s[9] += w * w


@kernel
def _refit(
    patch_sums: Array,
    patch_labels: NDArray[np.int32],
    inner: NDArray[np.bool_],
    sums: Array,
    planes: Array,
    sigma: Array,
    bend: Array,
) -> None:
    plane = np.empty(3)
    count = np.zeros(len(planes))
    for label in range(planes.shape[0]):
        sigma[label] = fit_plane(sums[label], plane)
        if np.isfinite(sigma[label]):
            for k in range(3):
                planes[label, k] = plane[k]
    for row in range(inner.shape[0]):
        for column in range(inner.shape[1]):
            if inner[row, column] and patch_sums[row, column, 0] > 0.0:
                label = patch_labels[row, column]
                count[label] += 1.0
                bend[label] += off_plane(patch_sums[row, column], planes[label]) ** 2
    for label in range(planes.shape[0]):
        bend[label] = np.sqrt(bend[label] / max(count[label], 1.0)) if np.isfinite(sigma[label]) else np.inf
