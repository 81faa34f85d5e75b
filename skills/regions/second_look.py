"""A second look, twice as fine, at what the first found no region for.

Windows of patches are too coarse for faces that are narrower than they are. What the first look has left, without the
pixels that are spoken for, is cut into patches of half the size and grown into regions once more. Those that continue
a region of the first look, or join two of them, become one with it.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skills.geometry.camera import DepthImage
from skills.geometry.pose import Array
from skills.kernels import leaf_kernel
from skills.regions.growing import PatchRegions, grow_regions
from skills.regions.joining import join_regions
from skills.regions.parameters import RegionParameters
from skills.regions.patch_sums import LANES, add_lanes
from skills.regions.patches import FACET, SUMS, Patches, fit_facets, intrinsics
from skills.regions.pixel_sums import fill_lanes
from skills.regions.plane_contest import PixelLabels

_FINE_MIN = 2  # times as many fine patches as coarse ones make a region, a quarter of the size as they are


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """Regions of both looks.

    Attributes:
        coarse: region of each patch, (rows, columns); -1 for none.
        fine: region of each of the patches of half the size that the second look was at, (2 rows, 2 columns).
        planes: plane of each region, (R, 3).
        numbers: what the regions of the first look are called now.
    """

    coarse: NDArray[np.int32]
    fine: NDArray[np.int32]
    planes: Array
    numbers: NDArray[np.int32]


def look_again(
    image: DepthImage,
    patches: Patches,
    first: PatchRegions,
    inner: NDArray[np.bool_],
    bare: PixelLabels,
    parameters: RegionParameters,
) -> Found | None:
    """Find regions among the pixels that are in none; None where there are no more.

    Args:
        image: the depth image.
        patches: of the first look.
        first: regions of the first look.
        inner: patches that are all of one region, (rows, columns).
        bare: 1 for each pixel that is in no region or at odds with its own, (height, width).
        parameters: tolerances and limits.
    """
    with _desk.cleared((2 * inner.shape[0], 2 * inner.shape[1])) as room:
        second = _second(image, patches, inner, bare, parameters, room)
    if second is None:
        return None
    known, more = len(first.planes), len(second.planes)
    labels = first.labels.repeat(2, axis=0).repeat(2, axis=1)
    np.copyto(labels, second.labels + known, where=second.labels >= 0)
    sums, planes = np.concatenate((first.sums, second.sums)), np.concatenate((first.planes, second.planes))
    count, numbers = join_regions(
        labels,
        known + more,
        parameters.merge_offset,
        parameters.noise_factor,
        patches.noise.law,
        patches.pixels,
        sums,
        planes,
        known,
    )
    numbers = np.append(numbers, np.int32(-1))  # for patches without a region, whose label is the last index too
    fine = np.where(second.labels >= 0, second.labels + known, -1)
    return Found(numbers[first.labels], numbers[fine], planes[:count], numbers[:known])


@dataclass(frozen=True, slots=True, eq=False)
class _Room:
    """Tables of patches: sums, facets, and the places of those that are in use, as many as the last tells."""

    sums: Array
    facets: Array
    used: NDArray[np.int32]
    count: NDArray[np.int64]


class _Desk(threading.local):
    """Room that a thread keeps: little of it is used, and new memory costs more than what is done there."""

    def __init__(self) -> None:
        self._rooms: dict[tuple[int, int], _Room] = {}

    @contextmanager
    def cleared(self, shape: tuple[int, int]) -> Iterator[_Room]:
        """Room for patches in rows and columns, all zeros."""
        if shape not in self._rooms:
            used = np.empty(shape[0] * shape[1], np.int32)
            self._rooms = {shape: _Room(np.zeros((*shape, SUMS)), np.zeros((*shape, FACET)), used, np.zeros(1, int))}
        room = self._rooms[shape]
        try:
            yield room
        finally:
            used = room.used[: room.count[0]]
            room.sums.reshape(-1, SUMS)[used] = 0.0
            room.facets.reshape(-1, FACET)[used] = 0.0
            room.count[0] = 0


_desk = _Desk()


def _second(
    image: DepthImage,
    patches: Patches,
    inner: NDArray[np.bool_],
    bare: PixelLabels,
    parameters: RegionParameters,
    room: _Room,
) -> PatchRegions | None:
    """Regions of the second look alone."""
    camera, half = image.camera, patches.size // 2
    allowed, work = (camera.near, min(camera.far, parameters.depth_max), np.inf), np.empty(6 * LANES, np.float32)
    tables = room.sums, room.used, room.count
    _sum_left(image.depth, half, allowed, intrinsics(camera), patches.sums, inner, bare, work, *tables)
    if not room.count[0]:
        return None
    finer = replace(patches, size=half, edge=0.5 * patches.edge, pixels=0.25 * patches.pixels)
    finer = fit_facets(finer, room.sums, parameters, room.facets)
    second = grow_regions(finer, parameters, _FINE_MIN * parameters.patches_min)
    return second if len(second.planes) else None


@leaf_kernel
def _sum_left(
    depth: NDArray[np.float32],
    half: int,
    allowed: tuple[float, float, float],
    lens: Array,
    patch_sums: Array,
    inner: NDArray[np.bool_],
    bare: PixelLabels,
    lanes: NDArray[np.float32],
    sums: Array,
    used: NDArray[np.int32],
    count: NDArray[np.int64],
) -> None:
    """Sums over the bare pixels of the quarters of each patch, and which of these have any."""
    rows, columns = inner.shape
    height, width = depth.shape
    for row in range(rows):
        for column in range(columns):
            s = patch_sums[row, column]
            if inner[row, column] or s[0] == 0.0:
                continue
            plane = np.float32(0.0), np.float32(0.0), np.float32(s[3] / s[0])
            u0 = 2 * column * half
            middle, u1 = min(u0 + half, width), min(u0 + 2 * half, width)
            for i in range(2 * row, 2 * row + 2):
                v0, v1 = i * half, min((i + 1) * half, height)
                if not _any_bare(bare, v0, u0, v1, u1):
                    continue
                reference = fill_lanes(depth, bare, 1, (v0, u0, v1, u1), plane, allowed, lanes)
                add_lanes(lanes, 0, middle - u0, u0, v0, lens, reference, sums[i, 2 * column])
                add_lanes(lanes, middle - u0, u1 - u0, middle, v0, lens, reference, sums[i, 2 * column + 1])
                for j in range(2 * column, 2 * column + 2):
                    used[count[0]] = i * 2 * columns + j
                    count[0] += sums[i, j, 0] > 0.0


@leaf_kernel
def _any_bare(bare: PixelLabels, v0: int, u0: int, v1: int, u1: int) -> bool:
    first, wide, found = np.uint64(u0), u1 - u0, np.int16(0)
    for v in range(v0, v1):
        line = bare[v]
        for j in range(wide):
            found |= line[first + np.uint64(j)]
    return found != 0
