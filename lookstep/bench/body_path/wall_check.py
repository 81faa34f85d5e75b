"""Judges a path by what really stands there, and by nothing that the planner has computed.

Two convex shapes are apart where a line along an edge of one of them separates them.
"""

from __future__ import annotations

import numpy as np

from skills.body_path import BodyPath
from skills.geometry.pose import Array

STEP = 0.01  # A path is looked at so often [m].


def touches(path: BodyPath, obstacles: Array, depth: float, width: float) -> bool:
    """Whether a body of a size (depth along the way, width across) touches an obstacle (N, 4, 2) on a path."""
    arcs = np.append(np.arange(0.0, path.length, STEP), path.length)
    return any(_touches_any(_body(path.at(arc), depth, width), obstacles) for arc in arcs)


def _body(pose: Array, depth: float, width: float) -> Array:
    """Corners of the body at a pose (4, 2)."""
    x, y, yaw = pose
    ahead, left = np.array((np.cos(yaw), np.sin(yaw))), np.array((-np.sin(yaw), np.cos(yaw)))
    signs = ((-1, -1), (1, -1), (1, 1), (-1, 1))
    return np.array([(x, y) + 0.5 * (a * depth * ahead + b * width * left) for a, b in signs])


def _touches_any(body: Array, obstacles: Array) -> bool:
    apart = np.zeros(len(obstacles), dtype=bool)
    for normal in _normals(body):
        apart |= _separates(body @ normal, obstacles @ normal)
    for k in range(2):
        edges = obstacles[:, k + 1] - obstacles[:, k]
        normals = np.column_stack((-edges[:, 1], edges[:, 0]))
        apart |= _separates(normals @ body.T, np.einsum("nij,nj->ni", obstacles, normals))
    return not bool(apart.all())


def _normals(body: Array) -> Array:
    edges = body[1:3] - body[:2]
    return np.column_stack((-edges[:, 1], edges[:, 0]))


def _separates(body: Array, obstacles: Array) -> Array:
    """Whether the shadows of body and obstacles on a line are apart, for each obstacle."""
    return (body.max(axis=-1) < obstacles.min(axis=-1)) | (obstacles.max(axis=-1) < body.min(axis=-1))
