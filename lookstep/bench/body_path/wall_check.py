"""Judges a path by what really stands there, and by nothing that the planner has computed.

Two convex shapes are apart where a line along an edge of one of them separates them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.body_path import BodyPath
from skills.geometry.pose import Array

STEP = 0.01  # A path is looked at so often [m].


def touches(path: BodyPath, obstacles: Array, depth: float, width: float) -> bool:
    """Whether a body of a size (depth along the way, width across) touches an obstacle (N, 4, 2) on a path."""
    arcs = np.append(np.arange(0.0, path.length, STEP), path.length)
    bodies = _bodies(np.array([path.at(arc) for arc in arcs]), depth, width)
    return not bool((_apart(bodies, obstacles) | _apart(obstacles, bodies).T).all())


def _bodies(poses: Array, depth: float, width: float) -> Array:
    """Corners of the body at poses (M, 3), (M, 4, 2)."""
    cos, sin = np.cos(poses[:, 2]), np.sin(poses[:, 2])
    ahead, left = 0.5 * depth * np.column_stack((cos, sin)), 0.5 * width * np.column_stack((-sin, cos))
    corners = np.stack((-ahead - left, ahead - left, ahead + left, -ahead + left), axis=1)
    return poses[:, None, :2] + corners


def _apart(rectangles: Array, others: Array) -> NDArray[np.bool_]:
    """Whether an edge of a rectangle (M, 4, 2) separates it from another (N, 4, 2), (M, N)."""
    apart = np.zeros((len(rectangles), len(others)), dtype=bool)
    for k in range(2):
        edges = rectangles[:, k + 1] - rectangles[:, k]
        normals = np.column_stack((-edges[:, 1], edges[:, 0]))
        own = np.einsum("mij,mj->mi", rectangles, normals)
        their = np.einsum("nij,mj->mni", others, normals)
        apart |= (own.max(axis=1)[:, None] < their.min(axis=2)) | (their.max(axis=2) < own.min(axis=1)[:, None])
    return apart
