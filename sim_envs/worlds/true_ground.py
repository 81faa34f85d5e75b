"""The true height of the ground under points: the tops of the course's boxes, exactly.

A vertical line through a point enters and leaves a box where it has crossed its three pairs of faces (Kay and Kajiya's
slab test, 1986); the highest way out over all boxes is the ground. Below everything there is a pit.
"""

from __future__ import annotations

import numpy as np

from skills.geometry.pose import Array, Pose
from skills.kernels import kernel

PIT = -np.inf


class TrueGround:
    """The boxes of a course as they stand now."""

    def __init__(self, sizes: Array, poses: tuple[Pose, ...]) -> None:
        """Take the full edge lengths of the boxes, (B, 3) [m], and their poses T_world_box."""
        self._half_sizes = 0.5 * np.asarray(sizes, dtype=np.float64).reshape(-1, 3)
        self._radii = np.linalg.norm(self._half_sizes, axis=1)
        self._centers = np.array([pose.p for pose in poses]).reshape(-1, 3)
        self._rotations = np.array([pose.R for pose in poses]).reshape(-1, 3, 3)

    def move(self, box: int, T_world_box: Pose) -> None:
        """Let one box stand elsewhere from now on."""
        self._centers[box] = T_world_box.p
        self._rotations[box] = T_world_box.R

    def heights(self, points_world: Array) -> Array:
        """Height of the ground above and below points (N, 2 or 3), (N,) [m]; `PIT` where there is none."""
        heights = np.full(len(points_world), PIT)
        points = np.ascontiguousarray(points_world, dtype=np.float64)
        _box_tops(self._centers, self._rotations, self._half_sizes, self._radii, points, heights)
        return heights


@kernel
def _box_tops(centers: Array, rotations: Array, half_sizes: Array, radii: Array, points: Array, heights: Array) -> None:
    """Raise each point's height to the highest box on its vertical line."""
    for b in range(centers.shape[0]):
        for i in range(points.shape[0]):
            dx, dy = points[i, 0] - centers[b, 0], points[i, 1] - centers[b, 1]
            if dx * dx + dy * dy > radii[b] * radii[b]:
                continue
            enter, leave = -np.inf, np.inf
            for k in range(3):
                origin = rotations[b, 0, k] * dx + rotations[b, 1, k] * dy
                slope = rotations[b, 2, k]
                if abs(slope) < 1e-12:
                    if abs(origin) > half_sizes[b, k]:
                        enter = np.inf
                    continue
                first, second = (-half_sizes[b, k] - origin) / slope, (half_sizes[b, k] - origin) / slope
                enter = max(enter, min(first, second))
                leave = min(leave, max(first, second))
            if enter <= leave:
                heights[i] = max(heights[i], centers[b, 2] + leave)
