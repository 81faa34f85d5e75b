"""Shapes of regions: outlines with their holes, simplified, and cut into convex parts; all regions in one go."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from skills.geometry.convex_decomposition import DecomposingRoom, decompose, decomposing_room
from skills.geometry.polygon import centroid, contains_point, signed_area
from skills.geometry.pose import Array, Pose
from skills.geometry.simplification import SimplifyingRoom, simplify_rings, simplifying_room
from skills.kernels import leaf_kernel
from skills.regions.outline import Indices, Outlines
from skills.regions.parameters import RegionParameters
from skills.regions.plane_outlines import PlaneOutlines


@dataclass(frozen=True, slots=True)
class RegionShape:
    """One region in its own frame.

    Attributes:
        loop: the loop in the image that it came from.
        T_world_region: its frame, with the origin in the middle of the outline.
        rings: the simplified outline, then its holes, each (N, 2) [m]; none where it is thinner than the tolerance.
        parts: convex parts, each (K, 2) [m].
        area: area of the outline less its holes [m^2].
    """

    loop: int
    T_world_region: Pose
    rings: tuple[Array, ...]
    parts: tuple[Array, ...]
    area: float


def shape_regions(
    loops: list[int], outlines: Outlines, on_planes: PlaneOutlines, parameters: RegionParameters
) -> list[RegionShape]:
    """Simplify loops together with the holes in them and cut them into convex parts; arrays are read-only."""
    tolerances = np.maximum(parameters.outline_tolerance, parameters.outline_pixels * on_planes.pixels)
    holes = np.flatnonzero(-on_planes.areas >= parameters.hole_area_min)
    count, total = len(loops), len(on_planes.points) + 2 * len(outlines.labels)
    room = decomposing_room(total, len(holes) + 1)
    made = _Shapes(
        np.empty((total, 2)),
        np.empty(total, np.int64),
        np.empty(count, np.int64),
        # As many as the decomposition of all loops at once could have; most of it stays untouched.
        np.empty((len(room.stack) + 8 * count, 2)),
        np.empty(len(room.sizes) + 8 * count, np.int64),
        np.empty(count, np.int64),
        np.zeros((count, 2)),
        np.zeros(count),
    )
    written, cut = _shape(
        np.array(loops, dtype=np.int64),
        holes,
        outlines.starts,
        outlines.labels,
        on_planes.points,
        tolerances,
        parameters.convex_tolerance,
        _Given(np.empty((total, 2)), np.empty(total), np.empty(len(holes) + 2, np.int64)),
        simplifying_room(total),
        room,
        made,
    )
    vertices, corners, origins, areas = (
        made.vertices[:written].copy(),
        made.corners[:cut].copy(),
        made.origins,
        made.areas,
    )
    ring_ends, last_rings = made.ring_ends[: made.last_rings[-1]] if count else made.last_rings, made.last_rings
    part_ends, last_parts = made.part_ends[: made.last_parts[-1]] if count else made.last_parts, made.last_parts
    labels = outlines.labels[loops]
    R = on_planes.R_world_planes[labels]
    p = np.einsum("nij,nj->ni", R, np.column_stack((origins, on_planes.heights[labels])))
    for array in (vertices, corners, R, p):
        array.flags.writeable = False
    poses = map(Pose, R, p)
    rings, parts = _cut(vertices, ring_ends), _cut(corners, part_ends)
    rings_of, parts_of = pairwise((0, *last_rings.tolist())), pairwise((0, *last_parts.tolist()))
    return [
        RegionShape(loop, pose, tuple(ring for ring in rings[a:b] if len(ring)), tuple(parts[c:d]), area)
        for loop, pose, (a, b), (c, d), area in zip(loops, poses, rings_of, parts_of, areas.tolist(), strict=True)
    ]


def _cut(stacked: Array, ends: Indices) -> list[Array]:
    """Polygons that are stacked."""
    return [stacked[a:b] for a, b in pairwise((0, *ends.tolist()))]


class _Given(NamedTuple):
    """Room for one region's rings as they come: vertices, their tolerances, and where each ring begins."""

    vertices: Array
    limits: Array
    bounds: Indices


class _Shapes(NamedTuple):
    """Rings and parts of all regions, stacked.

    Attributes:
        vertices, ring_ends, last_rings: vertices of rings, the end of each ring, the last ring of each region.
        corners, part_ends, last_parts: likewise of the convex parts.
        origins, areas: of each region.
    """

    vertices: Array
    ring_ends: Indices
    last_rings: Indices
    corners: Array
    part_ends: Indices
    last_parts: Indices
    origins: Array
    areas: Array


@leaf_kernel
def _shape(
    loops: Indices,
    holes: Indices,
    starts: Indices,
    labels: Indices,
    points: Array,
    tolerances: Array,
    convex_tolerance: float,
    given: _Given,
    simplifying: SimplifyingRoom,
    decomposing: DecomposingRoom,
    made: _Shapes,
) -> tuple[int, int]:
    """Shape the regions of some loops; how many vertices and how many corners they have in all."""
    bounds = given.bounds
    bounds[0] = 0
    written = rings = cut = parts = bounds[0]  # zeros written here would be types of their own to callees
    for k in range(loops.shape[0]):
        loop = int(loops[k])
        first, last = starts[loop], starts[loop + 1]
        size = 1
        bounds[1] = _append(points, tolerances, first, last, given, bounds[0])
        for m in range(holes.shape[0]):
            hole = int(holes[m])
            begin, end = starts[hole], starts[hole + 1]
            if labels[hole] == labels[loop] and contains_point(points[first:last], points[begin, 0], points[begin, 1]):
                bounds[size + 1] = _append(points, tolerances, begin, end, given, bounds[size])
                size += 1
        found, ends = made.vertices[written:], made.ring_ends[rings : rings + size]
        count = simplify_rings(
            given.vertices[: bounds[size]], bounds[: size + 1], given.limits, simplifying, found, ends
        )
        if ends[0] > 0:
            made.origins[k, 0], made.origins[k, 1] = centroid(found[: ends[0]])
            for i in range(count):
                found[i, 0] -= made.origins[k, 0]
                found[i, 1] -= made.origins[k, 1]
            part_ends = made.part_ends[parts:]
            pieces = decompose(found, ends, convex_tolerance, decomposing, cut, made.corners, part_ends)
            parts, cut = parts + pieces, part_ends[pieces - 1]
        begin = 0
        for ring in range(size):
            made.areas[k] += signed_area(found[begin : ends[ring]])
            begin = ends[ring]
            ends[ring] = written + begin
        written, rings = written + count, rings + size
        made.last_rings[k], made.last_parts[k] = rings, parts
    return written, cut


@leaf_kernel
def _append(points: Array, tolerances: Array, first: int, last: int, given: _Given, written: int) -> int:
    """Copy a loop's vertices and their tolerances behind those that are written; the new end."""
    for i in range(first, last):
        given.vertices[written, 0], given.vertices[written, 1] = points[i, 0], points[i, 1]
        given.limits[written] = tolerances[i]
        written += 1
    return written
