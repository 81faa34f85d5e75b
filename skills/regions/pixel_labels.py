"""Labels of pixels out of labels of patches.

A patch inside a region hands its label to its pixels. In the band along borders each pixel takes, of the regions in the
patches around it, the plane that the window about it fits best. A pixel is at odds where no plane fits its window
within the noise: there may be something that the patches were too coarse to see.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array
from skills.kernels import leaf_kernel
from skills.regions.plane_contest import LANES, RADIUS, PixelLabels, compete, load_block, open_contest, tolerances

PatchLabels = NDArray[np.int32]

_AROUND = 9 + 16  # patches, and patches of half their size, in which a pixel's regions are looked for


def label_pixels(
    depth: NDArray[np.float32],
    size: int,
    limits: Array,
    patch_sums: Array,
    patch_labels: PatchLabels,
    fine_labels: PatchLabels | None,
    planes: Array,
    pixel_planes: NDArray[np.float32],
    inner: NDArray[np.bool_],
    labels: PixelLabels,
    bare: PixelLabels,
) -> None:
    """Label the pixels of all patches near regions.

    Args:
        depth: the image.
        size: edge of a patch [px].
        limits: nearest and farthest valid depth, pixel offset, noise factor and the law of the noise.
        patch_sums: sums of each patch, (rows, columns, 10).
        patch_labels: region of each patch, (rows, columns); -1 for none.
        fine_labels: regions of patches of half the size, (2 rows, 2 columns); where these are given, all pixels have
            been labelled before, and only those near them are looked at.
        planes: planes of the regions, (R, 3).
        pixel_planes: the same over pixels, w = a u + b v + c, (R, 3).
        inner: out, whether all of a patch is in one region.
        labels: out, region of each pixel; -1 for none.
        bare: out, 1 where a pixel has no label or is at odds, 0 elsewhere.
    """
    rows, columns = patch_labels.shape
    again = fine_labels is not None
    tall = size + 2 * RADIUS
    _label(
        depth,
        size,
        limits,
        patch_sums,
        patch_labels,
        fine_labels if again else np.full((2 * rows, 2 * columns), -1, np.int32),
        again,
        planes,
        pixel_planes,
        np.empty(_AROUND, np.int32),
        np.empty((4, columns + 2), np.int32),
        np.zeros(tall * LANES, np.float32),
        np.tile(np.arange(LANES, dtype=np.float32), tall),
        np.repeat(np.arange(tall, dtype=np.float32), LANES),
        np.zeros(tall * LANES, np.float32),
        np.zeros(size * LANES + 2 * RADIUS, np.float32),
        np.zeros((2, size * LANES), np.float32),
        np.zeros(size * LANES, np.int16),
        inner,
        labels,
        bare,
    )


@leaf_kernel
def _label(
    depth: NDArray[np.float32],
    size: int,
    limits: Array,
    patch_sums: Array,
    patch_labels: PatchLabels,
    fine_labels: PatchLabels,
    again: bool,
    planes: Array,
    pixel_planes: NDArray[np.float32],
    candidates: NDArray[np.int32],
    survey: PatchLabels,
    block: NDArray[np.float32],
    right: NDArray[np.float32],
    down: NDArray[np.float32],
    costs: NDArray[np.float32],
    column_sums: NDArray[np.float32],
    bounds: NDArray[np.float32],
    chosen: PixelLabels,
    inner: NDArray[np.bool_],
    labels: PixelLabels,
    bare: PixelLabels,
) -> None:
    rows, columns = patch_labels.shape
    height, width = depth.shape
    near, far = np.float32(limits[0]), np.float32(limits[1])
    low, high, valid, least = survey[0], survey[1], bounds[0], bounds[1]
    for row in range(rows):
        _survey(patch_labels, row, survey)
        for column in range(columns):
            if again and not _any_fine(fine_labels, row, column):
                continue
            v0, u0 = row * size, column * size
            v1, u1 = min(v0 + size, height), min(u0 + size, width)
            uniform = low[column] == high[column] and not again
            if high[column] < 0 and not again:
                _paint(bare, 1, v0, u0, v1, u1)
                continue
            here = patch_labels[row, column]
            if uniform:
                inner[row, column] = True
                _paint(labels, here, v0, u0, v1, u1)
                continue
            count = _candidates(patch_labels, row, column, 1, 2, candidates, 0)
            if again:
                count = _candidates(fine_labels, 2 * row, 2 * column, 1, 3, candidates, count)
            s = patch_sums[row, column]
            mean_depth = s[0] / s[3] if s[0] > 0.0 else limits[0]
            cap, odd = tolerances(limits, mean_depth, mean_depth * _nearness(candidates, count, planes))
            inner[row, column] = (
                here >= 0
                and s[0] >= 0.5 * size * size
                and _spread_about(s, planes[here]) <= odd * odd
                and _apart(candidates, count, here, pixel_planes, u0, v0, size, cap)
            )
            if inner[row, column]:
                _paint(labels, here, v0, u0, v1, u1)
                continue
            per_cap, share = np.float32(1.0 / cap), np.float32((odd / cap) ** 2)
            for left in range(u0, u1, LANES - 2 * RADIUS):
                load_block(depth, v0 - RADIUS, left - RADIUS, near, far, block)
                open_contest(block, costs, column_sums, valid, least, chosen)
                for k in range(count):
                    a, b, c = pixel_planes[candidates[k]]
                    corner = a * np.float32(left - RADIUS) + b * np.float32(v0 - RADIUS) + c
                    compete(block, right, down, a, b, corner, per_cap, costs, column_sums, least, chosen, candidates[k])
                wide, first = min(LANES - 2 * RADIUS, u1 - left), np.uint64(left)
                for v in range(v0, v1):
                    start = np.uint64((v - v0) * LANES)
                    label, doubt = labels[v], bare[v]
                    for j in range(wide):
                        k = start + np.uint64(j)
                        label[first + np.uint64(j)] = chosen[k]
                        doubt[first + np.uint64(j)] = (chosen[k] < 0) | (least[k] >= share * valid[k])


@leaf_kernel
def _paint(labels: PixelLabels, label: int, v0: int, u0: int, v1: int, u1: int) -> None:
    value, first, wide = np.int16(label), np.uint64(u0), u1 - u0
    for v in range(v0, v1):
        line = labels[v]
        for j in range(wide):
            line[first + np.uint64(j)] = value


@leaf_kernel
def _spread_about(s: Array, plane: Array) -> float:
    """Mean square, over the pixels of sums, of the relative difference of inverse depth to a plane."""
    a, b, c = plane
    square = s[9] - 2.0 * (a * s[7] + b * s[8] + c * s[3]) + a * a * s[4] + b * b * s[6] + c * c * s[0]
    square += 2.0 * (a * b * s[5] + c * (a * s[1] + b * s[2]))
    return square / s[9]


@leaf_kernel
def _nearness(candidates: NDArray[np.int32], count: int, planes: Array) -> float:
    """The greatest inverse distance of the candidates' planes from the camera [1/m]."""
    square = 0.0
    for k in range(count):
        a, b, c = planes[candidates[k]]
        square = max(square, a * a + b * b + c * c)
    return np.sqrt(square)


