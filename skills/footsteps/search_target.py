"""What a search for footsteps aims at: a way along a path, or a goal and how far every place is from it."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from skills.footsteps.footstep import Stance
from skills.footsteps.footstep_parameters import FootstepParameters
from skills.footsteps.goal_field import empty_field
from skills.footsteps.stride import stride_along
from skills.geometry.pose import Array, wrap_angle

if TYPE_CHECKING:
    from skills.body_path.sub_goal import SubGoal


@dataclass(frozen=True, slots=True, eq=False)
class SearchTarget:
    """Where a search goes, and where it looks.

    Attributes:
        path_world: the way there, (N >= 2, 4) rows of x, y [m], yaw [rad], arc length [m]; its end is the goal.
        arc_length: progress along it that ends the search, where it is not final [m].
        ends: whether the way ends there, so that nothing is gained beyond.
        final: whether both feet are to stand at the end.
        stride: most that a step brings the body on [m].
        tolerances: what the last foot may be off along the way [m], across it [m] and in heading [rad].
        low_world, high_world: corners of the ground that is searched, (2,) [m].
        z: height of the goal [m]; counts with a field.
        field: see `goal_field`; empty where the path guides.
    """

    path_world: Array
    arc_length: float
    ends: bool
    final: bool
    stride: float
    tolerances: tuple[float, float, float]
    low_world: Array
    high_world: Array
    z: float = 0.0
    field: Array = field(default_factory=empty_field)

    @classmethod
    def on_path(cls, goal: SubGoal, stance: Stance, parameters: FootstepParameters) -> SearchTarget:
        """Progress along a path."""
        p, (low, high) = parameters, search_window(stance, goal, parameters)
        ends = goal.search_arc_length >= goal.path.length
        if goal.final:
            tolerances = p.goal_tolerance, p.goal_tolerance, p.goal_yaw_tolerance
        elif ends:
            tolerances = p.near_goal, p.near_goal, p.goal_yaw_tolerance
        else:
            tolerances = p.along_tolerance, p.across_tolerance, p.heading_tolerance
        stride = stride_along(goal.searched_world, p)
        return cls(goal.searched_world, goal.search_arc_length, ends, goal.final, stride, tolerances, low, high)

    def turn(self, yaw: float, parameters: FootstepParameters) -> float:
        """How far from a heading the headings that are searched go [rad]."""
        if self.field.size:
            return np.pi
        return max(abs(wrap_angle(there - yaw)) for there in self.path_world[:, 2]) + parameters.heading_margin


def search_window(stance: Stance, goal: SubGoal, parameters: FootstepParameters) -> tuple[Array, Array]:
    """Corners of the ground that is searched from a stance to a sub-goal."""
    points = np.vstack((goal.searched_world[:, :2], stance.T_world_left.p[:2], stance.T_world_right.p[:2]))
    return points.min(axis=0) - parameters.window_margin, points.max(axis=0) + parameters.window_margin
