"""Planar polygons: area, hull, containment, clipping and approximate convex decomposition.

A polygon is an (N, 2) float64 array of vertices without a repeated last one, counter-clockwise unless said otherwise.
Clipping is Sutherland and Hodgman (1974), the hull Andrew's monotone chain (1979), and the decomposition follows Lien
and Amato, "Approximate convex decomposition of polygons" (2006), with diagonals as cuts. Kernels here may be called
from other kernels.
"""

from __future__ import annotations

import cv2
import numpy as np

from skills.geometry.pose import Array
from skills.kernels import kernel


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
def contains_points(polygon: Array, points: Array) -> np.ndarray:
    """Which of the points (M, 2) a simple polygon holds, (M,) bool; points on its edge may go either way."""
    inside = np.empty(points.shape[0], np.bool_)
    for i in range(points.shape[0]):
        inside[i] = contains_point(polygon, points[i, 0], points[i, 1])
    return inside


@kernel
def clip_half_plane(polygon: Array, a: float, b: float, c: float) -> Array:
    """The part of a convex polygon where a x + b y <= c, (K, 2); K = 0 where nothing is left."""
    n = polygon.shape[0]
    # A convex polygon gains at most one vertex; a slightly concave one may gain more and still must fit.
    clipped = np.empty((2 * n, 2))
    count = 0
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        here = c - a * polygon[i, 0] - b * polygon[i, 1]
        there = c - a * polygon[j, 0] - b * polygon[j, 1]
        if here >= 0.0:
            clipped[count] = polygon[i]
            count += 1
        if (here > 0.0 and there < 0.0) or (here < 0.0 and there > 0.0):
            t = here / (here - there)
            clipped[count, 0] = polygon[i, 0] + t * (polygon[j, 0] - polygon[i, 0])
            clipped[count, 1] = polygon[i, 1] + t * (polygon[j, 1] - polygon[i, 1])
            count += 1
    return clipped[: count if count >= 3 else 0].copy()


@kernel
def clip_convex(subject: Array, clip: Array) -> Array:
    """Intersection of two convex counter-clockwise polygons, (K, 2); K = 0 where they do not overlap."""
    clipped = subject.copy()
    n = clip.shape[0]
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        a = clip[j, 1] - clip[i, 1]
        b = clip[i, 0] - clip[j, 0]
        clipped = clip_half_plane(clipped, a, b, a * clip[i, 0] + b * clip[i, 1])
        if clipped.shape[0] == 0:
            break
    return clipped


def convex_hull(points: Array) -> Array:
    """Convex hull of points (M, 2), counter-clockwise without collinear vertices, (K, 2); K < 3 where they are on a line."""
    points = np.asarray(points, dtype=np.float64).reshape(-1, 2)
    return _hull_of_sorted(points[np.lexsort((points[:, 1], points[:, 0]))])


@kernel
def _hull_of_sorted(points: Array) -> Array:
    n = points.shape[0]
    hull = np.empty((2 * n + 2, 2))
    count = 0
    for sweep in range(2):
        start = count
        for k in range(n):
            p = points[k] if sweep == 0 else points[n - 1 - k]
            while count - start >= 2 and _turn(hull[count - 2], hull[count - 1], p) <= 0.0:
                count -= 1
            hull[count] = p
            count += 1
        count -= 1
    return hull[: max(count, min(n, 1))].copy()


@kernel
def _turn(a: Array, b: Array, c: Array) -> float:
    """Twice the signed area of a triangle: positive where a, b, c turn left."""
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])


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
    return tuple(np.split(vertices, ends[:-1]))


def _bridge(polygon: Array, hole: Array) -> Array:
    """One outline that runs around the polygon and, over a doubled edge, around a hole; rightmost holes go first."""
    k = int(np.argmax(hole[:, 0]))
    distance = np.linalg.norm(polygon - hole[k], axis=1)
    for i in np.argsort(distance, kind="stable"):
        if not _crosses(polygon, polygon[i], hole[k]) and not _crosses(hole, polygon[i], hole[k]):
            return np.vstack((polygon[: i + 1], np.roll(hole, -k, axis=0), hole[k : k + 1], polygon[i:]))
    return polygon


@kernel
def _crosses(polygon: Array, p: Array, q: Array) -> bool:
    """Whether the open segment p q meets an edge or a vertex that is not one of its ends."""
    n = polygon.shape[0]
    length = np.hypot(q[0] - p[0], q[1] - p[1])
    for i in range(n):
        a = polygon[i]
        b = polygon[i + 1 if i + 1 < n else 0]
        side_a, side_b = _turn(p, q, a), _turn(p, q, b)
        if (side_a > 0.0) != (side_b > 0.0) and (_turn(a, b, p) > 0.0) != (_turn(a, b, q) > 0.0):
            at_end = (a[0] == p[0] and a[1] == p[1]) or (b[0] == p[0] and b[1] == p[1])
            at_end = at_end or (a[0] == q[0] and a[1] == q[1]) or (b[0] == q[0] and b[1] == q[1])
            if not at_end:
                return True
        along = ((a[0] - p[0]) * (q[0] - p[0]) + (a[1] - p[1]) * (q[1] - p[1])) / length
        if abs(side_a) <= 1e-9 * length and 1e-9 < along < length - 1e-9:
            return True
    return False


