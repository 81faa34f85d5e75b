"""How far along its path a foot has brought the body: what a search aims at, and what being off the path costs."""

from __future__ import annotations

import numpy as np

from skills.footsteps.search_space import Records
from skills.geometry.pose import Array
from skills.kernels import kernel


@kernel
def judge(
    limits: Records, goal: Records, path: Array, x: float, y: float, heading: Array, sign: float, node: Records
) -> None:
    """Judge a foot by the body beside it: the cost of being off the path, the estimated cost to go, whether it arrived.

    The estimate counts the steps that are needed at least, by the way left along the path and by the heading.
    """
    yaw, cos, sin = heading[0], heading[1], heading[2]
    body_x = x + 0.5 * sign * limits.ideal_width * sin
    body_y = y - 0.5 * sign * limits.ideal_width * cos
    nearest, arc_length, off_heading = np.inf, 0.0, 0.0
    last = path.shape[0] - 1
    for i in range(last):
        span_x, span_y = path[i + 1, 0] - path[i, 0], path[i + 1, 1] - path[i, 1]
        squared = max(span_x * span_x + span_y * span_y, 1e-12)
        t = ((body_x - path[i, 0]) * span_x + (body_y - path[i, 1]) * span_y) / squared
        # The piece of the path goes straight on at its ends, but not past the goal.
        if i > 0:
            t = max(t, 0.0)
        if i < last - 1 or goal.final:
            t = min(t, 1.0)
        off_x, off_y = body_x - path[i, 0] - t * span_x, body_y - path[i, 1] - t * span_y
        off = off_x * off_x + off_y * off_y
        if off < nearest:
            nearest = off
            arc_length = path[i, 3] + t * (path[i + 1, 3] - path[i, 3])
            off_heading = _wrap(yaw - path[i, 2] - min(max(t, 0.0), 1.0) * _wrap(path[i + 1, 2] - path[i, 2]))
    off_path = np.sqrt(nearest)
    turn = abs(_wrap(yaw - path[last, 2]))
    if goal.final:
        near, aligned = limits.goal_tolerance, limits.goal_yaw_tolerance
        remaining = np.hypot(body_x - path[last, 0], body_y - path[last, 1])
        node.arrived = remaining <= near and turn <= aligned
    else:
        near, aligned = limits.along_tolerance, limits.heading_tolerance
        remaining = max(goal.arc_length - arc_length, 0.0)
        along, across = remaining / near, off_path / limits.across_tolerance
        node.arrived = along * along + across * across <= 1.0 and turn <= aligned
    node.off_path_cost = limits.path_cost * off_path + limits.yaw_cost * abs(off_heading)
    # What the tolerances spare is left out, so that the estimate never exceeds the true cost.
    node.to_go = limits.step_cost * max((remaining - near) / limits.stride, (turn - aligned) / limits.turn, 0.0)


@kernel
def _wrap(angle: float) -> float:
    return angle - 2 * np.pi * np.floor((angle + np.pi) / (2 * np.pi))
