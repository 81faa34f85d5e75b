"""How far one step brings the body, by the direction in which it goes: far ahead, less to the side and back."""

from __future__ import annotations

from itertools import pairwise
from math import cos, inf, sin

import numpy as np

from skills.footsteps.footstep_parameters import FootstepParameters
from skills.geometry.pose import Array, wrap_angle


def stride_towards(direction: float, parameters: FootstepParameters) -> float:
    """Most that the body moves in one step in a direction to the left of where the robot faces [rad], in [m].

    The body is the point beside a foot at half the ideal width: it moves on as the foot lands farther ahead or to the
    side, and a little more where the foot turns.
    """
    p, turn = parameters, max(parameters.inward_yaw, parameters.outward_yaw)
    forward, back = (reach + 0.5 * p.ideal_width * turn for reach in (p.reach, p.back_reach))
    widen = max(p.maximum_width - p.ideal_width, p.ideal_width - p.minimum_width)
    side = widen + 0.5 * p.ideal_width * (1.0 - cos(turn))
    ahead, across = cos(direction), abs(sin(direction))
    along = inf if ahead == 0.0 else (forward if ahead > 0.0 else back) / abs(ahead)
    return min(forward, along, inf if across == 0.0 else side / across)


def stride_along(path_world: Array, parameters: FootstepParameters) -> float:
    """Most that the body moves in one step on some piece of a path, rows of x, y [m] and heading [rad] and more."""
    strides = [
        stride_towards(wrap_angle(np.arctan2(after[1] - before[1], after[0] - before[0]) - yaw), parameters)
        for before, after in pairwise(path_world)
        for yaw in (before[2], after[2])
        if before[0] != after[0] or before[1] != after[1]
    ]
    return max(strides, default=stride_towards(0.0, parameters))
