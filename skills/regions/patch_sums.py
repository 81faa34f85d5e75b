"""Sums over the pixels of patches, from which planes follow in closed form.

The columns of some patches are summed down side by side, in vectors over neighbouring pixels; then each patch adds up
its columns. Offsets within the patch and differences to one pixel are small enough for single precision.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array
from skills.kernels import leaf_kernel

LANES = 64  # columns of pixels that are summed side by side; the largest patch is no wider
_L1, _L2, _L3, _L4, _L5 = (np.uint64(k * LANES) for k in range(1, 6))


@leaf_kernel
def sum_patches(
    depth: NDArray[np.float32],
    lens: Array,
    near: float,
    far: float,
    size: int,
    lanes: NDArray[np.float32],
    reference: NDArray[np.float32],
    sums: Array,
) -> None:
    """Sum down the columns of some patches side by side first: that loop runs over neighbouring pixels, in vectors."""
    height, width = depth.shape
    nearest, farthest = np.float32(near), np.float32(far)
    one, zero = np.float32(1.0), np.float32(0.0)
    chunk = LANES // size * size
    for row in range(sums.shape[0]):
        v0, v1 = row * size, min((row + 1) * size, height)
        for left in range(0, width, chunk):
            wide, first = min(chunk, width - left), np.uint64(left)
            # Differences to a pixel of the patch are small, so that single precision holds their squares.
            for j in range(0, wide, size):
                last = min(j + size, wide)
                z = depth[v0, left + (j + last) // 2]
                w = one / z if (z >= nearest) & (z <= farthest) else zero
                for k in range(j, last):
                    reference[k] = w
            for k in range(6 * LANES):
                lanes[k] = zero
            if _all_valid(depth, v0, v1, left, wide, nearest, farthest):
                for v in range(v0, v1):
                    line, i = depth[v], np.float32(v - v0)
                    for j in range(wide):
                        off = one / line[first + np.uint64(j)] - reference[j]
                        lanes[3 * LANES + j] += off
                        lanes[4 * LANES + j] += i * off
                        lanes[5 * LANES + j] += off * off
                for j in range(0, wide, size):
                    stop = min(j + size, wide)
                    w, s = np.float64(reference[j]), sums[row, (left + j) // size]
                    _add_full_lanes(lanes, j, stop, v1 - v0, left + j, v0, lens, w, s)
                continue
            for v in range(v0, v1):
                line, i = depth[v], np.float32(v - v0)
                for j in range(wide):
                    z = line[first + np.uint64(j)]
                    valid = (z >= nearest) & (z <= farthest)
                    m = one if valid else zero
                    off = one / z - reference[j] if valid else zero
                    lanes[j] += m
                    lanes[LANES + j] += i * m
                    lanes[2 * LANES + j] += i * i * m
                    lanes[3 * LANES + j] += off
                    lanes[4 * LANES + j] += i * off
                    lanes[5 * LANES + j] += off * off
            for j in range(0, wide, size):
                stop = min(j + size, wide)
                add_lanes(lanes, j, stop, left + j, v0, lens, np.float64(reference[j]), sums[row, (left + j) // size])


@leaf_kernel
def _all_valid(
    depth: NDArray[np.float32], v0: int, v1: int, left: int, wide: int, nearest: np.float32, farthest: np.float32
) -> bool:
    """Whether no pixel of a box is too near, too far or without depth."""
    first, valid = np.uint64(left), True
    for v in range(v0, v1):
        line = depth[v]
        for j in range(wide):
            z = line[first + np.uint64(j)]
            valid &= (z >= nearest) & (z <= farthest)
    return valid


@leaf_kernel
def add_lanes(
    lanes: NDArray[np.float32], start: int, stop: int, left: int, top: int, lens: Array, reference: float, sums: Array
) -> None:
    """Add columns of pixels to sums.

    Args:
        lanes: sums of 1, i, i^2, d, i d and d^2 down LANES columns; i counts rows, d = w - reference, (6 LANES,).
        start: first lane to add.
        stop: the lane after the last.
        left: pixel column of the first lane.
        top: pixel row where i is 0.
        lens: fx, fy, cx and cy.
        reference: what the w are relative to.
        sums: out, (10,).
    """
    n, jn, jjn, i1, ji1, i2 = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    d, jd, id1, dd = 0.0, 0.0, 0.0, 0.0
    first = np.uint64(start)
    for k in range(stop - start):
        at, j = first + np.uint64(k), np.float64(k)
        ones, rows, offs = np.float64(lanes[at]), np.float64(lanes[at + _L1]), np.float64(lanes[at + _L3])
        n += ones
        jn += j * ones
        jjn += j * j * ones
        i1 += rows
        ji1 += j * rows
        i2 += lanes[at + _L2]
        d += offs
        jd += j * offs
        id1 += lanes[at + _L4]
        dd += lanes[at + _L5]
    _add(n, jn, jjn, i1, ji1, i2, d, jd, id1, dd, left, top, lens, reference, sums)


@leaf_kernel
def _add_full_lanes(
    lanes: NDArray[np.float32],
    start: int,
    stop: int,
    rows: int,
    left: int,
    top: int,
    lens: Array,
    reference: float,
    sums: Array,
) -> None:
    """The same where all pixels of so many rows are valid, which leaves little to add up."""
    d, jd, id1, dd = 0.0, 0.0, 0.0, 0.0
    first = np.uint64(start)
    for k in range(stop - start):
        at, j = first + np.uint64(k), np.float64(k)
        off = np.float64(lanes[at + _L3])
        d += off
        jd += j * off
        id1 += lanes[at + _L4]
        dd += lanes[at + _L5]
    wide, tall = np.float64(stop - start), np.float64(rows)
    j1, i1 = 0.5 * wide * (wide - 1.0), 0.5 * tall * (tall - 1.0)
    j2, i2 = j1 * (2.0 * wide - 1.0) / 3.0, i1 * (2.0 * tall - 1.0) / 3.0
    n, jn, jjn = wide * tall, tall * j1, tall * j2
    _add(n, jn, jjn, wide * i1, j1 * i1, wide * i2, d, jd, id1, dd, left, top, lens, reference, sums)


@leaf_kernel
def _add(
    n: float,
    jn: float,
    jjn: float,
    i1: float,
    ji1: float,
    i2: float,
    d: float,
    jd: float,
    id1: float,
    dd: float,
    left: int,
    top: int,
    lens: Array,
    reference: float,
    sums: Array,
) -> None:
    """Turn sums over pixel offsets j, i and differences d, named by what they are sums of, to those over x, y, w."""
    dx, dy = 1.0 / lens[0], 1.0 / lens[1]
    x0, y0 = (left - lens[2]) * dx, (top - lens[3]) * dy
    x, y = x0 * n + dx * jn, y0 * n + dy * i1
    sums[0] += n
    sums[1] += x
    sums[2] += y
    sums[3] += d + reference * n
    sums[4] += x0 * (x + dx * jn) + dx * dx * jjn
    sums[5] += x0 * y + dx * (y0 * jn + dy * ji1)
    sums[6] += y0 * (y + dy * i1) + dy * dy * i2
    sums[7] += x0 * d + dx * jd + reference * x
    sums[8] += y0 * d + dy * id1 + reference * y
    sums[9] += dd + reference * (2.0 * d + reference * n)
