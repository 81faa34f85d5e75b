"""How far a foot has brought the body: what a search aims at, and what being off the way costs."""

from __future__ import annotations

import numpy as np

from skills.footsteps.goal_field import look_up
from skills.footsteps.records import Records
from skills.geometry.pose import Array
from skills.kernels import kernel

# A foot may miss its place at the goal by so many tolerances where no better one is near; a tolerance is worth so many
# steps.
_LOOSE, _MISS = 2.0, 2.0


@kernel
def judge(
    limits: Records,
    goal: Records,
    path: Array,
    field: Array,
    x: float,
    y: float,
    z: float,
    heading: Array,
    sign: float,
    node: Records,
) -> None:
    """Judge a foot by the body beside it: the cost of being off the way, the estimated cost to go, whether it arrived.

    The way is a path, or where there is a field, that; `z` counts for a field alone.
    """
    yaw, cos, sin = heading[0], heading[1], heading[2]
    body_x = x + 0.5 * sign * limits.ideal_width * sin
    body_y = y - 0.5 * sign * limits.ideal_width * cos
    if field.shape[0] > 0:
        _judge_by_field(limits, goal, path, field, x, y, body_x, body_y, z, yaw, node)
    else:
        _judge_by_path(limits, goal, path, body_x, body_y, yaw, node)
    # Of two feet that are about as near the goal, one that stands there is a step ahead.
    node.to_go = node.left - limits.step_cost if goal.final and node.arrived else node.left


@kernel
def _judge_by_field(
    limits: Records,
    goal: Records,
    path: Array,
    field: Array,
    x: float,
    y: float,
    body_x: float,
    body_y: float,
    z: float,
    yaw: float,
    node: Records,
) -> None:
    """The field tells the cost to go and the heading; near its end the heading is the goal's."""
    last = path.shape[0] - 1
    to_go, way = look_up(limits, field, body_x, body_y, z)
    if to_go == np.inf:
        # Between two footholds there may be no ground under the body.
        to_go, way = look_up(limits, field, x, y, z)
    remaining = np.sqrt((body_x - path[last, 0]) ** 2 + (body_y - path[last, 1]) ** 2)
    turn = abs(wrapped(yaw - path[last, 2]))
    level = abs(z - goal.z) <= limits.goal_height_tolerance
    off, turned = remaining / limits.goal_tolerance, turn / limits.goal_yaw_tolerance
    node.arrived = level and off <= _LOOSE and turned <= _LOOSE
    if (level and remaining < limits.final_turn) or np.isnan(way):
        way = path[last, 2]
    node.off_path_cost = limits.yaw_cost * abs(wrapped(yaw - way))
    spared = limits.step_cost * limits.goal_tolerance / limits.stride
    turns = limits.step_cost * (turn - limits.goal_yaw_tolerance) / limits.turn
    node.left = max(to_go - spared, turns, 0.0)
    if node.arrived:
        node.left += limits.step_cost * _MISS * (max(off - 1.0, 0.0) + max(turned - 1.0, 0.0))


@kernel
def _judge_by_path(
    limits: Records, goal: Records, path: Array, body_x: float, body_y: float, yaw: float, node: Records
) -> None:
    """The estimate counts the steps that are needed at least, by the way left along the path and by the heading."""
    nearest, arc_length, off_heading = np.inf, 0.0, 0.0
    last = path.shape[0] - 1
    for i in range(last):
        span_x, span_y = path[i + 1, 0] - path[i, 0], path[i + 1, 1] - path[i, 1]
        squared = max(span_x * span_x + span_y * span_y, 1e-12)
        t = ((body_x - path[i, 0]) * span_x + (body_y - path[i, 1]) * span_y) / squared
        # The piece of the path goes straight on at its ends, but not past the goal.
        if i > 0:
            t = max(t, 0.0)
        if i < last - 1 or goal.ends:
            t = min(t, 1.0)
        off_x, off_y = body_x - path[i, 0] - t * span_x, body_y - path[i, 1] - t * span_y
        off = off_x * off_x + off_y * off_y
        if off < nearest:
            nearest = off
            arc_length = path[i, 3] + t * (path[i + 1, 3] - path[i, 3])
            off_heading = wrapped(yaw - path[i, 2] - min(max(t, 0.0), 1.0) * wrapped(path[i + 1, 2] - path[i, 2]))
    off_path = np.sqrt(nearest)
    turn = abs(wrapped(yaw - path[last, 2]))
    if goal.final:
        remaining = np.sqrt((body_x - path[last, 0]) ** 2 + (body_y - path[last, 1]) ** 2)
        node.arrived = remaining <= goal.along and turn <= goal.turn
    else:
        remaining = max(goal.arc_length - arc_length, 0.0)
        along, across = remaining / goal.along, off_path / goal.across
        node.arrived = along * along + across * across <= 1.0 and turn <= goal.turn
    node.off_path_cost = limits.path_cost * off_path + limits.yaw_cost * abs(off_heading)
    # What the tolerances spare is left out, so that the estimate never exceeds the true cost.
    node.left = limits.step_cost * max((remaining - goal.along) / goal.stride, (turn - goal.turn) / limits.turn, 0.0)


@kernel
def wrapped(angle: float) -> float:
    """The same angle within [-pi, pi)."""
    return angle - 2 * np.pi * np.floor((angle + np.pi) / (2 * np.pi))