@leaf_kernel
def _apart(
    candidates: NDArray[np.int32],
    count: int,
    here: int,
    planes: NDArray[np.float32],
    u0: int,
    v0: int,
    size: int,
    cap: float,
) -> bool:
    """Whether all candidates stay so far from one plane, over a patch and its windows, that no pixel is mistaken."""
    least = 1.5 * cap
    first, last = -RADIUS, size - 1 + RADIUS
    a, b, c = planes[here]
    for k in range(count):
        if candidates[k] == here:
            continue
        p, q, r = planes[candidates[k]]
        below, above = True, True
        for corner in range(4):
            u, v = u0 + (first if corner % 2 else last), v0 + (first if corner // 2 else last)
            w = a * u + b * v + c
            ratio = (p * u + q * v + r) / w - 1.0
            below &= ratio < -least
            above &= ratio > least
        if not (below or above):
            return False
    return True


@leaf_kernel
def _survey(labels: PatchLabels, row: int, survey: PatchLabels) -> None:
    """Least and greatest region in the 3 x 3 patches around each one of a row, into the first two rows of four."""
    rows, columns = labels.shape
    above, here, below = labels[max(row - 1, 0)], labels[row], labels[min(row + 1, rows - 1)]
    low, high, least, greatest = survey[0], survey[1], survey[2], survey[3]
    for j in range(columns):
        least[j + 1] = min(above[j], here[j], below[j])
        greatest[j + 1] = max(above[j], here[j], below[j])
    least[0], greatest[0] = least[1], greatest[1]
    least[columns + 1], greatest[columns + 1] = least[columns], greatest[columns]
    for j in range(columns):
        low[j] = min(least[j], least[j + 1], least[j + 2])
        high[j] = max(greatest[j], greatest[j + 1], greatest[j + 2])


@leaf_kernel
def _any_fine(fine_labels: PatchLabels, row: int, column: int) -> bool:
    """Whether a patch has a region in its own four quarters or in those next to them."""
    rows, columns = fine_labels.shape
    for i in range(max(2 * row - 1, 0), min(2 * row + 3, rows)):
        for j in range(max(2 * column - 1, 0), min(2 * column + 3, columns)):
            if fine_labels[i, j] >= 0:
                return True
    return False


@leaf_kernel
def _candidates(
    labels: PatchLabels, row: int, column: int, before: int, after: int, candidates: NDArray[np.int32], count: int
) -> int:
    """List the regions in the patches from so many before one to, but not with, so many after it; their number."""
    rows, columns = labels.shape
    for i in range(max(row - before, 0), min(row + after, rows)):
        for j in range(max(column - before, 0), min(column + after, columns)):
            label = labels[i, j]
            known = label < 0
            for k in range(count):
                known |= candidates[k] == label
            if not known:
                candidates[count] = label
                count += 1
    return count
