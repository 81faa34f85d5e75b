"""A body path straight to the goal: turn towards it, walk, turn to the goal's heading."""

from __future__ import annotations

import numpy as np

from skills.body_path.body_path import BodyPath
from skills.geometry.pose import Array

_TURN_LENGTH = 0.25


def straight_path(start_xyyaw: Array, goal_xyyaw: Array, path_id: int = 0) -> BodyPath:
    """Turn, walk, turn: four waypoints, or two where start and goal are too near each other to walk between.

    Args:
        start_xyyaw: (3,) x, y [m] and heading [rad] in the world.
        goal_xyyaw: the same of the goal.
        path_id: of the path.
    """
    start, goal = np.asarray(start_xyyaw, dtype=np.float64), np.asarray(goal_xyyaw, dtype=np.float64)
    way = goal[:2] - start[:2]
    length = float(np.hypot(*way))
    if length <= 2 * _TURN_LENGTH:
        return BodyPath(np.stack((start, goal)), path_id)
    direction, travel = way / length, np.arctan2(way[1], way[0])
    after_start = (*(start[:2] + _TURN_LENGTH * direction), travel)
    before_goal = (*(goal[:2] - _TURN_LENGTH * direction), travel)
    return BodyPath(np.stack((start, after_start, before_goal, goal)), path_id)
