"""Flat-faced stand-ins for the primitive shapes of MuJoCo: vertices, and convex planar faces of three or four corners.

Every function returns `(vertices, faces)`: vertices (V, 3) in the geom frame [m], faces (F, 4) vertex indices counter-
clockwise seen from outside; a triangle repeats its last index. Round shapes are inscribed: with n segments a surface
lies at most r (1 - cos(pi / n)) inside the true one, 0.5 % of the radius r for n = 32.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array

Faces = NDArray[np.int64]
Shape = tuple[Array, Faces]


def box(half_sizes: Array) -> Shape:
    """A box of the given half sizes (3,) [m]."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=np.float64)
    quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return corners * half_sizes, np.array(quads)


def rectangle(half_x: float, half_y: float) -> Shape:
    """A rectangle in the xy plane that faces +z."""
    corners = np.array([[-half_x, -half_y, 0], [half_x, -half_y, 0], [half_x, half_y, 0], [-half_x, half_y, 0]])
    return corners, np.array([[0, 1, 2, 3]])


def ellipsoid(radii: Array, segments: int) -> Shape:
    """An ellipsoid with semi-axes radii (3,) [m]."""
    latitudes = np.linspace(-np.pi / 2, np.pi / 2, segments // 2 + 1)
    vertices, faces = _revolve(np.cos(latitudes), np.sin(latitudes), segments)
    return vertices * radii, faces


def capsule(radius: float, half_length: float, segments: int) -> Shape:
    """A capsule along z; half_length is that of its cylinder [m]."""
    latitudes = np.linspace(0, np.pi / 2, segments // 4 + 1)
    upper_r, upper_z = radius * np.cos(latitudes), half_length + radius * np.sin(latitudes)
    return _revolve(np.concatenate((upper_r[::-1], upper_r)), np.concatenate((-upper_z[::-1], upper_z)), segments)


def cylinder(radius: float, half_length: float, segments: int) -> Shape:
    """A cylinder along z [m]."""
    r = np.array([0.0, radius, radius, 0.0])
    return _revolve(r, half_length * np.array([-1.0, -1.0, 1.0, 1.0]), segments)


def _revolve(r: Array, z: Array, segments: int) -> Shape:
    """Turn a profile r(z) from pole to pole, listed from bottom to top, about the z axis."""
    r[0] = r[-1] = 0.0  # where a cosine is not quite
    angles = 2 * np.pi * np.arange(segments) / segments
    rings = np.empty((len(r), segments, 3))
    rings[..., 0] = np.outer(r, np.cos(angles))
    rings[..., 1] = np.outer(r, np.sin(angles))
    rings[..., 2] = z[:, None]
    ring, here = np.meshgrid(np.arange(len(r) - 1), np.arange(segments), indexing="ij")
    after = (here + 1) % segments
    below, above = ring * segments, (ring + 1) * segments
    quads = np.stack((below + here, below + after, above + after, above + here), axis=-1)
    # At a pole a ring is one point: the quads there are triangles.
    quads[0, :, :] = np.stack((below + here, above + after, above + here, above + here), axis=-1)[0]
    quads[-1, :, :] = np.stack((below + here, below + after, above + here, above + here), axis=-1)[-1]
    return rings.reshape(-1, 3), quads.reshape(-1, 4)


def height_field(heights: Array, half_x: float, half_y: float) -> Shape:
    """The top of a height field; heights (rows along y, columns along x) [m], split like MuJoCo's."""
    rows, columns = heights.shape
    y, x = np.meshgrid(np.linspace(-half_y, half_y, rows), np.linspace(-half_x, half_x, columns), indexing="ij")
    first = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    right, up, across = first + 1, first + columns, first + columns + 1
    lower, upper = (first, right, across, across), (first, across, up, up)
    faces = np.stack([np.stack(triangle, axis=-1) for triangle in (lower, upper)], axis=1)
    return np.stack((x, y, heights), axis=-1).reshape(-1, 3), faces.reshape(-1, 4)


def triangles(vertices: Array, corners: NDArray[np.integer]) -> Shape:
    """A triangle mesh; corners (F, 3) are vertex indices."""
    return np.asarray(vertices, dtype=np.float64), np.column_stack((corners, corners[:, 2])).astype(np.int64)


def is_closed(shape: Shape) -> bool:
    """Whether every edge belongs to two faces that run along it in opposite directions, so that back faces are hidden.

    Vertices at one place count as one.
    """
    vertices, faces = shape
    _, same = np.unique(vertices, axis=0, return_inverse=True)
    corners = same.reshape(-1)[faces]
    ends = np.stack((corners, np.roll(corners, -1, axis=1)), axis=-1).reshape(-1, 2)
    ends = ends[ends[:, 0] != ends[:, 1]]
    forward = ends[np.lexsort((ends[:, 1], ends[:, 0]))]
    backward = ends[np.lexsort((ends[:, 0], ends[:, 1]))][:, ::-1]
    return bool(np.array_equal(forward, backward))
