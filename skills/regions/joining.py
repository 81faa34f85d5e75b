"""Regions that lie near each other and fit a common plane become one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array
from skills.kernels import leaf_kernel
from skills.regions.noise_level import depth_noise
from skills.regions.patches import fit_plane, misfit

_REACH = 6  # patches between regions that may be one


def join_regions(
    labels: NDArray[np.int32],
    count: int,
    offset: float,
    factor: float,
    noise: Array,
    pixels: float,
    sums: Array,
    planes: Array,
    first: int = 0,
) -> tuple[int, NDArray[np.int32]]:
    """Join regions, in place.

    Args:
        labels: region of each patch, (rows, columns); -1 for none.
        count: number of regions.
        offset: how far a region may be off the common plane, without noise [m].
        factor: standard deviations of the noise that are allowed for.
        noise: law of the noise.
        pixels: how many pixels share the error that neighbours share.
        sums: of the regions; those that are left come first afterwards.
        planes: likewise.
        first: regions before this one do not fit each other, as is known already.

    Returns:
        The number of regions afterwards, and the new label of each of those before.
    """
    touching, numbers = np.zeros((count, count), np.bool_), np.empty(count, np.int32)
    _find_touching(labels, first, touching)
    left = _unite(touching, offset, factor, noise, pixels, np.empty(10), np.empty(3), numbers, sums, planes)
    if left < count:
        _renumber(labels, numbers)
    return left, numbers


@leaf_kernel
def _find_touching(labels: NDArray[np.int32], first: int, touching: NDArray[np.bool_]) -> None:
    """Which regions, from one on, are near which others in a row or column."""
    rows, columns = labels.shape
    for row in range(rows):
        for column in range(columns):
            p = labels[row, column]
            if p < first or p < 0:
                continue
            for side in range(4):
                down, right = (side == 0) - (side == 1), (side == 2) - (side == 3)
                i, j = row + down, column + right
                for _ in range(_REACH):
                    if i < 0 or j < 0 or i >= rows or j >= columns or labels[i, j] == p:
                        break
                    q = labels[i, j]
                    if q >= 0:
                        touching[min(p, q), max(p, q)] = True
                        break
                    i, j = i + down, j + right


@leaf_kernel
def _unite(
    touching: NDArray[np.bool_],
    offset: float,
    factor: float,
    noise: Array,
    pixels: float,
    union: Array,
    plane: Array,
    numbers: NDArray[np.int32],
    sums: Array,
    planes: Array,
) -> int:
    """Join regions until none fits another; how many are left, and the new number of each."""
    count = numbers.shape[0]
    for p in range(count):
        numbers[p] = p
    merged = True
    while merged:
        merged = False
        for p in range(count):
            for q in range(p + 1, count):
                if not touching[p, q] or numbers[p] != p or numbers[q] != q:
                    continue
                for k in range(10):
                    union[k] = sums[p, k] + sums[q, k]
                fit_plane(union, plane)
                # The plane of a small region is less certain, and more of its misfit is noise.
                patches = min(sums[p, 0], sums[q, 0]) / pixels
                limit = offset + factor * depth_noise(noise, union[0] / union[3], pixels) * np.sqrt(3.0 / patches)
                if misfit(sums[p], planes[p], plane) > limit or misfit(sums[q], planes[q], plane) > limit:
                    continue
                for k in range(10):
                    sums[p, k] = union[k]
                for k in range(3):
                    planes[p, k] = plane[k]
                for k in range(count):
                    if numbers[k] == q:
                        numbers[k] = p
                    if k != p and touching[min(k, q), max(k, q)]:
                        touching[min(k, p), max(k, p)] = True
                merged = True
    kept = 0
    for p in range(count):
        if numbers[p] == p:
            for k in range(10):
                sums[kept, k] = sums[p, k]
            for k in range(3):
                planes[kept, k] = planes[p, k]
            numbers[p] = kept
            kept += 1
        else:
            numbers[p] = numbers[numbers[p]]  # regions join those before them, which have their new number
    return kept


@leaf_kernel
def _renumber(labels: NDArray[np.int32], numbers: NDArray[np.int32]) -> None:
    for row in range(labels.shape[0]):
        for column in range(labels.shape[1]):
            if labels[row, column] >= 0:
                labels[row, column] = numbers[labels[row, column]]
