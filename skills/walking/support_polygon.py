"""Where the centre of pressure may be: the convex hull of the footholds in contact, seen from above."""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

import numpy as np

from skills.geometry.polygon import convex_hull
from skills.geometry.pose import Array, Pose


class SupportPolygon:
    """The convex hull of corners in contact.

    Args:
        corners: of each foot in contact, (N, 2) in the world [m].
    """

    def __init__(self, corners: Sequence[Array]) -> None:
        self.hull_world = convex_hull(np.vstack(corners))
        edges = np.roll(self.hull_world, -1, axis=0) - self.hull_world
        # Each edge as start, unit direction and length: plain floats, for a few edges faster than arrays.
        self._edges = [
            (float(x), float(y), float(dx) / hypot(dx, dy), float(dy) / hypot(dx, dy), hypot(dx, dy))
            for (x, y), (dx, dy) in zip(self.hull_world, edges, strict=True)
        ]

    def distance(self, point: Array) -> float:
        """How far a point (2,) lies outside; negative inside [m]."""
        x, y = float(point[0]), float(point[1])
        outside = max((x - ax) * dy - (y - ay) * dx for ax, ay, dx, dy, _ in self._edges)
        if outside <= 0.0:
            return outside
        nearest = self.nearest(point)
        return hypot(x - nearest[0], y - nearest[1])

    def nearest(self, point: Array) -> Array:
        """The nearest point of the polygon, (2,) [m]."""
        x, y = float(point[0]), float(point[1])
        best, least, inside = (x, y), float("inf"), True
        for ax, ay, dx, dy, length in self._edges:
            inside = inside and (x - ax) * dy - (y - ay) * dx <= 0.0
            along = min(max((x - ax) * dx + (y - ay) * dy, 0.0), length)
            candidate = (ax + along * dx, ay + along * dy)
            distance = hypot(x - candidate[0], y - candidate[1])
            if distance < least:
                best, least = candidate, distance
        return point if inside else np.array(best)


def foothold_corners(T_world_sole: Pose, foothold_sole: Array, margin: float) -> Array:
    """Corners of a foothold from above, each drawn towards the middle by a margin, (N, 2) in the world [m]."""
    middle = foothold_sole.mean(axis=0)
    spokes = foothold_sole - middle
    lengths = np.linalg.norm(spokes, axis=1, keepdims=True)
    corners = middle + spokes * np.maximum(0.0, 1.0 - margin / np.maximum(lengths, 1e-9))
    return corners @ T_world_sole.R[:2, :2].T + T_world_sole.p[:2]
