"""Polygons with fewer vertices: corners found, straight edges fitted, nothing crossed.

Corners are those that Douglas and Peucker (1973) keep: the outline between two of them stays within a tolerance of the
straight line. Each edge is then the least-squares line through its stretch of the outline, and corners are where edges
meet, so noise along an edge averages out instead of choosing the corners. Where the result crosses itself or a hole,
the corners are taken unfitted, and then with half the tolerance, down to the given outline.
"""

from __future__ import annotations

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from skills.geometry.polygon import contains_point, turn
from skills.geometry.pose import Array
from skills.kernels import leaf_kernel

Indices = NDArray[np.int64]

_HALVINGS = 6


def simplify(polygon: Array, tolerance: float, holes: tuple[Array, ...] = ()) -> tuple[Array, ...]:
    """A simple polygon and its holes with fewer vertices, still simple and apart.

    Args:
        polygon: outline, (N, 2) counter-clockwise.
        tolerance: how far the outline between two corners may stray from a straight line [m].
        holes: outlines of holes, each (M, 2) clockwise, inside the polygon and apart from each other.

    Returns:
        The outline, then the holes that are left; nothing where the polygon is thinner than the tolerance.
    """
    rings = [np.asarray(ring, dtype=np.float64) for ring in (polygon, *holes)]
    points = np.concatenate(rings)
    starts = np.cumsum([0, *map(len, rings)])
    vertices, ends = np.empty((len(points), 2)), np.empty(len(rings), np.int64)
    simplify_rings(points, starts, np.full(len(points), tolerance), simplifying_room(len(points)), vertices, ends)
    found = [vertices[a:b] for a, b in pairwise((0, *ends.tolist()))]
    return tuple(ring for ring in found if len(ring)) if len(found[0]) else ()


class SimplifyingRoom(NamedTuple):
    """Room for work: the corners that are kept, stretches to look at, and the lines along two edges."""

    corners: Indices
    stack: Indices
    lines: Array


def simplifying_room(points: int) -> SimplifyingRoom:
    """Room for rings of so many points in all."""
    return SimplifyingRoom(np.empty(points, np.int64), np.empty(2 * points + 4, np.int64), np.empty((2, 4)))


@leaf_kernel
def simplify_rings(
    points: Array, starts: Indices, tolerances: Array, room: SimplifyingRoom, vertices: Array, ends: Indices
) -> int:
    """Simplify an outline and its holes together.

    Args:
        points: vertices of the outline, then of each hole, (N, 2).
        starts: where each ring begins in `points`, and the end of the last, (R + 1,).
        tolerances: how far the outline may stray near each vertex, (N,).
        room: for at least N points.
        vertices: out, of the rings, stacked, (N, 2).
        ends: out, the end of each ring, (R,); rings that are thinner than the tolerance are empty.

    Returns:
        How many vertices are left.
    """
    rings = starts.shape[0] - 1
    corners, stack, lines = room.corners, room.stack, room.lines
    scale = 1.0
    for _ in range(_HALVINGS):
        for fitted in (True, False):
            for ring in range(rings):
                first, n, written = starts[ring], starts[ring + 1] - starts[ring], ends[ring - 1] if ring else starts[0]
                count = _corners(points, first, n, tolerances, scale, corners, stack)
                ends[ring] = _write_ring(
                    points, first, n, tolerances, scale, corners, count, fitted, lines, vertices, written
                )
            if ends[0] == 0 or _all_simple(vertices, ends, corners):
                return int(ends[rings - 1])
        scale *= 0.5
    for i in range(points.shape[0]):
        vertices[i, 0], vertices[i, 1] = points[i, 0], points[i, 1]
    for ring in range(rings):
        ends[ring] = starts[ring + 1]
    return int(ends[rings - 1])


