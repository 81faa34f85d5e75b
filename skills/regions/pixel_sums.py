"""Sums over pixels of one label, as in `Patches`, for patches that more than one label shares.

Pixels next to another label are left out, because their label is the least certain.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array
from skills.kernels import leaf_kernel
from skills.regions.patch_sums import LANES, add_lanes
from skills.regions.plane_contest import PixelLabels

EROSION = 2  # pixels this near to another label are left out [px]


@leaf_kernel
def sum_pixels(
    depth: NDArray[np.float32],
    labels: PixelLabels,
    wanted: int,
    box: tuple[int, int, int, int],
    lens: Array,
    plane: tuple[np.float32, np.float32, np.float32],
    limits: tuple[float, float, float],
    lanes: NDArray[np.float32],
    sums: Array,
) -> None:
    """Add the pixels of a box with the wanted label to sums of 1, x, y, w, x^2, xy, y^2, xw, yw and w^2.

    Args:
        depth: the image.
        labels: label of each pixel.
        wanted: the label.
        box: rows and columns from (v0, u0) to, but not with, (v1, u1); no wider than LANES.
        lens: fx, fy, cx and cy.
        plane: of the label, w = a u + b v + c over pixels.
        limits: nearest and farthest valid depth, and the relative error in depth above which a pixel is left out.
        lanes: room for work, (6 LANES,).
        sums: out, (10,).
    """
    reference = fill_lanes(depth, labels, wanted, box, plane, limits, lanes)
    add_lanes(lanes, 0, box[3] - box[1], box[1], box[0], lens, reference, sums)


@leaf_kernel
def fill_lanes(
    depth: NDArray[np.float32],
    labels: PixelLabels,
    wanted: int,
    box: tuple[int, int, int, int],
    plane: tuple[np.float32, np.float32, np.float32],
    limits: tuple[float, float, float],
    lanes: NDArray[np.float32],
) -> float:
    """Sum the pixels of a box with the wanted label down its columns, for `add_lanes`; what the sums are relative to.

    Arguments are those of `sum_pixels`.
    """
    v0, left, v1, right = box
    near, far, tolerance = np.float32(limits[0]), np.float32(limits[1]), np.float32(limits[2])
    one, zero = np.float32(1.0), np.float32(0.0)
    mine, beside = np.int16(wanted), np.uint64(EROSION)
    a, b, c = plane
    for k in range(6):
        for j in range(right - left):
            lanes[k * LANES + j] = zero
    reference = a * np.float32(left) + b * np.float32(v0) + c
    # Unsigned indices need no test for being negative: the loop runs in vectors.
    start, begin = max(EROSION - left, 0), np.uint64(max(left, EROSION))
    wide = min(right, depth.shape[1] - EROSION) - left - start
    for v in range(max(v0, EROSION), min(v1, depth.shape[0] - EROSION)):
        base, i = a * np.float32(left) + b * np.float32(v) + c, np.float32(v - v0)
        row = np.uint64(v)
        for k in range(wide):
            j, u = start + k, begin + np.uint64(k)
            z = depth[row, u]
            same = (labels[row, u] == mine) & (labels[row - beside, u] == mine) & (labels[row + beside, u] == mine)
            same &= (labels[row, u - beside] == mine) & (labels[row, u + beside] == mine)
            off = abs(z * (a * np.float32(j) + base) - one)
            good = same & (z >= near) & (z <= far) & (off <= tolerance)
            m = one if good else zero
            w = one / z - reference if good else zero
            lanes[j] += m
            lanes[LANES + j] += i * m
            lanes[2 * LANES + j] += i * i * m
            lanes[3 * LANES + j] += w
            lanes[4 * LANES + j] += i * w
            lanes[5 * LANES + j] += w * w
    return np.float64(reference)
