"""The sub-goal of look-and-step: how far along the body path the next steps go, and whether the goal is reached.

Both look at the imminent stance, the one after the step under way (Calvert et al., 2022).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from skills.body_path.body_path import BodyPath
from skills.body_path.goal import Goal
from skills.footsteps.footstep import Stance
from skills.geometry.pose import Array, readonly, wrap_angle
from skills.parameters import parameter, parameters

# A way that leads farther from where the robot faces leads aside [rad].
_ASIDE = 0.8


@parameters
class SubGoalParameters:
    """How far ahead the next steps go, and what counts as arrived."""

    ahead: float = parameter(0.8, unit="m", meaning="sub-goal ahead of the stance", minimum=0.2, maximum=5.0)
    ahead_in_curve: float = parameter(0.4, unit="m", meaning="the same in tight curves", minimum=0.2, maximum=5.0)
    ahead_aside: float = parameter(
        0.35, unit="m", meaning="the same where the path leads sideways or back", minimum=0.1, maximum=5.0
    )
    search_beyond: float = parameter(0.4, unit="m", meaning="search on past the sub-goal by", minimum=0.0, maximum=5.0)
    tight_turn: float = parameter(0.6, unit="rad", meaning="turn within `ahead` that is a tight curve", minimum=0.0)
    goal_distance: float = parameter(0.12, unit="m", meaning="position tolerance at the goal", minimum=0.01)
    goal_yaw: float = parameter(0.2, unit="rad", meaning="heading tolerance at the goal", minimum=0.01)


@dataclass(frozen=True, slots=True, eq=False)
class SubGoal:
    """A point on a body path to which the next steps lead.

    Attributes:
        path: the body path.
        start_arc_length: where on it the imminent stance is [m].
        arc_length: where the sub-goal is [m].
        search_arc_length: how far the search for steps looks, at or past the sub-goal [m].
        searched_world: the path from the stance to there, (N >= 2, 4) rows of x, y [m], yaw [rad], arc length [m].
    """

    path: BodyPath
    start_arc_length: float
    arc_length: float
    search_arc_length: float
    searched_world: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "searched_world", readonly(self.searched_world, (None, 4)))

    @property
    def pose_world(self) -> Array:
        """The sub-goal, (3,): x, y [m], yaw [rad]."""
        return self.path.at(self.arc_length)

    @property
    def final(self) -> bool:
        """Whether the search reaches the end of the path, and the feet shall stand there."""
        return self.path.squares_up and self.search_arc_length >= self.path.length


def sub_goal(path: BodyPath, imminent_stance: Stance, parameters: SubGoalParameters) -> SubGoal:
    """Move along the path from the middle of the imminent stance, less far in curves and where steps are short."""
    start = path.project(imminent_stance.mid_feet)
    ahead, beyond = parameters.ahead, parameters.search_beyond
    if _leads_aside(path, start, min(start + ahead, path.length)):
        ahead, beyond = parameters.ahead_aside, beyond * parameters.ahead_aside / ahead
    elif _turn(path, start, parameters) > parameters.tight_turn:
        ahead = parameters.ahead_in_curve
    arc_length = min(start + ahead, path.length)
    end = min(arc_length + beyond, path.length)
    searched = np.array([(*path.at(s), s) for s in _stations(path, start, end)])
    return SubGoal(path, start, arc_length, end, searched)


def goal_reached(goal: Goal, imminent_stance: Stance, parameters: SubGoalParameters) -> bool:
    """Whether the imminent stance is at the goal, by position and heading."""
    distance = np.hypot(*(imminent_stance.mid_feet[:2] - (goal.x, goal.y)))
    turn = abs(wrap_angle(imminent_stance.yaw - goal.yaw))
    return bool(distance <= parameters.goal_distance and turn <= parameters.goal_yaw)


def _turn(path: BodyPath, start: float, parameters: SubGoalParameters) -> float:
    """How much the path turns, in all, from the start to `ahead` [rad]."""
    headings = [path.at(s)[2] for s in _stations(path, start, min(start + parameters.ahead, path.length))]
    return sum(abs(wrap_angle(after - before)) for before, after in pairwise(headings))


def _leads_aside(path: BodyPath, start: float, end: float) -> bool:
    """Whether the path leads sideways or back all the way from start to end."""
    poses = [path.at(s) for s in _stations(path, start, end)]
    ways = [(after - before)[:2] for before, after in pairwise(poses)]
    off = [
        abs(wrap_angle(float(np.arctan2(way[1], way[0])) - pose[2]))
        for way, ends in zip(ways, pairwise(poses), strict=True)
        for pose in ends
        if way.any()
    ]
    return min(off, default=0.0) > _ASIDE


def _stations(path: BodyPath, start: float, end: float) -> list[float]:
    """Arc lengths of the start, the waypoints between, and the end."""
    return [start, *(float(s) for s in path.arc_lengths if start < s < end), end]
