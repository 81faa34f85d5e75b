"""Capsules: the shape in which sensors are told where the robot's own body is."""

from __future__ import annotations

from dataclasses import dataclass

from skills.geometry.pose import Array, Pose, readonly


@dataclass(frozen=True, slots=True, eq=False)
class Capsule:
    """All points within a distance of a line segment.

    Attributes:
        start_world, end_world: ends of its axis, (3,) [m].
        radius: distance from the axis [m].
    """

    start_world: Array
    end_world: Array
    radius: float

    def __post_init__(self) -> None:
        for name in ("start_world", "end_world"):
            object.__setattr__(self, name, readonly(getattr(self, name), (3,)))

    def moved(self, T: Pose) -> Capsule:
        """The same capsule seen from another frame."""
        return Capsule(T @ self.start_world, T @ self.end_world, self.radius)
