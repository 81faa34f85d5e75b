"""Regions of patches: grown from the flattest patch outwards, then merged.

A patch joins where it links to a neighbour in the region (normals and offsets both ways) and also agrees with the plane
of the whole region, which is fitted anew as it grows. The second test is what keeps a chain of small differences from
joining blocks that touch. Patches that are too noisy to join by their own normal then fill in by offset alone, and
regions merge where both fit their common plane.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array
from skills.kernels import leaf_kernel
from skills.regions.joining import join_regions
from skills.regions.parameters import RegionParameters
from skills.regions.patches import SUMS, Patches, fit_plane, off_plane
from skills.regions.splitting import split_regions

Labels = NDArray[np.int32]


@dataclass(frozen=True, slots=True, eq=False)
class PatchRegions:
    """Which patch belongs to which plane.

    Attributes:
        labels: index into planes for each patch, (rows, columns) int32; -1 for none.
        planes: plane of each region, (R, 3) [1/m], as in `Patches`.
        sums: sums over the pixels of each region, (R, 10).
    """

    labels: Labels
    planes: Array
    sums: Array


def grow_regions(patches: Patches, parameters: RegionParameters, patches_min: int) -> PatchRegions:
    """Join patches into regions of no fewer than so many."""
    p, pixels = parameters, patches.pixels
    labels = np.full(patches.sigma.shape, -1, dtype=np.int32)
    order = _flattest_first(patches.sigma)
    capacity = labels.size // patches_min + 1
    sums, planes = np.zeros((capacity, SUMS)), np.zeros((capacity, 3))
    limits = np.array((p.link_angle, p.link_offset, p.grow_angle, p.grow_offset))
    queue, seen, face = np.empty(labels.size, np.int64), np.zeros(labels.shape, np.int32), np.empty(4)
    work = (queue, seen, face)
    count = _grow(patches.sums, patches.facets, order, limits, patches_min, *work, labels, sums, planes)
    _fill(patches.sums, patches.facets, planes, p.fill_offset, queue, labels)
    merging = (p.merge_offset, p.noise_factor)
    count, _ = join_regions(labels, count, *merging, patches.noise.law, pixels, sums, planes)
    count = split_regions(patches.sums, patches.facets, labels, count, *merging, patches_min, sums, planes)
    return PatchRegions(labels, planes[:count], sums[:count])


def _flattest_first(sigma: Array) -> NDArray[np.int64]:
    """Indices of the patches that have a plane, by their spread about it.

    Floats that are not negative sort like the integers of the same bits. The last bits make room for the index, so no
    two are equal and the fastest sort is stable.
    """
    mask = (1 << sigma.size.bit_length()) - 1
    bits = np.ascontiguousarray(sigma).reshape(-1).view(np.int64)
    found = np.flatnonzero(np.isfinite(sigma))
    return np.sort((bits[found] & ~mask) | found) & mask


@leaf_kernel
def _grow(
    patch_sums: Array,
    facets: Array,
    order: NDArray[np.int64],
    limits: Array,
    patches_min: int,
    queue: NDArray[np.int64],
    seen: Labels,
    face: Array,
    labels: Labels,
    sums: Array,
    planes: Array,
) -> int:
    """Label patches region by region; the number of regions. Seen is the last seed, from 1, that reached a patch."""
    rows, columns = labels.shape
    link_angle, link_offset, grow_angle, grow_offset = limits
    count = 0
    for seed in range(order.shape[0]):
        row, column = order[seed] // columns, order[seed] % columns
        if labels[row, column] >= 0:
            continue
        region, plane = sums[count], planes[count]
        for k in range(4):
            face[k] = facets[row, column, k]
        for k in range(3):
            plane[k] = face[k] / face[3]
        for k in range(10):
            region[k] = 0.0
        head, tail, fitted = 0, 1, 6
        queue[0] = order[seed]
        seen[row, column] = seed + 1
        while head < tail:
            row, column = queue[head] // columns, queue[head] % columns
            head += 1
            for k in range(10):
                region[k] += patch_sums[row, column, k]
            if head > 1.25 * fitted:
                fit_plane(region, plane)
                _set_face(plane, face)
                fitted = head
            here = facets[row, column]
            for side in range(4):
                i = row + (side == 0) - (side == 1)
                j = column + (side == 2) - (side == 3)
                if i < 0 or j < 0 or i >= rows or j >= columns or labels[i, j] >= 0 or seen[i, j] == seed + 1:
                    continue
                there = facets[i, j]
                allowed = link_offset + there[7]
                if (
                    there[3] > 0.0
                    and abs(_off(there, face)) <= grow_offset + there[7]
                    and abs(_off(there, here)) <= allowed
                    and abs(_off(here, there)) <= allowed
                    and _turned(there, here) <= (link_angle + there[8]) ** 2
                    and _turned(there, face) <= (grow_angle + there[8]) ** 2
                ):
                    seen[i, j] = seed + 1
                    queue[tail] = i * columns + j
                    tail += 1
        if tail < patches_min:
            continue
        # Early members were judged by a plane that was still poor: judge them again by the last one.
        fit_plane(region, plane)
        _set_face(plane, face)
        kept = 0
        for k in range(10):
            region[k] = 0.0
        for k in range(tail):
            row, column = queue[k] // columns, queue[k] % columns
            if abs(_off(facets[row, column], face)) <= grow_offset + facets[row, column, 7]:
                labels[row, column] = count
                kept += 1
                for m in range(10):
                    region[m] += patch_sums[row, column, m]
        if kept < patches_min:
            for k in range(tail):
                labels[queue[k] // columns, queue[k] % columns] = -1
            continue
        fit_plane(region, plane)
        count += 1
    return count


@leaf_kernel
def _set_face(plane: Array, face: Array) -> None:
    """Unit normal and distance of a plane."""
    face[3] = 1.0 / np.sqrt(plane[0] ** 2 + plane[1] ** 2 + plane[2] ** 2)
    for k in range(3):
        face[k] = plane[k] * face[3]


@leaf_kernel
def _off(facet: Array, face: Array) -> float:
    """Distance of a patch's mean from a plane, positive behind it [m]."""
    return face[0] * facet[4] + face[1] * facet[5] + face[2] * facet[6] - face[3]


@leaf_kernel
def _turned(facet: Array, face: Array) -> float:
    """Square of the angle between two normals, for angles well below 1 rad."""
    return 2.0 - 2.0 * (face[0] * facet[0] + face[1] * facet[1] + face[2] * facet[2])


@leaf_kernel
def _fill(
    patch_sums: Array, facets: Array, planes: Array, offset: float, queue: NDArray[np.int64], labels: Labels
) -> None:
    """Give patches without a region that of a neighbour whose plane they lie in, outwards from the regions."""
    rows, columns = labels.shape
    tail = 0
    for row in range(rows):
        for column in range(columns):
            if labels[row, column] >= 0:
                queue[tail] = row * columns + column
                tail += 1
    head = 0
    while head < tail:
        row, column = queue[head] // columns, queue[head] % columns
        head += 1
        label = labels[row, column]
        for side in range(4):
            i = row + (side == 0) - (side == 1)
            j = column + (side == 2) - (side == 3)
            if i < 0 or j < 0 or i >= rows or j >= columns or labels[i, j] >= 0:
                continue
            if facets[i, j, 6] > 0.0 and abs(off_plane(patch_sums[i, j], planes[label])) <= offset + facets[i, j, 7]:
                labels[i, j] = label
                queue[tail] = i * columns + j
                tail += 1
