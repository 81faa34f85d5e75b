"""From the points of a way to a body path: points that are not needed go, and the body turns to where it walks.

The body looks along the way. At the start it turns from its own heading to that of the way, and at the goal from that
of the way to the goal's, each over a short distance.
"""

from __future__ import annotations

import numpy as np

from skills.body_path.body_path import BodyPath, PathEnd
from skills.body_path.goal import Goal
from skills.body_path.path_parameters import BodyPathParameters
from skills.geometry.pose import Array


def path_along(
    points: Array, start_yaw: float, goal: Goal, end: PathEnd, parameters: BodyPathParameters, path_id: int = 0
) -> BodyPath:
    """The path over points (N >= 2, 2); the goal's heading counts where it ends at the goal."""
    p = parameters
    arcs = np.concatenate(([0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))))
    turns_at_goal = end is PathEnd.GOAL
    if arcs[-1] <= 2.0 * p.turn_length:
        last_yaw = goal.yaw if turns_at_goal else start_yaw
        ends = ((*points[0], start_yaw), (*points[-1], last_yaw))
        return BodyPath(np.array(ends), end=end, goal_world=goal.xyyaw_world, path_id=path_id)
    first, last = p.turn_length, arcs[-1] - (p.turn_length if turns_at_goal else 0.0)
    between = (arcs > first + 1e-9) & (arcs < last - 1e-9)
    stations = np.concatenate(([first], arcs[between], [last]))
    way = _needed(np.column_stack([np.interp(stations, arcs, points[:, axis]) for axis in range(2)]), p.straightness)
    waypoints = [(*points[0], start_yaw), *np.column_stack((way, _headings(way)))]
    if turns_at_goal:
        waypoints.append((*points[-1], goal.yaw))
    return BodyPath(np.array(waypoints), end=end, goal_world=goal.xyyaw_world, path_id=path_id)


def _headings(way: Array) -> Array:
    """Direction of the way at each of its points (N,): the middle between those before and after."""
    steps = np.diff(way, axis=0)
    units = steps / np.maximum(np.hypot(*steps.T), 1e-12)[:, None]
    sums = np.vstack((units[:1], units[:-1] + units[1:], units[-1:]))
    return np.arctan2(sums[:, 1], sums[:, 0])


def _needed(way: Array, tolerance: float) -> Array:
    """The points without which a way would move by more than a tolerance (Douglas and Peucker, 1973)."""
    kept = {0, len(way) - 1}
    pieces = [(0, len(way) - 1)]
    while pieces:
        first, last = pieces.pop()
        if last - first < 2:
            continue
        chord, between = way[last] - way[first], way[first + 1 : last] - way[first]
        length = float(np.hypot(*chord))
        off = np.abs(chord[0] * between[:, 1] - chord[1] * between[:, 0]) / max(length, 1e-12)
        if off.max() > tolerance:
            middle = first + 1 + int(np.argmax(off))
            kept.add(middle)
            pieces += [(first, middle), (middle, last)]
    return way[sorted(kept)]
