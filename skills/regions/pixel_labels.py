"""Labels of pixels out of labels of patches.

A patch inside a region hands its label to its pixels. In the band along borders each pixel takes, of the regions in the
3 x 3 patches around it, the plane that the 5 x 5 window about it fits best. What a pixel adds to a window's misfit is
capped: across a depth edge the majority wins, exactly at a straight one; along a crease the misfits of two planes cross
where the planes do, and the window averages the noise away. A pixel is at odds where no plane fits its window within
the noise: there may be something that the patches were too coarse to see.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array
from skills.kernels import leaf_kernel
from skills.regions.noise_level import depth_noise

PixelLabels = NDArray[np.int16]
PatchLine = NDArray[np.int32]
LANES = 12  # pixels of a row that are worked on at a time: patches of eight with their windows
RADIUS = 2  # of the window about a pixel [px]; its sums are written out for five columns and rows
_VALID_MIN = 4.5  # a window with fewer valid pixels gives no label
_BARE = 0.5  # share of the cap above which no plane fits: most of the window is elsewhere


def label_pixels(
    depth: NDArray[np.float32],
    size: int,
    limits: Array,
    patch_sums: Array,
    patch_labels: NDArray[np.int32],
    planes: Array,
    pixel_planes: NDArray[np.float32],
    inner: NDArray[np.bool_],
    labels: PixelLabels,
    bare: PixelLabels,
) -> None:
    """Label the pixels of all patches near the last layer of regions.

    Args:
        depth: the image.
        size: edge of a patch [px].
        limits: nearest and farthest valid depth, pixel offset, noise factor and the law of the noise.
        patch_sums: sums of each patch, (rows, columns, 10).
        patch_labels: one or two layers of regions, (layers, rows, columns).
        planes: planes of the regions, (R, 3).
        pixel_planes: the same over pixels, w = a u + b v + c, (R, 3).
        inner: out, whether all of a patch is in one region.
        labels: out, region of each pixel; -1 for none.
        bare: out, 1 where a pixel has no label or is at odds, 0 elsewhere.
    """
    layers, _, columns = patch_labels.shape
    tall = size + 2 * RADIUS
    _label(
        depth,
        size,
        limits,
        patch_sums,
        patch_labels,
        planes,
        pixel_planes,
        np.empty(9 * layers, np.int32),
        np.empty((2, columns + 2), np.int32),
        np.empty((2, layers, columns), np.int32),
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
    patch_labels: NDArray[np.int32],
    planes: Array,
    pixel_planes: NDArray[np.float32],
    candidates: NDArray[np.int32],
    work: NDArray[np.int32],
    extremes: NDArray[np.int32],
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
    """Blocks of a few rows of LANES pixels lie in memory in one piece, so that each loop over them runs in vectors."""
    layers, rows, columns = patch_labels.shape
    height, width = depth.shape
    near, far = np.float32(limits[0]), np.float32(limits[1])
    low, high, least, odd = extremes[0], extremes[1], bounds[0], bounds[1]
    for row in range(rows):
        for layer in range(layers):
            _survey(patch_labels[layer], row, work, low[layer], high[layer])
        for column in range(columns):
            lowest, highest = low[layers - 1, column], high[layers - 1, column]
            uniform = lowest == highest
            if layers > 1:
                uniform &= (low[0, column] == high[0, column]) & ((lowest >= 0) != (low[0, column] >= 0))
            v0, u0 = row * size, column * size
            v1, u1 = min(v0 + size, height), min(u0 + size, width)
            if highest < 0:
                if layers == 1:
                    _paint(bare, 1, v0, u0, v1, u1)
                continue
            here = max(patch_labels[0, row, column], patch_labels[layers - 1, row, column])
            s = patch_sums[row, column]
            mean_depth = s[0] / s[3] if s[0] > 0.0 else limits[0]
            cap, none, none_sure = _misfits(limits, mean_depth)
            count = 0
            if not uniform:
                count = _candidates(patch_labels, row, column, candidates)
                if here >= 0 and s[0] >= 0.5 * size * size and s[9] > 0.0:
                    uniform = _spread_about(s, planes[here]) <= none_sure and _apart(
                        candidates, count, here, pixel_planes, u0, v0, size, cap
                    )
            inner[row, column] = uniform
            if uniform:
                _paint(labels, here, v0, u0, v1, u1)
                continue
            for left in range(u0, u1, LANES - 2 * RADIUS):
                _load(depth, v0 - RADIUS, left - RADIUS, near, far, block)
                _start(block, none, none_sure, costs, column_sums, least, odd, chosen)
                for k in range(count):
                    a, b, c = pixel_planes[candidates[k]]
                    corner = a * np.float32(left - RADIUS) + b * np.float32(v0 - RADIUS) + c
                    _compete(block, right, down, a, b, corner, cap, costs, column_sums, least, chosen, candidates[k])
                wide, first = min(LANES - 2 * RADIUS, u1 - left), np.uint64(left)
                for v in range(v0, v1):
                    start = np.uint64((v - v0) * LANES)
                    label, doubt = labels[v], bare[v]
                    for j in range(wide):
                        k = start + np.uint64(j)
                        label[first + np.uint64(j)] = chosen[k]
                        doubt[first + np.uint64(j)] = (chosen[k] < 0) | (least[k] >= odd[k])


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
def _apart(
    candidates: NDArray[np.int32],
    count: int,
    here: int,
    planes: NDArray[np.float32],
    u0: int,
    v0: int,
    size: int,
    cap: np.float32,
) -> bool:
    """Whether all candidates stay so far from one plane, over a patch and its windows, that no pixel is mistaken."""
    least = 1.5 * np.sqrt(cap)
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
def _misfits(limits: Array, depth: float) -> tuple[np.float32, np.float32, np.float32]:
    """Squares of relative depth error: the cap, the mean that leaves a pixel bare, the mean that puts it at odds."""
    offset, factor = limits[2], limits[3]
    pixel, shared = depth_noise(limits[4:], depth, 1.0), depth_noise(limits[4:], depth, 1e12)
    cap = (offset + factor * pixel) ** 2
    spread = 1.0 + factor * np.sqrt(2.0) / (2 * RADIUS + 1)  # of a mean of squares over a window
    odd = offset * offset + spread * (pixel * pixel - shared * shared) + (factor * shared) ** 2
    scale = 1.0 / (depth * depth)
    return np.float32(cap * scale), np.float32(_BARE * cap * scale), np.float32(odd * scale)


@leaf_kernel
def _survey(labels: NDArray[np.int32], row: int, work: NDArray[np.int32], low: PatchLine, high: PatchLine) -> None:
    """Least and greatest region in the 3 x 3 patches around each one of a row; work is room for (2, columns + 2)."""
    rows, columns = labels.shape
    above, here, below = labels[max(row - 1, 0)], labels[row], labels[min(row + 1, rows - 1)]
    least, greatest = work[0], work[1]
    for j in range(columns):
        least[j + 1] = min(above[j], here[j], below[j])
        greatest[j + 1] = max(above[j], here[j], below[j])
    least[0], greatest[0] = least[1], greatest[1]
    least[columns + 1], greatest[columns + 1] = least[columns], greatest[columns]
    for j in range(columns):
        low[j] = min(least[j], least[j + 1], least[j + 2])
        high[j] = max(greatest[j], greatest[j + 1], greatest[j + 2])


@leaf_kernel
def _candidates(patch_labels: NDArray[np.int32], row: int, column: int, candidates: NDArray[np.int32]) -> int:
    """List the regions in the 3 x 3 patches around one; their number."""
    layers, rows, columns = patch_labels.shape
    count = 0
    for layer in range(layers):
        for i in range(max(row - 1, 0), min(row + 2, rows)):
            for j in range(max(column - 1, 0), min(column + 2, columns)):
                label = patch_labels[layer, i, j]
                known = label < 0
                for k in range(count):
                    known |= candidates[k] == label
                if not known:
                    candidates[count] = label
                    count += 1
    return count


@leaf_kernel
def _load(
    depth: NDArray[np.float32], top: int, left: int, near: np.float32, far: np.float32, block: NDArray[np.float32]
) -> None:
    """Copy a block of depth; 0 where there is none."""
    height, width = depth.shape
    zero = np.float32(0.0)
    for i in range(block.shape[0] // LANES):
        v, first = top + i, i * LANES
        if v < 0 or v >= height:
            for j in range(LANES):
                block[first + j] = zero
        elif left >= 0 and left + LANES <= width:
            line, start, target = depth[v], np.uint64(left), np.uint64(first)
            for j in range(LANES):
                z = line[start + np.uint64(j)]
                block[target + np.uint64(j)] = z if (z >= near) & (z <= far) else zero
        else:
            for j in range(LANES):
                u = left + j
                z = depth[v, u] if u >= 0 and u < width else zero
                block[first + j] = z if (z >= near) & (z <= far) else zero


@leaf_kernel
def _start(
    block: NDArray[np.float32],
    none: np.float32,
    none_sure: np.float32,
    costs: NDArray[np.float32],
    column_sums: NDArray[np.float32],
    least: NDArray[np.float32],
    odd: NDArray[np.float32],
    chosen: NDArray[np.int16],
) -> None:
    """What misfit leaves pixels without a label and what puts them at odds; no label fits where few are valid."""
    zero, one, bare = np.float32(0.0), np.float32(1.0), np.int16(-1)
    enough, refused = np.float32(_VALID_MIN), np.float32(-1.0)
    full = True
    for k in range(block.shape[0]):
        full &= block[k] > zero
        costs[k] = one if block[k] > zero else zero
    if full:
        window = np.float32((2 * RADIUS + 1) ** 2)
        for k in range(least.shape[0]):
            least[k], odd[k], chosen[k] = none * window, none_sure * window, bare
        return
    _add_rows(costs, column_sums)
    for k in range(least.shape[0]):
        valid = column_sums[k] + column_sums[k + 1] + column_sums[k + 2] + column_sums[k + 3] + column_sums[k + 4]
        least[k] = none * valid if valid >= enough else refused
        odd[k] = none_sure * valid
        chosen[k] = bare


@leaf_kernel
def _compete(
    block: NDArray[np.float32],
    right: NDArray[np.float32],
    down: NDArray[np.float32],
    a: np.float32,
    b: np.float32,
    corner: np.float32,
    cap: np.float32,
    costs: NDArray[np.float32],
    column_sums: NDArray[np.float32],
    least: NDArray[np.float32],
    chosen: NDArray[np.int16],
    label: int,
) -> None:
    """Give a label to the pixels whose windows its plane fits better than any before."""
    zero, one, mine = np.float32(0.0), np.float32(1.0), np.int16(label)
    for k in range(block.shape[0]):
        z = block[k]
        off = z * (a * right[k] + b * down[k] + corner) - one
        square = off * off
        square = square if square < cap else cap
        costs[k] = square if z > zero else zero
    _add_rows(costs, column_sums)
    for k in range(least.shape[0]):
        cost = column_sums[k] + column_sums[k + 1] + column_sums[k + 2] + column_sums[k + 3] + column_sums[k + 4]
        better = cost < least[k]
        least[k] = cost if better else least[k]
        chosen[k] = mine if better else chosen[k]


@leaf_kernel
def _add_rows(costs: NDArray[np.float32], column_sums: NDArray[np.float32]) -> None:
    """Sums of five rows each."""
    for k in range(costs.shape[0] - 4 * LANES):
        column_sums[k] = (
            costs[k] + costs[k + LANES] + costs[k + 2 * LANES] + costs[k + 3 * LANES] + costs[k + 4 * LANES]
        )
