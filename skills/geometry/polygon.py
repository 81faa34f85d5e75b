"""Planar polygons: area, hull, containment, clipping and approximate convex decomposition.

A polygon is an (N, 2) float64 array of vertices without a repeated last one, counter-clockwise unless said otherwise.
Clipping is Sutherland and Hodgman (1974), the hull Andrew's monotone chain (1979), and the decomposition follows Lien
and Amato, "Approximate convex decomposition of polygons" (2006), with diagonals as cuts. Kernels here may be called
from other kernels.
"""

from __future__ import annotations

from itertools import pairwise

import cv2
import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array
from skills.kernels import kernel

Indices = NDArray[np.int64]


@kernel
def signed_area(polygon: Array) -> float:
    """Area of a simple polygon, positive where it runs counter-clockwise [m^2]."""
    area = 0.0
    n = polygon.shape[0]
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        area += polygon[i, 0] * polygon[j, 1] - polygon[j, 0] * polygon[i, 1]
    return 0.5 * area


@kernel
def contains_point(polygon: Array, x: float, y: float) -> bool:
    """Whether a simple polygon of either direction holds a point; points on its edge may go either way."""
    inside = False
    n = polygon.shape[0]
    j = n - 1
    for i in range(n):
        if (polygon[i, 1] > y) != (polygon[j, 1] > y):
            slope = (polygon[j, 0] - polygon[i, 0]) / (polygon[j, 1] - polygon[i, 1])
            if x < polygon[i, 0] + slope * (y - polygon[i, 1]):
                inside = not inside
        j = i
    return inside


@kernel
def contains_points(polygon: Array, points: Array) -> NDArray[np.bool_]:
    """Which of the points (M, 2) a simple polygon holds, (M,) bool; points on its edge may go either way."""
    inside = np.empty(points.shape[0], np.bool_)
    for i in range(points.shape[0]):
        inside[i] = contains_point(polygon, points[i, 0], points[i, 1])
    return inside


@kernel
def clip_half_plane(polygon: Array, a: float, b: float, c: float) -> Array:
    """The part of a convex polygon where a x + b y <= c, (K, 2); K = 0 where nothing is left."""
    clipped = np.empty((polygon.shape[0] + 2, 2))
    count = _clip_once(polygon, polygon.shape[0], a, b, c, clipped)
    return clipped[:count]


@kernel
def clip_convex(subject: Array, clip: Array) -> Array:
    """Intersection of two convex counter-clockwise polygons, (K, 2); K = 0 where they do not overlap."""
    n = clip.shape[0]
    count = subject.shape[0]
    # Each half-plane adds at most one vertex to a convex polygon; the two buffers take turns.
    clipped = np.empty((count + n + 1, 2))
    given = np.empty((count + n + 1, 2))
    for i in range(count):
        clipped[i, 0], clipped[i, 1] = subject[i, 0], subject[i, 1]
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        a = clip[j, 1] - clip[i, 1]
        b = clip[i, 0] - clip[j, 0]
        given, clipped = clipped, given
        count = _clip_once(given, count, a, b, a * clip[i, 0] + b * clip[i, 1], clipped)
    return clipped[:count]


@kernel
def _clip_once(polygon: Array, n: int, a: float, b: float, c: float, clipped: Array) -> int:
    """Write the part of the first n vertices' polygon where a x + b y <= c; the number of its vertices, or 0."""
    capacity = clipped.shape[0]
    count = 0
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        here = c - a * polygon[i, 0] - b * polygon[i, 1]
        there = c - a * polygon[j, 0] - b * polygon[j, 1]
        if here >= 0.0 and count < capacity:
            clipped[count, 0], clipped[count, 1] = polygon[i, 0], polygon[i, 1]
            count += 1
        if here * there < 0.0 and count < capacity:
            t = here / (here - there)
            clipped[count, 0] = polygon[i, 0] + t * (polygon[j, 0] - polygon[i, 0])
            clipped[count, 1] = polygon[i, 1] + t * (polygon[j, 1] - polygon[i, 1])
            count += 1
    return count if count >= 3 else 0


def convex_hull(points: Array) -> Array:
    """Convex hull of points (M, 2), counter-clockwise without collinear vertices, (K, 2); K < 3 where there is none."""
    ordered = sorted({(float(x), float(y)) for x, y in np.asarray(points).reshape(-1, 2)})
    if len(ordered) < 3:
        return np.array(ordered).reshape(-1, 2)
    lower, upper = _chain(ordered), _chain(ordered[::-1])
    return np.array(lower[:-1] + upper[:-1])


