"""The true ground under a point: boxes at their present poses, asked from above and from within.

A vertical line meets a box in one interval of heights, where it lies between all three pairs of faces (the slab test of
Kay and Kajiya, 1986). The ground is the highest upper end over all boxes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from sim_envs.courses.course import Box
from skills.geometry.pose import Array, Pose, readonly
from skills.kernels import kernel

_SEAM = 1e-9  # Boxes are this much larger, so that no point falls between two that touch [m].


@dataclass(frozen=True, slots=True, eq=False)
class Ground:
    """Boxes at given poses.

    Attributes:
        boxes: the boxes of a course.
        poses: T_world_box of each, in the same order; as the boxes were placed by default.
    """

    boxes: tuple[Box, ...]
    poses: Sequence[Pose] | None = None
    _R: Array = field(init=False, repr=False)
    _p: Array = field(init=False, repr=False)
    _half: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        poses = tuple(box.T_world_box for box in self.boxes) if self.poses is None else tuple(self.poses)
        if len(poses) != len(self.boxes):
            raise ValueError(f"got {len(poses)} poses, needs one for each of {len(self.boxes)} boxes")
        object.__setattr__(self, "poses", poses)
        object.__setattr__(self, "_R", readonly(np.array([pose.R for pose in poses]).reshape(-1, 3, 3)))
        object.__setattr__(self, "_p", readonly(np.array([pose.p for pose in poses]).reshape(-1, 3)))
        object.__setattr__(self, "_half", readonly(0.5 * np.array([box.size for box in self.boxes]).reshape(-1, 3)))

    def ground_height(self, points_xy: Array) -> Array:
        """Height of the highest surface at points (N, 2), (N,); -inf over the pit [m]."""
        return self.surface(points_xy)[0]

    def surface(self, points_xy: Array) -> tuple[Array, Array, NDArray[np.int64]]:
        """The highest surface at points (N, 2): height (N,), unit normal (N, 3), index of its box (N,).

        Over the pit they are -inf, zero and -1.
        """
        return _look_down(_writable(points_xy, 2), self._R, self._p, self._half)

    def penetration(self, points_world: Array) -> Array:
        """Depth of points (N, 3) inside the deepest box around them, (N,); negative outside, -inf without boxes [m].

        The depth is the way to the nearest face; outside it is minus the largest distance along a box axis, a lower
        bound of the clearance.
        """
        return _penetrate(_writable(points_world, 3), self._R, self._p, self._half)


def _writable(points: Array, columns: int) -> Array:
    """A contiguous copy: read-only points would compile the kernels a second time."""
    return np.array(points, dtype=np.float64, order="C").reshape(-1, columns)


@kernel
def _look_down(points_xy: Array, R: Array, p: Array, half: Array) -> tuple[Array, Array, NDArray[np.int64]]:
    """Height (N,), normal (N, 3) and box (N,) of the highest surface under vertical lines."""
    n = len(points_xy)
    heights = np.full(n, -np.inf)
    normals = np.zeros((n, 3))
    boxes = np.full(n, -1)
    for b in range(len(p)):
        radius_squared = half[b, 0] ** 2 + half[b, 1] ** 2 + half[b, 2] ** 2
        for i in range(n):
            dx = points_xy[i, 0] - p[b, 0]
            dy = points_xy[i, 1] - p[b, 1]
            if dx * dx + dy * dy > radius_squared + 1e-6:
                continue
            low, high, face = -np.inf, np.inf, -1
            for k in range(3):
                slope = R[b, 2, k]
                middle = R[b, 0, k] * dx + R[b, 1, k] * dy
                bound = half[b, k] + _SEAM
                if abs(slope) < 1e-12:
                    if abs(middle) > bound:
                        low = np.inf
                    continue
                enter = (-np.sign(slope) * bound - middle) / slope
                leave = (np.sign(slope) * bound - middle) / slope
                low = max(low, enter)
                if leave < high:
                    high, face = leave, k
            if low <= high and face >= 0 and p[b, 2] + high > heights[i]:
                heights[i] = p[b, 2] + high
                sign = np.sign(R[b, 2, face])
                for axis in range(3):
                    normals[i, axis] = sign * R[b, axis, face]
                boxes[i] = b
    return heights, normals, boxes


@kernel
def _penetrate(points: Array, R: Array, p: Array, half: Array) -> Array:
    """Largest signed depth (N,) of points in any box."""
    depths = np.full(len(points), -np.inf)
    for i in range(len(points)):
        for b in range(len(p)):
            depth = np.inf
            for k in range(3):
                local = 0.0
                for axis in range(3):
                    local += R[b, axis, k] * (points[i, axis] - p[b, axis])
                depth = min(depth, half[b, k] - abs(local))
            depths[i] = max(depths[i], depth)
    return depths
