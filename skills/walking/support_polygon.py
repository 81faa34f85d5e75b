"""Where the centre of pressure may be: the convex hull of the footholds in contact, seen from above."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from skills.geometry.polygon import convex_hull
from skills.geometry.pose import Array, Pose


def foothold_corners(T_world_sole: Pose, foothold_sole: Array, margin: float) -> Array:
    """Corners of a foothold from above, each drawn towards the middle by a margin, (N, 2) in the world [m]."""
    middle = foothold_sole.mean(axis=0)
    spokes = foothold_sole - middle
    lengths = np.linalg.norm(spokes, axis=1, keepdims=True)
    corners = middle + spokes * np.maximum(0.0, 1.0 - margin / np.maximum(lengths, 1e-9))
    return corners @ T_world_sole.R[:2, :2].T + T_world_sole.p[:2]


class SupportPolygon:
    """The convex hull of corners in contact.

    Args:
        corners: of each foot in contact, (N, 2) in the world [m].
    """

    def __init__(self, corners: Sequence[Array]) -> None:
        self.hull_world = convex_hull(np.vstack(corners))
        edges = np.roll(self.hull_world, -1, axis=0) - self.hull_world
        lengths = np.linalg.norm(edges, axis=1)
        self._edges = edges
        self._squares = lengths**2
        self._normals = np.column_stack((edges[:, 1], -edges[:, 0])) / lengths[:, None]

    def distance(self, point: Array) -> float:
        """How far a point (2,) lies outside; negative inside [m]."""
        outside = np.max(np.einsum("nd,nd->n", self._normals, point - self.hull_world))
        return float(outside) if outside <= 0.0 else float(np.linalg.norm(point - self.nearest(point)))

    def nearest(self, point: Array) -> Array:
        """The nearest point of the polygon, (2,) [m]."""
        offsets = point - self.hull_world
        if np.all(np.einsum("nd,nd->n", self._normals, offsets) <= 0.0):
            return point
        along = np.clip(np.einsum("nd,nd->n", self._edges, offsets) / self._squares, 0.0, 1.0)
        candidates = self.hull_world + along[:, None] * self._edges
        return candidates[np.argmin(np.sum((candidates - point) ** 2, axis=1))]