@kernel
def _decompose(polygon: Array, tolerance: float) -> tuple[Array, np.ndarray]:
    """Cut a polygon at its deepest notch until none is deeper than the tolerance; hulls, stacked, and their ends."""
    n = polygon.shape[0]
    # Every cut repeats two vertices, and there are fewer cuts than vertices.
    stack = np.empty(4 * n + 8, np.int64)
    sizes = np.empty(2 * n + 8, np.int64)
    vertices = np.empty((4 * n + 8, 2))
    ends = np.empty(2 * n + 8, np.int64)
    stack[:n] = np.arange(n)
    sizes[0] = n
    top, depth, written, parts = n, 1, 0, 0
    while depth > 0:
        m = sizes[depth - 1]
        order = stack[top - m : top].copy()
        piece = polygon[order]
        hull = _hull_indices(piece)
        notch = _deepest_notch(piece, hull, tolerance)
        other = _best_cut(piece, notch) if notch >= 0 else -1
        top -= m
        depth -= 1
        if other < 0:
            for k in range(hull.shape[0]):
                vertices[written] = piece[hull[k]]
                written += 1
            ends[parts] = written
            parts += 1
            continue
        first, last = min(notch, other), max(notch, other)
        for k in range(first, last + 1):
            stack[top] = order[k]
            top += 1
        sizes[depth] = last - first + 1
        depth += 1
        for k in range(last, first + m + 1):
            stack[top] = order[k % m]
            top += 1
        sizes[depth] = first + m - last + 1
        depth += 1
    return vertices[:written].copy(), ends[:parts].copy()


@kernel
def _hull_indices(piece: Array) -> np.ndarray:
    """Which vertices of a simple polygon are on its hull, in its own order (gift wrapping, from the lowest x)."""
    n = piece.shape[0]
    start = 0
    for i in range(1, n):
        if piece[i, 0] < piece[start, 0] or (piece[i, 0] == piece[start, 0] and piece[i, 1] < piece[start, 1]):
            start = i
    hull = np.empty(n, np.int64)
    count = 0
    here = start
    while count < n:
        hull[count] = here
        count += 1
        best = -1
        for i in range(n):
            if piece[i, 0] == piece[here, 0] and piece[i, 1] == piece[here, 1]:
                continue
            if best < 0:
                best = i
                continue
            turn = _turn(piece[here], piece[best], piece[i])
            if turn < 0.0 or (turn == 0.0 and _squared(piece[here], piece[i]) > _squared(piece[here], piece[best])):
                best = i
        if best < 0 or (piece[best, 0] == piece[start, 0] and piece[best, 1] == piece[start, 1]):
            break
        here = best
    return hull[:count].copy()


@kernel
def _squared(p: Array, q: Array) -> float:
    return (p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2


@kernel
def _deepest_notch(piece: Array, hull: np.ndarray, tolerance: float) -> int:
    """The vertex furthest behind the hull edge that bridges its pocket; -1 where none exceeds the tolerance."""
    n = piece.shape[0]
    deepest, notch = tolerance, -1
    for k in range(hull.shape[0]):
        i, j = hull[k], hull[(k + 1) % hull.shape[0]]
        length = np.sqrt(_squared(piece[i], piece[j]))
        v = (i + 1) % n
        while v != j and length > 0.0:
            depth = _turn(piece[i], piece[j], piece[v]) / length
            if depth > deepest and _turn(piece[v - 1], piece[v], piece[(v + 1) % n]) < 0.0:
                deepest, notch = depth, v
            v = (v + 1) % n
    return notch


@kernel
def _best_cut(piece: Array, v: int) -> int:
    """The vertex that the cut from notch v goes to: near, opposite, and best another notch; -1 where none is in sight."""
    n = piece.shape[0]
    before, after = piece[v - 1], piece[(v + 1) % n]
    best, least = -1, np.inf
    for j in range(n):
        if j == v or j == (v + 1) % n or (j + 1) % n == v or _squared(piece[v], piece[j]) == 0.0:
            continue
        if not _between(piece, v, piece[j]) or not _between(piece, j, piece[v]):
            continue
        cost = _squared(piece[v], piece[j])
        if cost >= 4.0 * least or _crosses(piece, piece[v], piece[j]):
            continue
        # A cut outside the cone of the two prolonged edges leaves a notch at v.
        if _turn(before, piece[v], piece[j]) < 0.0 or _turn(piece[v], after, piece[j]) < 0.0:
            cost *= 4.0
        if _turn(piece[j - 1], piece[j], piece[(j + 1) % n]) < 0.0:
            cost *= 0.25
        if cost < least:
            best, least = j, cost
    return best


@kernel
def _between(piece: Array, i: int, p: Array) -> bool:
    """Whether p lies in the open wedge of the interior at vertex i."""
    n = piece.shape[0]
    before, here, after = piece[i - 1], piece[i], piece[(i + 1) % n]
    if _turn(before, here, after) >= 0.0:
        return _turn(here, after, p) > 0.0 and _turn(before, here, p) > 0.0
    return _turn(here, after, p) > 0.0 or _turn(before, here, p) > 0.0