@leaf_kernel
def _corners(
    points: Array, first: int, n: int, tolerances: Array, scale: float, corners: Indices, stack: Indices
) -> int:
    """Places in a ring of the vertices to keep, in order; how many."""
    # Two vertices that any simplification must keep: the one furthest from the first, and that furthest from it.
    a = _furthest_from(points, first, n, 0)
    b = _furthest_from(points, first, n, a)
    if a == b:
        return 0
    count, depth = 0, 1
    stack[0], stack[1] = a, (b - a) % n
    other = True
    while depth > 0:
        depth -= 1
        here, steps = stack[2 * depth], stack[2 * depth + 1]
        split = _furthest_off(points, first, n, tolerances, scale, here, steps)
        if split > 0:
            stack[2 * depth], stack[2 * depth + 1] = (here + split) % n, steps - split
            stack[2 * depth + 2], stack[2 * depth + 3] = here, split
            depth += 2
            continue
        corners[count] = here
        count += 1
        if depth == 0 and other:
            other = False
            stack[0], stack[1] = b, (a - b) % n
            depth = 1
    return count


@leaf_kernel
def _furthest_from(points: Array, first: int, n: int, place: int) -> int:
    best, most = place, 0.0
    for k in range(n):
        square = (points[first + k, 0] - points[first + place, 0]) ** 2
        square += (points[first + k, 1] - points[first + place, 1]) ** 2
        if square > most:
            best, most = k, square
    return best


@leaf_kernel
def _furthest_off(points: Array, first: int, n: int, tolerances: Array, scale: float, here: int, steps: int) -> int:
    """Steps to the vertex that strays most from the chord over a stretch, in tolerances; 0 where none strays."""
    x, y = points[first + here, 0], points[first + here, 1]
    end = here + steps
    end = end - n if end >= n else end
    ux, uy = points[first + end, 0] - x, points[first + end, 1] - y
    square = max(ux * ux + uy * uy, 1e-18)
    best, most = 0, 1.0
    k = here
    for step in range(1, steps):
        k = k + 1 if k + 1 < n else 0
        px, py = points[first + k, 0] - x, points[first + k, 1] - y
        cross, along = ux * py - uy * px, ux * px + uy * py
        if along < 0.0:
            off = px * px + py * py
        elif along > square:
            off = (px - ux) ** 2 + (py - uy) ** 2
        else:
            off = cross * cross / square
        limit = scale * tolerances[first + k]
        if off > most * limit * limit:
            best, most = step, off / (limit * limit)
    return best


@leaf_kernel
def _write_ring(
    points: Array,
    first: int,
    n: int,
    tolerances: Array,
    scale: float,
    corners: Indices,
    count: int,
    fitted: bool,
    lines: Array,
    vertices: Array,
    written: int,
) -> int:
    """Write the corners of a ring, moved to where its fitted edges meet; the end, unmoved where nothing is left."""
    if count < 3:
        return written
    begin = written
    # Each line is a point and a direction; that of the edge before the first corner comes first.
    before, line = lines[0], lines[1]
    if fitted:
        _fit_edge(points, first, n, tolerances, scale, corners[count - 1], corners[0], before)
    for k in range(count):
        corner = first + corners[k]
        x, y = points[corner, 0], points[corner, 1]
        if fitted:
            _fit_edge(points, first, n, tolerances, scale, corners[k], corners[(k + 1) % count], line)
            sine = before[2] * line[3] - before[3] * line[2]
            t = ((line[0] - before[0]) * line[3] - (line[1] - before[1]) * line[2]) / sine if sine != 0.0 else np.inf
            meet_x, meet_y = before[0] + t * before[2], before[1] + t * before[3]
            reach = 2.0 * scale * tolerances[corner]
            if (meet_x - x) ** 2 + (meet_y - y) ** 2 <= reach * reach:
                x, y = meet_x, meet_y
            for m in range(4):
                before[m] = line[m]
        vertices[written, 0], vertices[written, 1] = x, y
        written += 1
    # A ring that turned over was thinner than the tolerance.
    was, now = 0.0, 0.0
    for k in range(n):
        m = k + 1 if k + 1 < n else 0
        was += points[first + k, 0] * points[first + m, 1] - points[first + m, 0] * points[first + k, 1]
    for k in range(begin, written):
        m = k + 1 if k + 1 < written else begin
        now += vertices[k, 0] * vertices[m, 1] - vertices[m, 0] * vertices[k, 1]
    return written if was * now > 0.0 else begin


