"""Sums over pixels of one label, as in `Patches`, for patches that more than one label shares.

Pixels next to another label are left out, because their label is the least certain. Sums are taken of the difference
between the inverse depth and a plane, which is small, so that single precision holds them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array
from skills.kernels import kernel
from skills.regions.pixel_labels import LANES, PixelLabels

_EROSION = 2  # pixels this near to another label are left out [px]


@kernel
def sum_pixels(
    depth: NDArray[np.float32],
    labels: PixelLabels,
    wanted: int,
    box: tuple[int, int, int, int],
    lens: Array,
    plane: Array,
    limits: tuple[float, float, float],
    lanes: NDArray[np.float32],
    sums: Array,
) -> None:
    """Add the pixels of a box with the wanted label to sums of 1, x, y, w, x^2, xy, y^2, xw, yw and w^2.

    Args:
        depth: the image.
        labels: label of each pixel.
        wanted: the label.
        box: rows and columns from (v0, u0) to, but not with, (v1, u1).
        lens: fx, fy, cx and cy.
        plane: w = a x + b y + c near which w is, (3,).
        limits: nearest and farthest valid depth, and the relative error in depth above which a pixel is left out.
        lanes: room for work, (6, LANES).
        sums: out, (10,).
    """
    v0, u0, v1, u1 = max(box[0], _EROSION), max(box[1], _EROSION), box[2], box[3]
    v1, u1 = min(v1, depth.shape[0] - _EROSION), min(u1, depth.shape[1] - _EROSION)
    near, far, tolerance = np.float32(limits[0]), np.float32(limits[1]), np.float32(limits[2])
    one, zero = np.float32(1.0), np.float32(0.0)
    mine = np.int16(wanted)
    a, b = plane[0] / lens[0], plane[1] / lens[1]
    c = plane[2] - a * lens[2] - b * lens[3]
    a32 = np.float32(a)
    for left in range(u0, u1, LANES):
        wide = min(LANES, u1 - left)
        for m in range(6):
            for j in range(wide):
                lanes[m, j] = zero
        for v in range(v0, v1):
            base, i = np.float32(a * left + b * v + c), np.float32(v - v0)
            for j in range(wide):
                u = left + j
                z = depth[v, u]
                same = (
                    (labels[v, u] == mine)
                    & (labels[v - _EROSION, u] == mine)
                    & (labels[v + _EROSION, u] == mine)
                    & (labels[v, u - _EROSION] == mine)
                    & (labels[v, u + _EROSION] == mine)
                )
                p = a32 * np.float32(j) + base
                off = abs(z * p - one)
                good = same & (z >= near) & (z <= far) & (off <= tolerance)
                m = one if good else zero
                d = one / z - p if good else zero
                lanes[0, j] += m
                lanes[1, j] += i * m
                lanes[2, j] += i * i * m
                lanes[3, j] += d
                lanes[4, j] += i * d
                lanes[5, j] += d * d
        add_lanes(lanes, wide, left, v0, lens, plane, sums)


@kernel
def add_lanes(
    lanes: NDArray[np.float32], wide: int, left: int, top: int, lens: Array, plane: Array, sums: Array
) -> None:
    """Add columns of pixels, each a sum of 1, i, i^2, d, i d and d^2 over rows top + i with w = plane + d."""
    y0, dy = (top - lens[3]) / lens[1], 1.0 / lens[1]
    a, b, c = plane
    for j in range(wide):
        x = (left + j - lens[2]) / lens[0]
        n, i1, i2 = np.float64(lanes[0, j]), np.float64(lanes[1, j]), np.float64(lanes[2, j])
        d, yd, dd = np.float64(lanes[3, j]), np.float64(lanes[4, j]), np.float64(lanes[5, j])
        y = y0 * n + dy * i1
        yy = y0 * y0 * n + 2.0 * y0 * dy * i1 + dy * dy * i2
        yd = y0 * d + dy * yd
        p = a * x + c
        w = d + p * n + b * y
        sums[0] += n
        sums[1] += x * n
        sums[2] += y
        sums[3] += w
        sums[4] += x * x * n
        sums[5] += x * y
        sums[6] += yy
        sums[7] += x * w
        sums[8] += yd + p * y + b * yy
        sums[9] += dd + 2.0 * (p * d + b * yd) + p * p * n + 2.0 * p * b * y + b * b * yy
