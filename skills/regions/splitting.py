"""A second judgement on regions: what was wrongly joined is cut in two.

Where the means of a region's patches stray from its plane by more than noise does, the region is cut along a line
through its middle, in four directions; each patch then goes to the plane that it is nearer to, and the planes are
fitted again (k-means with planes for means, after Bradley and Mangasarian, 2000). The best cut stands if the two would
not merge again, and if each is in one place: noise that was taken for two planes lies scattered.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array
from skills.kernels import kernel, leaf_kernel
from skills.regions.patches import fit_plane, misfit, off_plane

_STRAY = 1.6  # times the noise of patch means, which neighbours share in part, is no reason to look closer
_SCATTERED = 0.25  # share of neighbours on different sides above which a cut has found nothing but noise
_ROUNDS = 4  # of assigning patches and fitting planes


@kernel
def split_regions(
    patch_sums: Array,
    facets: Array,
    labels: NDArray[np.int32],
    count: int,
    offset: float,
    factor: float,
    patches_min: int,
    sums: Array,
    planes: Array,
) -> int:
    """Cut what is no single plane, in place; the number of regions afterwards.

    Args:
        patch_sums: sums of the patches, (rows, columns, 10).
        facets: see `Patches`, (rows, columns, 9).
        labels: region of each patch, (rows, columns); -1 for none.
        count: number of regions.
        offset: what regions that merge may be off their common plane, without noise [m].
        factor: the noise factor in the facets.
        patches_min: fewer patches are no region.
        sums: sums of the regions, with room for new ones, (R, 10).
        planes: their planes, (R, 3).
    """
    rows, columns = labels.shape
    capacity = sums.shape[0]
    members = np.empty(rows * columns, np.int64)
    trial, side = np.empty(rows * columns, np.uint8), np.empty(rows * columns, np.uint8)
    starts, sizes = np.zeros(capacity + 1, np.int64), np.zeros(capacity, np.int64)
    _gather(labels, count, starts, sizes, members)
    parts, part_planes = np.empty((2, 10)), np.empty((2, 3))
    best_parts, best_planes = np.empty((2, 10)), np.empty((2, 3))
    region = 0
    while region < count:
        own = members[starts[region] : starts[region] + sizes[region]]
        region += 1
        label = region - 1
        if len(own) < 2 * patches_min or count == capacity:
            continue
        square, noise = 0.0, 0.0
        for index in own:
            square += off_plane(patch_sums[index // columns, index % columns], planes[label]) ** 2
            noise += (facets[index // columns, index % columns, 7] / factor) ** 2
        if square <= _STRAY**2 * noise + len(own) * offset * offset:
            continue
        least = square
        for cut in range(4):
            rest = _cut(patch_sums, columns, own, cut, patches_min, parts, part_planes, trial)
            if rest < least:
                least = rest
                for k in range(len(own)):
                    side[k] = trial[k]
                for part in range(2):
                    for k in range(10):
                        best_parts[part, k] = parts[part, k]
                    for k in range(3):
                        best_planes[part, k] = part_planes[part, k]
        patches = 0
        for k in range(len(own)):
            patches += side[k]
        limit = offset + np.sqrt(noise / len(own)) * factor * np.sqrt(3.0 / min(patches, len(own) - patches))
        if least == square or (
            misfit(best_parts[0], best_planes[0], planes[label]) <= limit
            and misfit(best_parts[1], best_planes[1], planes[label]) <= limit
        ):
            continue
        for k in range(len(own)):
            if side[k]:
                labels[own[k] // columns, own[k] % columns] = count
        if _scatter(labels, own, label, count) > _SCATTERED:
            for index in own:
                labels[index // columns, index % columns] = label
            continue
        kept, end = 0, len(own)
        while kept < end:
            if side[kept] == 0:
                kept += 1
                continue
            end -= 1
            own[kept], own[end] = own[end], own[kept]
            side[kept] = side[end]
        for part in range(2):
            for k in range(10):
                sums[label if part == 0 else count, k] = best_parts[part, k]
            for k in range(3):
                planes[label if part == 0 else count, k] = best_planes[part, k]
        starts[count], sizes[count] = starts[label] + kept, len(own) - kept
        sizes[label] = kept
        count += 1
        region = label  # what is left of it may be two planes still
    return count


@leaf_kernel
def _gather(
    labels: NDArray[np.int32],
    count: int,
    starts: NDArray[np.int64],
    sizes: NDArray[np.int64],
    members: NDArray[np.int64],
) -> None:
    """List the patches of each region."""
    rows, columns = labels.shape
    for row in range(rows):
        for column in range(columns):
            if labels[row, column] >= 0:
                sizes[labels[row, column]] += 1
    for region in range(count):
        starts[region + 1] = starts[region] + sizes[region]
        sizes[region] = 0
    for row in range(rows):
        for column in range(columns):
            region = labels[row, column]
            if region >= 0:
                members[starts[region] + sizes[region]] = row * columns + column
                sizes[region] += 1


@leaf_kernel
def _scatter(labels: NDArray[np.int32], own: NDArray[np.int64], one: int, other: int) -> float:
    """Of the neighbours among patches of two regions, the share that are not in the same one."""
    rows, columns = labels.shape
    pairs, mixed = 0, 0
    for index in own:
        row, column = index // columns, index % columns
        here = labels[row, column]
        for i, j in ((row + 1, column), (row, column + 1)):
            if i < rows and j < columns and (labels[i, j] == one or labels[i, j] == other):
                pairs += 1
                mixed += labels[i, j] != here
    return mixed / max(pairs, 1)


@leaf_kernel
def _cut(
    patch_sums: Array,
    columns: int,
    own: NDArray[np.int64],
    cut: int,
    patches_min: int,
    parts: Array,
    planes: Array,
    side: NDArray[np.uint8],
) -> float:
    """Cut patches in two and settle to whom each belongs; the sum of squared distances left, infinite if it fails."""
    right, down = (cut != 1) * (-1.0 if cut == 3 else 1.0), (cut != 0) * 1.0
    middle = 0.0
    for index in own:
        middle += right * (index % columns) + down * (index // columns)
    middle /= len(own)
    for k in range(len(own)):
        side[k] = right * (own[k] % columns) + down * (own[k] // columns) > middle
    for turn in range(_ROUNDS + 1):
        if turn > 0:
            for k in range(len(own)):
                s = patch_sums[own[k] // columns, own[k] % columns]
                side[k] = abs(off_plane(s, planes[1])) < abs(off_plane(s, planes[0]))
        count = 0
        for part in range(2):
            for k in range(10):
                parts[part, k] = 0.0
        for k in range(len(own)):
            s, part = patch_sums[own[k] // columns, own[k] % columns], side[k]
            count += part
            for m in range(10):
                parts[part, m] += s[m]
        if min(count, len(own) - count) < patches_min:
            return np.inf
        if np.isinf(fit_plane(parts[0], planes[0])) or np.isinf(fit_plane(parts[1], planes[1])):
            return np.inf
    square = 0.0
    for k in range(len(own)):
        square += off_plane(patch_sums[own[k] // columns, own[k] % columns], planes[side[k]]) ** 2
    return square