@leaf_kernel
def _fit_edge(points: Array, first: int, n: int, tolerances: Array, scale: float, a: int, b: int, line: Array) -> None:
    """Write the least-squares line along a ring's stretch from one place to another: a point on it and a direction."""
    ax, ay = points[first + a, 0], points[first + a, 1]
    bx, by = points[first + b, 0], points[first + b, 1]
    ux, uy = bx - ax, by - ay
    length = np.sqrt(ux * ux + uy * uy)
    ux, uy = ux / length, uy / length
    # Outlines are cut and bent near corners; short edges have no more than that.
    margin = scale * max(tolerances[first + a], tolerances[first + b])
    margin = margin if length > 4.0 * margin else 0.0
    weight, s1, t1, s2, st = 0.0, 0.0, 0.0, 0.0, 0.0
    k = a
    while k != b:
        m = k + 1 if k + 1 < n else 0
        px, py = points[first + k, 0] - ax, points[first + k, 1] - ay
        qx, qy = points[first + m, 0] - ax, points[first + m, 1] - ay
        # Along the chord (s) and across it (t); a segment counts by its length along.
        ps, pt, qs, qt = ux * px + uy * py, ux * py - uy * px, ux * qx + uy * qy, ux * qy - uy * qx
        low, high = max(min(ps, qs), margin), min(max(ps, qs), length - margin)
        if high > low:
            w, s = high - low, 0.5 * (low + high)
            t = pt + (qt - pt) * (s - ps) / (qs - ps)
            slope = (qt - pt) / (qs - ps)
            weight += w
            s1 += w * s
            t1 += w * t
            s2 += w * (s * s + w * w / 12.0)
            st += w * (s * t + slope * w * w / 12.0)
        k = m
    line[0], line[1], line[2], line[3] = ax, ay, ux, uy
    if weight <= 0.0:
        return
    s1, t1 = s1 / weight, t1 / weight
    variance = s2 / weight - s1 * s1
    slope = (st / weight - s1 * t1) / variance if variance > 1e-18 else 0.0
    line[0], line[1] = ax + ux * s1 - uy * t1, ay + uy * s1 + ux * t1
    line[2], line[3] = ux - uy * slope, uy + ux * slope


@leaf_kernel
def _all_simple(vertices: Array, ends: Indices, following: Indices) -> bool:
    """Whether no two edges of rings touch but at the vertex that they share, and all rings lie inside the first.

    Following is room for the number of the vertex after each one.
    """
    total = ends[ends.shape[0] - 1]
    begin = 0
    for ring in range(ends.shape[0]):
        for v in range(begin, ends[ring]):
            following[v] = v + 1 if v + 1 < ends[ring] else begin
        inner = ring > 0 and ends[ring] > begin
        if inner and not contains_point(vertices[: ends[0]], vertices[begin, 0], vertices[begin, 1]):
            return False
        begin = ends[ring]
    for a in range(total):
        b = following[a]
        west, east = min(vertices[a, 0], vertices[b, 0]), max(vertices[a, 0], vertices[b, 0])
        south, north = min(vertices[a, 1], vertices[b, 1]), max(vertices[a, 1], vertices[b, 1])
        for c in range(a + 1, total):
            d = following[c]
            if max(vertices[c, 0], vertices[d, 0]) < west or min(vertices[c, 0], vertices[d, 0]) > east:
                continue
            if max(vertices[c, 1], vertices[d, 1]) < south or min(vertices[c, 1], vertices[d, 1]) > north:
                continue
            if c == b or d == a:
                # Neighbours may share their vertex alone: they overlap where one folds back onto the other.
                u, v, w = (a, b, d) if c == b else (c, a, b)
                if turn(vertices, u, v, w) == 0.0 and not _goes_on(vertices, u, v, w):
                    return False
            elif (
                turn(vertices, a, b, c) * turn(vertices, a, b, d) <= 0.0
                and turn(vertices, c, d, a) * turn(vertices, c, d, b) <= 0.0
            ):
                return False
    return True


@leaf_kernel
def _goes_on(vertices: Array, a: int, b: int, c: int) -> bool:
    """Whether the way from vertex b to c does not lead back towards a."""
    ux, uy = vertices[b, 0] - vertices[a, 0], vertices[b, 1] - vertices[a, 1]
    return ux * (vertices[c, 0] - vertices[b, 0]) + uy * (vertices[c, 1] - vertices[b, 1]) > 0.0
