"""Planar polygons: area, containment, clipping and convex hull.

A polygon is an (N, 2) float64 array of vertices without a repeated last one, counter-clockwise unless said otherwise.
Clipping is Sutherland and Hodgman (1974), the hull Andrew's monotone chain (1979). Kernels here may be called from
other kernels.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array
from skills.kernels import kernel, leaf_kernel


@leaf_kernel
def signed_area(polygon: Array) -> float:
    """Area of a simple polygon, positive where it runs counter-clockwise [m^2]."""
    area = 0.0
    n = polygon.shape[0]
    for i in range(n):
        j = i + 1 if i + 1 < n else 0
        area += polygon[i, 0] * polygon[j, 1] - polygon[j, 0] * polygon[i, 1]
    return 0.5 * area


@leaf_kernel
def centroid(polygon: Array) -> tuple[float, float]:
    """Centre of the area of a simple polygon of either direction."""
    area, x, y = 0.0, 0.0, 0.0
    # About the first vertex, where products stay small.
    for i in range(1, polygon.shape[0] - 1):
        ax, ay = polygon[i, 0] - polygon[0, 0], polygon[i, 1] - polygon[0, 1]
        bx, by = polygon[i + 1, 0] - polygon[0, 0], polygon[i + 1, 1] - polygon[0, 1]
        triangle = ax * by - bx * ay
        area += triangle
        x += triangle * (ax + bx)
        y += triangle * (ay + by)
    return polygon[0, 0] + x / (3.0 * area), polygon[0, 1] + y / (3.0 * area)


@leaf_kernel
def turn(polygon: Array, a: int, b: int, c: int) -> float:
    """Twice the signed area of a triangle of vertices: positive where a, b, c turn left."""
    ux, uy = polygon[b, 0] - polygon[a, 0], polygon[b, 1] - polygon[a, 1]
    return ux * (polygon[c, 1] - polygon[a, 1]) - uy * (polygon[c, 0] - polygon[a, 0])


@leaf_kernel
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


@leaf_kernel
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
