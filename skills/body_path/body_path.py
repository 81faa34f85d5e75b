"""The way of the body from start to goal, as a polyline of headings, and the sub-goals along it."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import Enum

import numpy as np

from skills.body_path.goal import Goal
from skills.geometry.pose import Array, readonly, wrap_angle


class PathEnd(Enum):
    """Where a path ends: at the goal, or why not there."""

    GOAL = "at the goal"
    BORDER = "at the border of the height map; the goal lies beyond"
    GOAL_OCCUPIED = "as near to the goal as it gets: the goal is inside an obstacle"
    GOAL_CUT_OFF = "as near to the goal as it gets: no way leads there"


@dataclass(frozen=True, slots=True, eq=False)
class BodyPath:
    """A way over the ground.

    Attributes:
        waypoints_world: (N >= 2, 3) rows of x, y [m] and heading yaw [rad].
        path_id: unique over a run.
        end: whether it ends at the goal, and why not.
        goal_world: (3,) where it is to lead, x, y [m] and heading [rad]; its last waypoint where not given.
        squares_up: whether the feet shall end beside each other right at its end; else near it is near enough.
        arc_lengths: distance from the start along the path to each waypoint, (N,) [m]; made from the waypoints.
    """

    waypoints_world: Array
    path_id: int = 0
    end: PathEnd = PathEnd.GOAL
    goal_world: Array | None = None
    squares_up: bool = True
    arc_lengths: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        waypoints = readonly(self.waypoints_world, (None, 3))
        if len(waypoints) < 2:
            raise ValueError(f"got {len(waypoints)} waypoints, a body path needs at least 2")
        lengths = np.linalg.norm(np.diff(waypoints[:, :2], axis=0), axis=1)
        goal = waypoints[-1] if self.goal_world is None else self.goal_world
        object.__setattr__(self, "waypoints_world", waypoints)
        object.__setattr__(self, "goal_world", readonly(goal, (3,)))
        object.__setattr__(self, "arc_lengths", readonly(np.concatenate(([0.0], np.cumsum(lengths)))))

    @property
    def length(self) -> float:
        """Length of the whole path [m]."""
        return float(self.arc_lengths[-1])

    def leads_to(self, goal: Goal) -> bool:
        """Whether it was planned to a goal, however far it comes."""
        return np.array_equal(self.goal_world, goal.xyyaw_world)  # type: ignore[arg-type]

    def project(self, point_world: Array) -> float:
        """Arc length of the path point nearest to a point, of which x and y count [m]."""
        starts, ends = self.waypoints_world[:-1, :2], self.waypoints_world[1:, :2]
        spans = ends - starts
        squared = np.maximum(np.einsum("ij,ij->i", spans, spans), 1e-12)
        fractions = np.clip(np.einsum("ij,ij->i", np.asarray(point_world)[:2] - starts, spans) / squared, 0.0, 1.0)
        distances = np.linalg.norm(starts + fractions[:, None] * spans - np.asarray(point_world)[:2], axis=1)
        nearest = int(np.argmin(distances))
        return float(self.arc_lengths[nearest] + fractions[nearest] * np.sqrt(squared[nearest]))

    def at(self, arc_length: float) -> Array:
        """Pose on the path, (3,): x, y [m], yaw [rad]; held at the ends."""
        arcs, waypoints = self.arc_lengths, self.waypoints_world
        i = int(np.clip(np.searchsorted(arcs, arc_length, side="right") - 1, 0, len(arcs) - 2))
        span = arcs[i + 1] - arcs[i]
        f = 1.0 if span <= 0.0 else float(np.clip((arc_length - arcs[i]) / span, 0.0, 1.0))
        xy = (1 - f) * waypoints[i, :2] + f * waypoints[i + 1, :2]
        turn = wrap_angle(waypoints[i + 1, 2] - waypoints[i, 2])
        return np.array((xy[0], xy[1], wrap_angle(waypoints[i, 2] + f * turn)))
