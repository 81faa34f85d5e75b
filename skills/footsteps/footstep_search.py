"""Weighted A* over a lattice of footholds (x, y, heading, side), on the ground of a raster of planes.

The lattice is anchored at the stance foot, so a node's pose is exact and every limit is checked on the pose that is
returned. Edges, limits and costs follow Griffin et al., "Footstep planning for autonomous walking over rough terrain"
(2019); the search closes a node once, so with a consistent estimate of the cost to go its cost is at most
`heuristic_weight` times the best on the lattice.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.plane_raster import FOOTHOLD, SNAP_REASONS, UNSEEN, SnapLimits, snap_sole
from skills.geometry.pose import Array
from skills.kernels import kernel

REASONS = (
    *SNAP_REASONS,
    "step too high",
    "step too low",
    "too far for a step up",
    "too far for a step down",
    "step down off a foot that stands uphill",
    "swing too long",
    "swing too high",
    "outside the searched ground",
)
_TOO_HIGH, _TOO_LOW, _FAR_UP, _FAR_DOWN, _UPHILL, _SWING_LONG, _SWING_HIGH, _OUTSIDE = range(
    len(SNAP_REASONS), len(REASONS)
)
_OPEN_LIST = 8192
REACHED, EXHAUSTED, OUT_OF_BUDGET = range(3)


class StepLimits(NamedTuple):
    """Limits, costs and search settings, as floats for the kernels; see `FootstepParameters`."""

    half_length: float
    half_width: float
    reach: float
    reach_up: float
    reach_up_height: float
    reach_down: float
    reach_down_height: float
    back_reach: float
    minimum_width: float
    ideal_width: float
    maximum_width: float
    sole_gap: float
    height_change: float
    inward_yaw: float
    outward_yaw: float
    uphill_drop: float
    uphill_slope: float  # tangent
    swing_reach: float
    swing_height_change: float
    step_cost: float
    height_cost: float
    tilt_cost: float
    yaw_cost: float
    width_cost: float
    path_cost: float
    share_cost: float
    reference_cost: float
    lattice: float
    turn_per_step: float
    heuristic_weight: float
    minimum_steps: float
    along_tolerance: float
    across_tolerance: float
    heading_tolerance: float
    goal_tolerance: float
    goal_yaw_tolerance: float


class SearchGoal(NamedTuple):
    """Where to: progress along the path, or both feet at its end.

    Attributes:
        path: (N, 4) rows of x, y from the corner, heading, arc length.
        arc_length: progress to reach.
        final: 1 where the goal is the end of the path, 0 where progress along it is enough.
        reference: (K, 2) places of the first steps in the plan before, NaN where there is none.
    """

    path: Array
    arc_length: float
    final: float
    reference: Array


class SearchSpace(NamedTuple):
    """Nodes of the search, dense and filled lazily; a node is ((side * ny + iy) * nx + ix) * headings + heading.

    Attributes:
        shape: ny, nx, headings.
        start: iy and ix of the stance foot.
        status: 0 unseen, 1 open, 2 closed.
        cost, parent, depth: best known way to a node.
        snap, ground: outcome of the snap, and height, slopes, share (4,) by node without its side.
    """

    shape: NDArray[np.int64]
    start: NDArray[np.int64]
    status: NDArray[np.uint8]
    cost: Array
    parent: NDArray[np.int32]
    depth: NDArray[np.int32]
    snap: NDArray[np.uint8]
    ground: Array


@kernel
def search_footsteps(
    cells: NDArray[np.int32],
    planes: Array,
    resolution: float,
    snap_limits: SnapLimits,
    limits: StepLimits,
    goal: SearchGoal,
    feet: Array,
    max_expansions: int,
    space: SearchSpace,
    rejections: NDArray[np.int64],
) -> tuple[int, int, int, float, float]:
    """Search from a stance.

    Args:
        cells: raster of plane indices.
        planes: its planes.
        resolution: its cell size [m].
        snap_limits: what a sole may stand on.
        limits: limits, costs and settings of the search.
        goal: where to.
        feet: (2, 7) stance foot, then swing foot: x, y from the corner, z, heading, slopes a and b, side (+1 left).
        max_expansions: nodes that may be expanded.
        space: memory of the search.
        rejections: counts by reason, added to.

    Returns:
        Outcome, best node, expansions, estimated cost to go at the start and at the best node.
    """
    ny, nx, headings = space.shape
    root_side = 0 if feet[0, 6] > 0 else 1
    root = ((root_side * ny + space.start[0]) * nx + space.start[1]) * headings
    stances = ny * nx * headings
    root_snap = root % stances
    space.snap[root_snap] = FOOTHOLD
    space.ground[root_snap, 0] = feet[0, 2]
    space.ground[root_snap, 1] = feet[0, 4]
    space.ground[root_snap, 2] = feet[0, 5]
    space.ground[root_snap, 3] = 1.0
    space.cost[root], space.parent[root], space.depth[root], space.status[root] = 0.0, -1, 0, 1
    children = np.empty((2 * headings, _most_children(limits, headings), 4))
    child_counts = np.full(2 * headings, -1)
    found = np.zeros(5)
    _progress(goal, limits, feet[0, 0], feet[0, 1], feet[0, 3], feet[0, 6], found)
    start_to_go = found[3]
    best, best_to_go = root, start_to_go
    heap_cost, heap_node = np.empty(_OPEN_LIST), np.empty(_OPEN_LIST, np.int32)
    heap_size = _push(heap_cost, heap_node, 0, limits.heuristic_weight * start_to_go, root)
    expansions = 0
    while heap_size > 0:
        node = heap_node[0]
        heap_size = _pop(heap_cost, heap_node, heap_size)
        if space.status[node] == 2:
            continue
        space.status[node] = 2
        side, rest = node // stances, node % stances
        heading = rest % headings
        ix, iy = (rest // headings) % nx, rest // headings // nx
        sign = 1.0 if side == 0 else -1.0
        x = feet[0, 0] + (ix - space.start[1]) * limits.lattice
        y = feet[0, 1] + (iy - space.start[0]) * limits.lattice
        yaw = _heading(feet[0, 3], heading, headings)
        parent = space.parent[node]
        if parent < 0:
            px, py, pz, pyaw = feet[1, 0], feet[1, 1], feet[1, 2], feet[1, 3]
        else:
            prest = parent % stances
            px = feet[0, 0] + ((prest // headings) % nx - space.start[1]) * limits.lattice
            py = feet[0, 1] + (prest // headings // nx - space.start[0]) * limits.lattice
            pz, pyaw = space.ground[prest, 0], _heading(feet[0, 3], prest % headings, headings)
        _progress(goal, limits, x, y, yaw, sign, found)
        reached = found[4] > 0.0
        if goal.final > 0.0:
            _progress(goal, limits, px, py, pyaw, -sign, found)
            reached = reached and found[4] > 0.0
        elif space.depth[node] < limits.minimum_steps:
            reached = False
        if reached:
            return REACHED, node, expansions, start_to_go, best_to_go
        if expansions >= max_expansions:
            return OUT_OF_BUDGET, best, expansions, start_to_go, best_to_go
        expansions += 1
        z, slope_a, slope_b = space.ground[rest, 0], space.ground[rest, 1], space.ground[rest, 2]
        uphill = slope_a * np.cos(yaw) + slope_b * np.sin(yaw) > limits.uphill_slope
        table = side * headings + heading
        if child_counts[table] < 0:
            child_counts[table] = _fill_children(limits, yaw, heading, headings, -sign, children[table])
        for k in range(child_counts[table]):
            jx, jy = ix + int(children[table, k, 0]), iy + int(children[table, k, 1])
            if jx < 0 or jy < 0 or jx >= nx or jy >= ny:
                rejections[_OUTSIDE] += 1
                continue
            turned = int(children[table, k, 2])
            snap = (jy * nx + jx) * headings + turned
            child = (1 - side) * stances + snap
            if space.status[child] == 2:
                continue
            cx = feet[0, 0] + (jx - space.start[1]) * limits.lattice
            cy = feet[0, 1] + (jy - space.start[0]) * limits.lattice
            cyaw = _heading(feet[0, 3], turned, headings)
            if space.snap[snap] == UNSEEN:
                space.snap[snap] = snap_sole(cells, planes, resolution, snap_limits, cx, cy, cyaw, space.ground[snap])
            if space.snap[snap] != FOOTHOLD:
                rejections[space.snap[snap]] += 1
                continue
            rise = space.ground[snap, 0] - z
            reach = children[table, k, 3]
            reason = _forbidden(limits, rise, reach, uphill)
            if reason == 0:
                if (cx - px) ** 2 + (cy - py) ** 2 > limits.swing_reach**2:
                    reason = _SWING_LONG
                elif abs(space.ground[snap, 0] - pz) > limits.swing_height_change:
                    reason = _SWING_HIGH
            if reason > 0:
                rejections[reason] += 1
                continue
            _progress(goal, limits, cx, cy, cyaw, -sign, found)
            to_go = found[3]
            a, b = space.ground[snap, 1], space.ground[snap, 2]
            width = -sign * (np.cos(yaw) * (cy - y) - np.sin(yaw) * (cx - x))
            cost = (
                space.cost[node]
                + limits.step_cost
                + limits.height_cost * abs(rise)
                + limits.tilt_cost * np.sqrt(a * a + b * b)
                + limits.yaw_cost * abs(found[2])
                + limits.width_cost * abs(width - limits.ideal_width)
                + limits.path_cost * found[1]
                + limits.share_cost * (1.0 - space.ground[snap, 3])
            )
            depth = space.depth[node]
            if depth < goal.reference.shape[0] and np.isfinite(goal.reference[depth, 0]):
                cost += limits.reference_cost * np.hypot(cx - goal.reference[depth, 0], cy - goal.reference[depth, 1])
            if space.status[child] == 0 or cost < space.cost[child]:
                space.status[child] = 1
                space.cost[child], space.parent[child], space.depth[child] = cost, node, depth + 1
                if heap_size == heap_node.shape[0]:
                    heap_cost = np.concatenate((heap_cost, np.empty(heap_size)))
                    heap_node = np.concatenate((heap_node, np.empty(heap_size, np.int32)))
                estimate = cost + limits.heuristic_weight * to_go
                heap_size = _push(heap_cost, heap_node, heap_size, estimate, child)
                if to_go < best_to_go:
                    best, best_to_go = child, to_go
    return EXHAUSTED, best, expansions, start_to_go, best_to_go


@kernel
def _forbidden(limits: StepLimits, rise: float, reach: float, uphill: bool) -> int:
    """The reason why a step of this rise and reach is not allowed; 0 where it is."""
    if rise > limits.height_change:
        return _TOO_HIGH
    if rise < -limits.height_change:
        return _TOO_LOW
    if rise > limits.reach_up_height and reach > limits.reach_up:
        return _FAR_UP
    if rise < -limits.reach_down_height and reach > limits.reach_down:
        return _FAR_DOWN
    if uphill and rise < -limits.uphill_drop:
        return _UPHILL
    return 0


@kernel
def _progress(goal: SearchGoal, limits: StepLimits, x: float, y: float, yaw: float, sign: float, found: Array) -> None:
    """Judge a foot by the body beside it.

    Writes arc length, distance off the path, heading off the path's, estimated cost to go, and 1 where at the goal.
    """
    body_x = x + 0.5 * sign * limits.ideal_width * np.sin(yaw)
    body_y = y - 0.5 * sign * limits.ideal_width * np.cos(yaw)
    path = goal.path
    nearest = np.inf
    for i in range(path.shape[0] - 1):
        span_x, span_y = path[i + 1, 0] - path[i, 0], path[i + 1, 1] - path[i, 1]
        squared = max(span_x * span_x + span_y * span_y, 1e-12)
        t = ((body_x - path[i, 0]) * span_x + (body_y - path[i, 1]) * span_y) / squared
        t = min(max(t, 0.0), 1.0)
        off_x, off_y = body_x - path[i, 0] - t * span_x, body_y - path[i, 1] - t * span_y
        off = off_x * off_x + off_y * off_y
        if off < nearest:
            nearest = off
            found[0] = path[i, 3] + t * (path[i + 1, 3] - path[i, 3])
            found[2] = _wrap(yaw - path[i, 2] - t * _wrap(path[i + 1, 2] - path[i, 2]))
    found[1] = np.sqrt(nearest)
    last = path.shape[0] - 1
    remaining = max(goal.arc_length - found[0], 0.0)
    turn = abs(_wrap(yaw - path[last, 2]))
    if goal.final > 0.0:
        off_goal = np.hypot(body_x - path[last, 0], body_y - path[last, 1])
        remaining = max(remaining, off_goal)
        found[4] = 1.0 if off_goal <= limits.goal_tolerance and turn <= limits.goal_yaw_tolerance else 0.0
    else:
        along, across = remaining / limits.along_tolerance, found[1] / limits.across_tolerance
        found[4] = 1.0 if along * along + across * across <= 1.0 and turn <= limits.heading_tolerance else 0.0
    found[3] = limits.step_cost * max(remaining / limits.reach, turn / limits.turn_per_step)


@kernel
def _most_children(limits: StepLimits, headings: int) -> int:
    """Upper bound of the number of steps from one stance."""
    side = 2 * int(np.ceil((limits.reach + limits.maximum_width) / limits.lattice)) + 1
    turns = int((limits.inward_yaw + limits.outward_yaw + 2e-9) / (2 * np.pi / headings)) + 1
    return side * side * turns


@kernel
def _fill_children(limits: StepLimits, yaw: float, heading: int, headings: int, sign: float, children: Array) -> int:
    """List the steps that a foot on the side `sign` may make from a stance foot of heading `yaw`, on level ground.

    Rows of lattice offsets in x and y, heading index, reach; returns how many.
    """
    cos, sin = np.cos(yaw), np.sin(yaw)
    most = int(np.ceil((limits.reach + limits.maximum_width) / limits.lattice))
    turn = 2 * np.pi / headings
    count = 0
    for j in range(-most, most + 1):
        for i in range(-most, most + 1):
            dx, dy = i * limits.lattice, j * limits.lattice
            length, width = cos * dx + sin * dy, sign * (cos * dy - sin * dx)
            reach = np.hypot(length, width - limits.ideal_width)
            if length < -limits.back_reach or reach > limits.reach:
                continue
            if width < limits.minimum_width or width > limits.maximum_width:
                continue
            for k in range(-headings // 2, headings // 2 + 1):
                outward = sign * k * turn
                if outward < -limits.inward_yaw - 1e-9 or outward > limits.outward_yaw + 1e-9:
                    continue
                if _soles_clear(limits, length, width, outward):
                    children[count, 0], children[count, 1] = i, j
                    children[count, 2], children[count, 3] = (heading + k) % headings, reach
                    count += 1
    return count


@kernel
def _soles_clear(limits: StepLimits, length: float, width: float, outward: float) -> bool:
    """Whether two soles, the second at length, width, outward from the first, keep their gap (separating axes)."""
    c, s = abs(np.cos(outward)), abs(np.sin(outward))
    along, across = limits.half_length * (1 + c) + limits.half_width * s, limits.half_width * (1 + c)
    across += limits.half_length * s
    if abs(length) >= along + limits.sole_gap or abs(width) >= across + limits.sole_gap:
        return True
    cos, sin = np.cos(outward), np.sin(outward)
    turned_length, turned_width = cos * length + sin * width, cos * width - sin * length
    return abs(turned_length) >= along + limits.sole_gap or abs(turned_width) >= across + limits.sole_gap


@kernel
def _heading(first: float, index: int, headings: int) -> float:
    turn = index if 2 * index < headings else index - headings
    return first + turn * 2 * np.pi / headings


@kernel
def _wrap(angle: float) -> float:
    return angle - 2 * np.pi * np.floor((angle + np.pi) / (2 * np.pi))


@kernel
def _push(costs: Array, nodes: NDArray[np.int32], size: int, cost: float, node: int) -> int:
    """Add a node to a binary heap; its new size."""
    i = size
    while i > 0:
        above = (i - 1) // 2
        if costs[above] <= cost:
            break
        costs[i], nodes[i] = costs[above], nodes[above]
        i = above
    costs[i], nodes[i] = cost, node
    return size + 1


@kernel
def _pop(costs: Array, nodes: NDArray[np.int32], size: int) -> int:
    """Remove the first node of a binary heap; its new size."""
    size -= 1
    cost, node = costs[size], nodes[size]
    i = 0
    while 2 * i + 1 < size:
        below = 2 * i + 1
        if below + 1 < size and costs[below + 1] < costs[below]:
            below += 1
        if costs[below] >= cost:
            break
        costs[i], nodes[i] = costs[below], nodes[below]
        i = below
    costs[i], nodes[i] = cost, node
    return size
