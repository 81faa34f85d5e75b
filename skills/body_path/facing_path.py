"""A path to the goal on which the robot faces all the way as it will there: sideways, backward, or turning in place."""

from __future__ import annotations

import numpy as np

from skills.body_path.body_path import BodyPath
from skills.geometry.pose import Array, wrap_angle


def facing_path(start_xyyaw: Array, goal_xyyaw: Array, most_turn: float, path_id: int = 0) -> BodyPath:
    """Straight to the goal, with the goal's heading from the start on, or as near to it as one may turn at once.

    Args:
        start_xyyaw: (3,) x, y [m] and heading [rad] in the world.
        goal_xyyaw: the same of the goal.
        most_turn: a goal that is turned farther from the start takes another path later [rad].
        path_id: of the path.
    """
    start, goal = np.asarray(start_xyyaw, dtype=np.float64), np.asarray(goal_xyyaw, dtype=np.float64)
    yaw = start[2] + np.clip(wrap_angle(goal[2] - start[2]), -most_turn, most_turn)
    way = np.array(((start[0], start[1], yaw), (goal[0], goal[1], yaw)))
    return BodyPath(way, path_id, goal_world=goal, squares_up=False)
