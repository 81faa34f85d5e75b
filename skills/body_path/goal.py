"""Where the robot is sent: a place, or several in turn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skills.geometry.pose import Array


@dataclass(frozen=True, slots=True)
class Goal:
    """A place and heading for the mid-feet.

    Attributes:
        x, y: position in the world [m].
        yaw: heading in the world [rad].
    """

    x: float
    y: float
    yaw: float

    def __post_init__(self) -> None:
        if not np.isfinite([self.x, self.y, self.yaw]).all():
            raise ValueError(f"got goal ({self.x}, {self.y}, {self.yaw}), needs finite numbers")

    def __str__(self) -> str:
        return f"x {self.x:.2f} m, y {self.y:.2f} m, yaw {self.yaw:.2f} rad"

    @property
    def xyyaw_world(self) -> Array:
        """(3,): x, y [m], yaw [rad]."""
        return np.array((self.x, self.y, self.yaw))


@dataclass(frozen=True, slots=True)
class Waypoints:
    """Places to be visited in turn.

    Attributes:
        route_id: unique over a run.
        goals: at least one.
    """

    route_id: int
    goals: tuple[Goal, ...]