def _chain(ordered: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """The half of a hull on the right of the way from the first to the last point."""
    chain: list[tuple[float, float]] = []
    for x, y in ordered:
        while len(chain) >= 2:
            (ax, ay), (bx, by) = chain[-2:]
            if (bx - ax) * (y - ay) - (by - ay) * (x - ax) > 0.0:
                break
            chain.pop()
        chain.append((x, y))
    return chain


def simplify(polygon: Array, tolerance: float) -> Array:
    """A polygon with fewer vertices that stays within a tolerance of the given one [m] (Douglas and Peucker, 1973)."""
    # OpenCV keeps single precision; near the origin of a region frame that is below a micrometre.
    short = cv2.approxPolyDP(np.ascontiguousarray(polygon, dtype=np.float32), tolerance, True)
    return short.reshape(-1, 2).astype(np.float64)


def convex_parts(polygon: Array, tolerance: float, holes: tuple[Array, ...] = ()) -> tuple[Array, ...]:
    """Convex polygons that together cover a simple polygon.

    A notch no deeper than the tolerance is filled rather than cut, so the parts cover all of the polygon and stay
    within the tolerance of it.

    Args:
        polygon: outline, (N, 2) counter-clockwise.
        tolerance: greatest depth of a notch that is filled [m].
        holes: outlines of holes, each (M, 2) clockwise, inside the polygon and apart from each other.
    """
    for hole in sorted(holes, key=lambda hole: -float(np.max(hole[:, 0]))):
        polygon = _bridge(polygon, hole)
    vertices, ends = _decompose(np.ascontiguousarray(polygon, dtype=np.float64), tolerance)
    starts = [0, *ends.tolist()]
    return tuple(vertices[a:b] for a, b in pairwise(starts))


def _bridge(polygon: Array, hole: Array) -> Array:
    """One outline that runs around the polygon and, over a doubled edge, around a hole; rightmost holes go first."""
    n, m = len(polygon), len(hole)
    hole = np.roll(hole, -int(np.argmax(hole[:, 0])), axis=0)
    vertices = np.vstack((polygon, hole))
    outer, inner = np.arange(n), np.arange(n, n + m)
    for i in np.argsort(np.linalg.norm(polygon - hole[0], axis=1), kind="stable"):
        if not (_blocked(vertices, outer, n, int(i), n) or _blocked(vertices, inner, m, int(i), n)):
            return vertices[np.concatenate((outer[: i + 1], inner, inner[:1], outer[i:]))]
    return polygon


@kernel
def _decompose(polygon: Array, tolerance: float) -> tuple[Array, Indices]:
    """Cut a polygon at its deepest notch until none is deeper than the tolerance; hulls, stacked, and their ends."""
    n = polygon.shape[0]
    # Every cut repeats two vertices, and there are fewer cuts than vertices.
    stack = np.empty(4 * n + 8, np.int64)
    sizes = np.empty(2 * n + 8, np.int64)
    vertices = np.empty((4 * n + 8, 2))
    ends = np.empty(2 * n + 8, np.int64)
    piece = np.empty(n, np.int64)
    hull = np.empty(n, np.int64)
    for i in range(n):
        stack[i] = i
    sizes[0] = n
    top, depth, written, parts = n, 1, 0, 0
    while depth > 0:
        depth -= 1
        m = sizes[depth]
        top -= m
        for k in range(m):
            piece[k] = stack[top + k]
        corners = _hull_of_piece(polygon, piece, m, hull)
        notch = _deepest_notch(polygon, piece, m, hull, corners, tolerance)
        other = _best_cut(polygon, piece, m, notch) if notch >= 0 else -1
        if other < 0:
            for k in range(corners):
                vertices[written, 0] = polygon[piece[hull[k]], 0]
                vertices[written, 1] = polygon[piece[hull[k]], 1]
                written += 1
            ends[parts] = written
            parts += 1
            continue
        for first, last in ((notch, other), (other, notch)):
            size = (last - first) % m + 1
            for k in range(size):
                stack[top + k] = piece[(first + k) % m]
            top += size
            sizes[depth] = size
            depth += 1
    return vertices[:written], ends[:parts]


@kernel
def _turn(polygon: Array, a: int, b: int, c: int) -> float:
    """Twice the signed area of a triangle of vertices: positive where a, b, c turn left."""
    ux, uy = polygon[b, 0] - polygon[a, 0], polygon[b, 1] - polygon[a, 1]
    return ux * (polygon[c, 1] - polygon[a, 1]) - uy * (polygon[c, 0] - polygon[a, 0])


@kernel
def _squared(polygon: Array, a: int, b: int) -> float:
    return (polygon[a, 0] - polygon[b, 0]) ** 2 + (polygon[a, 1] - polygon[b, 1]) ** 2


@kernel
def _hull_of_piece(polygon: Array, piece: Indices, m: int, hull: Indices) -> int:
    """Places in a piece of its hull's vertices, in its own order (gift wrapping from the lowest x); how many."""
    start = 0
    for i in range(1, m):
        x, least = polygon[piece[i], 0], polygon[piece[start], 0]
        if x < least or (x == least and polygon[piece[i], 1] < polygon[piece[start], 1]):
            start = i
    count, here = 0, start
    while count < m:
        hull[count] = here
        count += 1
        best = -1
        for i in range(m):
            if _squared(polygon, piece[i], piece[here]) == 0.0:
                continue
            turn = -1.0 if best < 0 else _turn(polygon, piece[here], piece[best], piece[i])
            further = best >= 0 and _squared(polygon, piece[here], piece[i]) > _squared(
                polygon, piece[here], piece[best]
            )
            if turn < 0.0 or (turn == 0.0 and further):
                best = i
        if best < 0 or _squared(polygon, piece[best], piece[start]) == 0.0:
            break
        here = best
    return count


@kernel
def _deepest_notch(polygon: Array, piece: Indices, m: int, hull: Indices, corners: int, tolerance: float) -> int:
    """Place of the vertex furthest behind the hull edge that bridges its pocket; -1 where none is beyond tolerance."""
    deepest, notch = tolerance, -1
    for k in range(corners):
        i, j = int(hull[k]), int(hull[(k + 1) % corners])
        length = np.sqrt(_squared(polygon, piece[i], piece[j]))
        v = (i + 1) % m
        while v != j:
            depth = _turn(polygon, piece[i], piece[j], piece[v]) / length
            if depth > deepest and _turn(polygon, piece[(v - 1) % m], piece[v], piece[(v + 1) % m]) < 0.0:
                deepest, notch = depth, v
            v = (v + 1) % m
    return notch


@kernel
def _best_cut(polygon: Array, piece: Indices, m: int, v: int) -> int:
    """Place of the vertex to cut to from notch v: near, opposite, best another notch; -1 where none is in sight."""
    best, least = -1, np.inf
    before, after = piece[(v - 1) % m], piece[(v + 1) % m]
    for j in range(m):
        if j == v or piece[j] == before or piece[j] == after:
            continue
        cost = _squared(polygon, piece[v], piece[j])
        # A cut outside the cone of the two prolonged edges leaves a notch at v.
        if _turn(polygon, before, piece[v], piece[j]) < 0.0 or _turn(polygon, piece[v], after, piece[j]) < 0.0:
            cost *= 4.0
        if _turn(polygon, piece[(j - 1) % m], piece[j], piece[(j + 1) % m]) < 0.0:
            cost *= 0.25
        if cost < least and _in_sight(polygon, piece, m, v, j):
            best, least = j, cost
    return best


@kernel
def _in_sight(polygon: Array, piece: Indices, m: int, v: int, w: int) -> bool:
    """Whether the segment between two places of a piece runs inside it without touching an edge or another vertex."""
    p, q = piece[v], piece[w]
    if not (_opens_to(polygon, piece, m, v, q) and _opens_to(polygon, piece, m, w, p)):
        return False
    return not _blocked(polygon, piece, m, p, q)


@kernel
def _blocked(polygon: Array, piece: Indices, m: int, p: int, q: int) -> bool:
    """Whether a piece's outline crosses or touches the open segment between two vertices."""
    length = np.sqrt(_squared(polygon, p, q))
    for i in range(m):
        a, b = piece[i], piece[(i + 1) % m]
        if min(_squared(polygon, a, p), _squared(polygon, a, q)) == 0.0:
            continue
        side_a, side_b = _turn(polygon, p, q, a), _turn(polygon, p, q, b)
        if abs(side_a) <= 1e-9 * length:
            # A vertex on the line of the segment blocks it where it lies between the ends.
            if _squared(polygon, a, p) + _squared(polygon, a, q) < length * length:
                return True
        elif side_a * side_b < 0.0 and _turn(polygon, a, b, p) * _turn(polygon, a, b, q) < 0.0:
            return True
    return False


@kernel
def _opens_to(polygon: Array, piece: Indices, m: int, v: int, p: int) -> bool:
    """Whether vertex p lies in the open wedge of the interior at a place of the piece, or on its sides at a bridge."""
    before, here, after = piece[(v - 1) % m], piece[v], piece[(v + 1) % m]
    left, right = _turn(polygon, here, after, p) > 0.0, _turn(polygon, before, here, p) > 0.0
    return (left and right) if _turn(polygon, before, here, after) >= 0.0 else (left or right)
