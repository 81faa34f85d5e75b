"""Shapes of regions: outlines with their holes, simplified, and cut into convex parts; all regions in one go."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from skills.geometry.convex_decomposition import decompose
from skills.geometry.polygon import centroid, contains_point, signed_area
from skills.geometry.pose import Array, Pose
from skills.geometry.simplification import simplify_rings
from skills.kernels import kernel
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
    vertices, ring_ends, last_rings, corners, part_ends, last_parts, origins, areas = _shape(
        np.array(loops, dtype=np.int64),
        holes,
        outlines.starts,
        outlines.labels,
        on_planes.points,
        tolerances,
        parameters.convex_tolerance,
    )
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


@kernel
def _shape(
    loops: Indices,
    holes: Indices,
    starts: Indices,
    labels: Indices,
    points: Array,
    tolerances: Array,
    convex_tolerance: float,
) -> tuple[Array, Indices, Indices, Array, Indices, Indices, Array, Array]:
    count, total = loops.shape[0], points.shape[0] + 2 * labels.shape[0]
    vertices, ring_ends, last_rings = np.empty((total, 2)), np.empty(total, np.int64), np.empty(count, np.int64)
    # As many as the decomposition of all loops at once could have; most of it stays untouched.
    corners, part_ends = np.empty((4 * total + 8 * count, 2)), np.empty(2 * total + 8 * count, np.int64)
    last_parts, origins, areas = np.empty(count, np.int64), np.zeros((count, 2)), np.zeros(count)
    given, limits = np.empty((total, 2)), np.empty(total)
    bounds = np.empty(holes.shape[0] + 2, np.int64)
    written, rings, cut, parts = 0, 0, 0, 0
    for k in range(count):
        loop = int(loops[k])
        first, last = starts[loop], starts[loop + 1]
        bounds[0], size = 0, 1
        bounds[1] = _append(points, tolerances, first, last, given, limits, 0)
        for m in range(holes.shape[0]):
            hole = int(holes[m])
            begin, end = starts[hole], starts[hole + 1]
            if labels[hole] == labels[loop] and contains_point(points[first:last], points[begin, 0], points[begin, 1]):
                bounds[size + 1] = _append(points, tolerances, begin, end, given, limits, bounds[size])
                size += 1
        found, ends = simplify_rings(given[: bounds[size]], bounds[: size + 1], limits)
        if ends[0] > 0:
            origins[k, 0], origins[k, 1] = centroid(found[: ends[0]])
        for i in range(found.shape[0]):
            found[i, 0] -= origins[k, 0]
            found[i, 1] -= origins[k, 1]
            vertices[written + i, 0], vertices[written + i, 1] = found[i, 0], found[i, 1]
        begin = 0
        for ring in range(size):
            areas[k] += signed_area(found[begin : ends[ring]])
            begin = ends[ring]
            ring_ends[rings + ring] = written + begin
        written, rings = written + found.shape[0], rings + size
        last_rings[k] = rings
        if ends[0] > 0:
            pieces, piece_ends = decompose(found, ends, convex_tolerance)
            for i in range(pieces.shape[0]):
                corners[cut + i, 0], corners[cut + i, 1] = pieces[i, 0], pieces[i, 1]
            for i in range(piece_ends.shape[0]):
                part_ends[parts + i] = cut + piece_ends[i]
            cut, parts = cut + pieces.shape[0], parts + piece_ends.shape[0]
        last_parts[k] = parts
    return (
        vertices[:written].copy(),
        ring_ends[:rings],
        last_rings,
        corners[:cut].copy(),
        part_ends[:parts],
        last_parts,
        origins,
        areas,
    )


@kernel
def _append(points: Array, tolerances: Array, first: int, last: int, given: Array, limits: Array, written: int) -> int:
    """Copy a loop's vertices and their tolerances behind those that are written; the new end."""
    for i in range(first, last):
        given[written, 0], given[written, 1] = points[i, 0], points[i, 1]
        limits[written] = tolerances[i]
        written += 1
    return written
