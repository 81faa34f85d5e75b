"""Weighted A* over a lattice of footholds (x, y, heading, side), on the ground of a raster of planes.

The lattice is anchored at the stance foot, so a node's pose is exact and every limit is checked on the pose that is
returned. Limits and costs follow Griffin et al., "Footstep planning for autonomous walking over rough terrain" (2019).
Snapping a sole is what costs time, so an edge whose foothold is not known yet enters the open list with the cost it
would have on level ground and is snapped only when it comes first (Cohen et al., "Lazy weighted A*", 2014). A node is
closed once; on a straight path the cost is at most `heuristic_weight` times the best on the lattice. The estimate
counts the fewest steps at the least cost of a step, about half of what steps on rough ground cost.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.plane_raster import FOOTHOLD, SNAP_REASONS, UNSEEN, snap_sole
from skills.geometry.pose import Array
from skills.kernels import kernel

Records: TypeAlias = Any  # structured arrays, or one element of them

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
REACHED, EXHAUSTED, OUT_OF_BUDGET = range(3)

# Fields are named after the parameters; the half sizes, uphill_tangent, heading (angle
# between two), stride and turn (the most of a step) come from them.
STEP_LIMITS = np.dtype(
    [
        (name, np.float64)
        for name in (
            *("half_length", "half_width", "reach", "reach_up", "reach_up_height", "reach_down", "reach_down_height"),
            *("back_reach", "minimum_width", "ideal_width", "maximum_width", "sole_gap", "height_change"),
            *("inward_yaw", "outward_yaw", "uphill_drop", "uphill_tangent", "swing_reach", "swing_height_change"),
            *("step_cost", "height_cost", "tilt_cost", "yaw_cost", "width_cost", "path_cost", "share_cost"),
            *("reference_cost", "lattice", "heading", "stride", "turn", "heuristic_weight", "minimum_steps"),
            *("along_tolerance", "across_tolerance", "heading_tolerance", "goal_tolerance", "goal_yaw_tolerance"),
        )
    ]
)
SEARCH_GOAL = np.dtype([("arc_length", np.float64), ("final", np.bool_)])
# A foot on the lattice: cost of the way there, estimated cost to go, what being off the path costs, and the way back.
NODE = np.dtype(
    [
        *((name, np.float64) for name in ("cost", "to_go", "off_path_cost")),
        *((name, np.int64) for name in ("parent", "depth")),
        *((name, np.uint8) for name in ("status", "arrived")),
    ]
)
_JUDGED, _OPEN, _CLOSED = 1, 2, 3
# What the ground is under a foot of either side: outcome of the snap, height, slopes, supported share.
GROUND = np.dtype([*((name, np.float64) for name in ("z", "a", "b", "share")), ("outcome", np.uint8)])
# What a step from a stance foot depends on.
STAND = np.dtype(
    [
        *((name, np.float64) for name in ("x", "y", "z", "cos", "sin", "uphill", "cost")),
        *((name, np.float64) for name in ("swing_x", "swing_y", "swing_z")),
        ("depth", np.int64),
    ]
)
# An edge in the open list; its cost is negative as long as it is only estimated.
EDGE = np.dtype([("estimate", np.float64), ("cost", np.float64), ("node", np.int64), ("parent", np.int64)])


@kernel
def search_footsteps(
    cells: NDArray[np.int32],
    planes: Array,
    resolution: float,
    snap_limits: Records,
    samples: Array,
    step_limits: Records,
    search_goal: Records,
    path: Array,
    reference: Array,
    feet: Array,
    lattice: NDArray[np.int64],
    max_expansions: int,
    nodes: Records,
    grounds: Records,
    open_list: Records,
    rejections: NDArray[np.int64],
) -> tuple[int, int, int, float, int, float]:
    """Search from a stance.

    A node is ((side * headings + heading) * ny + iy) * nx + ix; side 0 is left.
    In this order a search, which uses few headings, touches little memory.

    Args:
        cells: raster of plane indices.
        planes: its planes.
        resolution: its cell size [m].
        snap_limits: one `SNAP_LIMITS`.
        samples: where a sole feels the ground.
        step_limits: one `STEP_LIMITS`.
        search_goal: one `SEARCH_GOAL`.
        path: (N, 4) rows of x, y from the corner, heading, arc length.
        reference: (K, 2) places of the first steps in the plan before, NaN where there is none.
        feet: (2, 7) stance foot, then swing foot: x, y from the corner, z, heading, slopes a and b, side (+1 left).
        lattice: headings, ny, nx, then heading, iy and ix of the stance foot.
        max_expansions: nodes that may be expanded.
        nodes: one `NODE` a node, zero.
        grounds: one `GROUND` a node of one side, zero.
        open_list: some `EDGE`s as first memory of the open list.
        rejections: counts by reason, added to.

    Returns:
        Outcome, last node, node before it, cost, expansions, progress by the estimated cost to go.
    """
    limits, goal = step_limits[0], search_goal[0]
    headings, ny, nx = lattice[0], lattice[1], lattice[2]
    stances = ny * nx * headings
    root = (lattice[3] * ny + lattice[4]) * nx + lattice[5] + (0 if feet[0, 6] > 0 else stances)
    ground = grounds[root % stances]
    ground.outcome, ground.z, ground.a, ground.b, ground.share = FOOTHOLD, feet[0, 2], feet[0, 4], feet[0, 5], 1.0
    trigonometry = np.empty((headings + 1, 3))
    for k in range(headings + 1):
        yaw = feet[0, 3] + (k - lattice[3]) * limits.heading if k < headings else feet[1, 3]
        trigonometry[k, 0], trigonometry[k, 1], trigonometry[k, 2] = yaw, np.cos(yaw), np.sin(yaw)
    # The node past the last stands for the swing foot, where it is now.
    nodes[root].parent = 2 * stances
    _judge(limits, goal, path, feet[0, 0], feet[0, 1], trigonometry[lattice[3]], feet[0, 6], nodes[root])
    _judge(limits, goal, path, feet[1, 0], feet[1, 1], trigonometry[headings], feet[1, 6], nodes[2 * stances])
    start_to_go, best = nodes[root].to_go, root
    if goal.final and nodes[root].arrived and nodes[2 * stances].arrived:
        return REACHED, root, 2 * stances, 0.0, 0, 0.0
    nodes[root].status = _OPEN
    children = np.empty((2 * headings, _most_children(limits), 3), np.int64)
    counts = np.zeros(2 * headings, np.int64)
    stand = np.empty(1, STAND)[0]
    size = _push(open_list, 0, 0.0, 0.0, root, 2 * stances)
    outcome, expansions = EXHAUSTED, 0
    while size > 0:
        node, stance, cost = open_list[0].node, open_list[0].parent, open_list[0].cost
        size = _pop(open_list, size)
        square = goal.final and nodes[node].arrived and nodes[stance].arrived
        if nodes[node].status == _CLOSED and not square:
            continue
        if cost < 0.0:
            snap = node % stances
            x, y = _place(feet, lattice, limits, node)
            if grounds[snap].outcome == UNSEEN:
                yaw = trigonometry[snap // (ny * nx), 0]
                _snap(cells, planes, resolution, snap_limits, samples, x, y, yaw, grounds[snap])
            _stand_on(limits, feet, lattice, trigonometry, nodes, grounds, stance, stand)
            cost = _step_cost(limits, reference, stand, x, y, grounds[snap])
            if cost < 0.0:
                rejections[int(-cost)] += 1
                continue
            cost += stand.cost + nodes[node].off_path_cost
            if _improve(nodes, node, stance, cost) or square:
                size = _push(open_list, size, cost + limits.heuristic_weight * nodes[node].to_go, cost, node, stance)
                if nodes[node].to_go < nodes[best].to_go:
                    best = node
            continue
        if square:
            return REACHED, node, stance, cost, expansions, start_to_go - nodes[node].to_go
        nodes[node].status = _CLOSED
        if nodes[node].arrived and not goal.final and nodes[node].depth >= limits.minimum_steps:
            return REACHED, node, stance, cost, expansions, start_to_go - nodes[node].to_go
        if expansions >= max_expansions:
            outcome = OUT_OF_BUDGET
            break
        expansions += 1
        side, heading = node // stances, node % stances // (ny * nx)
        iy, ix = node // nx % ny, node % nx
        table = side * headings + heading
        if counts[table] == 0:
            counts[table] = _fill_children(limits, trigonometry, heading, 2.0 * side - 1.0, children[table])
        if size + counts[table] > open_list.shape[0]:
            open_list = _longer(open_list, size)
        _stand_on(limits, feet, lattice, trigonometry, nodes, grounds, node, stand)
        for k in range(counts[table]):
            dx, dy, turned = children[table, k, 0], children[table, k, 1], children[table, k, 2]
            jx, jy = ix + dx, iy + dy
            if jx < 0 or jy < 0 or jx >= nx or jy >= ny:
                rejections[_OUTSIDE] += 1
                continue
            snap = (turned * ny + jy) * nx + jx
            ground = grounds[snap]
            if ground.outcome > FOOTHOLD:
                rejections[ground.outcome] += 1
                continue
            index = (1 - side) * stances + snap
            child = nodes[index]
            square = goal.final and child.arrived and nodes[node].arrived
            if child.status == _CLOSED and not square:
                continue
            x, y = feet[0, 0] + (jx - lattice[5]) * limits.lattice, feet[0, 1] + (jy - lattice[4]) * limits.lattice
            if child.status == 0:
                child.status = _JUDGED
                _judge(limits, goal, path, x, y, trigonometry[turned], 2.0 * side - 1.0, child)
                square = goal.final and child.arrived and nodes[node].arrived
            least = cost + limits.step_cost + child.off_path_cost
            if child.status == _OPEN and least >= child.cost and not square:
                continue
            to_go = limits.heuristic_weight * child.to_go
            if ground.outcome == UNSEEN:
                size = _push(open_list, size, least + to_go, -1.0, index, node)
                continue
            child_cost = _step_cost(limits, reference, stand, x, y, ground)
            if child_cost < 0.0:
                rejections[int(-child_cost)] += 1
                continue
            child_cost += stand.cost + child.off_path_cost
            if _improve(nodes, index, node, child_cost) or square:
                size = _push(open_list, size, child_cost + to_go, child_cost, index, node)
                if child.to_go < nodes[best].to_go:
                    best = index
    return outcome, best, nodes[best].parent, nodes[best].cost, expansions, start_to_go - nodes[best].to_go


@kernel
def _improve(nodes: Records, node: int, parent: int, cost: float) -> bool:
    """Open a node by a way that is cheaper than the ways known so far; whether it was."""
    there = nodes[node]
    if there.status == _CLOSED or (there.status == _OPEN and cost >= there.cost):
        return False
    there.status, there.cost, there.parent, there.depth = _OPEN, cost, parent, nodes[parent].depth + 1
    return True


@kernel
def _snap(
    cells: NDArray[np.int32],
    planes: Array,
    resolution: float,
    snap_limits: Records,
    samples: Array,
    x: float,
    y: float,
    yaw: float,
    ground: Records,
) -> None:
    """Snap a sole to the ground and remember what it found."""
    found = np.zeros(4)
    ground.outcome = snap_sole(cells, planes, resolution, snap_limits, samples, x, y, yaw, found)
    ground.z, ground.a, ground.b, ground.share = found[0], found[1], found[2], found[3]


@kernel
def _stand_on(
    limits: Records,
    feet: Array,
    lattice: NDArray[np.int64],
    trigonometry: Array,
    nodes: Records,
    grounds: Records,
    stance: int,
    stand: Records,
) -> None:
    """Fill in what a step from a stance foot depends on."""
    layer = lattice[1] * lattice[2]
    stances = lattice[0] * layer
    ground = grounds[stance % stances]
    heading = stance % stances // layer
    stand.x, stand.y = _place(feet, lattice, limits, stance)
    stand.z, stand.cos, stand.sin = ground.z, trigonometry[heading, 1], trigonometry[heading, 2]
    stand.uphill = ground.a * stand.cos + ground.b * stand.sin
    stand.cost, stand.depth = nodes[stance].cost, nodes[stance].depth
    before = nodes[stance].parent
    if before == 2 * stances:
        stand.swing_x, stand.swing_y, stand.swing_z = feet[1, 0], feet[1, 1], feet[1, 2]
    else:
        stand.swing_x, stand.swing_y = _place(feet, lattice, limits, before)
        stand.swing_z = grounds[before % stances].z


@kernel
def _step_cost(limits: Records, reference: Array, stand: Records, x: float, y: float, ground: Records) -> float:
    """Cost of a step but for being off the path; where it is not allowed, the reason as a negative number."""
    if ground.outcome != FOOTHOLD:
        return -float(ground.outcome)
    length = stand.cos * (x - stand.x) + stand.sin * (y - stand.y)
    width = abs(stand.cos * (y - stand.y) - stand.sin * (x - stand.x))
    rise = ground.z - stand.z
    reach = np.hypot(length, width - limits.ideal_width)
    if rise > limits.height_change:
        return -float(_TOO_HIGH)
    if rise < -limits.height_change:
        return -float(_TOO_LOW)
    if rise > limits.reach_up_height and reach > limits.reach_up:
        return -float(_FAR_UP)
    if rise < -limits.reach_down_height and reach > limits.reach_down:
        return -float(_FAR_DOWN)
    if rise < -limits.uphill_drop and stand.uphill > limits.uphill_tangent:
        return -float(_UPHILL)
    if np.hypot(x - stand.swing_x, y - stand.swing_y) > limits.swing_reach:
        return -float(_SWING_LONG)
    if abs(ground.z - stand.swing_z) > limits.swing_height_change:
        return -float(_SWING_HIGH)
    cost = (
        limits.step_cost
        + limits.height_cost * abs(rise)
        + limits.tilt_cost * np.hypot(ground.a, ground.b)
        + limits.width_cost * abs(width - limits.ideal_width)
        + limits.share_cost * (1.0 - ground.share)
    )
    if stand.depth < reference.shape[0] and np.isfinite(reference[stand.depth, 0]):
        off_x, off_y = x - reference[stand.depth, 0], y - reference[stand.depth, 1]
        cost += limits.reference_cost * np.hypot(off_x, off_y)
    return cost


@kernel
def _place(feet: Array, lattice: NDArray[np.int64], limits: Records, node: int) -> tuple[float, float]:
    """Where a node is: x, y from the corner."""
    ix, iy = node % lattice[2] - lattice[5], node // lattice[2] % lattice[1] - lattice[4]
    return feet[0, 0] + ix * limits.lattice, feet[0, 1] + iy * limits.lattice


@kernel
def _longer(open_list: Records, size: int) -> Records:
    """The same open list with twice the room."""
    longer = np.empty(2 * open_list.shape[0], EDGE)
    for k in range(size):
        longer[k] = open_list[k]
    return longer


@kernel
def _judge(
    limits: Records, goal: Records, path: Array, x: float, y: float, heading: Array, sign: float, node: Records
) -> None:
    """Judge a foot by the body beside it: the cost of being off the path, the estimated cost to go, whether it arrived.

    The estimate counts the steps that are needed at least, by the way left along the path and by the heading.
    """
    yaw = heading[0]
    body_x = x + 0.5 * sign * limits.ideal_width * heading[2]
    body_y = y - 0.5 * sign * limits.ideal_width * heading[1]
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
def _most_children(limits: Records) -> int:
    """Upper bound of the number of steps from one stance."""
    side = 2 * int(np.ceil((limits.reach + limits.maximum_width) / limits.lattice)) + 1
    turns = int((limits.inward_yaw + limits.outward_yaw + 2e-9) / limits.heading) + 1
    return side * side * turns


@kernel
def _fill_children(limits: Records, trigonometry: Array, heading: int, sign: float, children: NDArray[np.int64]) -> int:
    """List the steps that a foot on the side `sign` may make on level ground from a stance foot of a heading.

    Rows of lattice offsets in x and y and heading; returns how many.
    """
    headings = trigonometry.shape[0] - 1
    cos, sin = trigonometry[heading, 1], trigonometry[heading, 2]
    most = int(np.ceil((limits.reach + limits.maximum_width) / limits.lattice))
    turns = int(max(limits.inward_yaw, limits.outward_yaw) / limits.heading + 1e-9)
    whole = headings * limits.heading > 2 * np.pi - 1e-9
    count = 0
    for j in range(-most, most + 1):
        for i in range(-most, most + 1):
            dx, dy = i * limits.lattice, j * limits.lattice
            length, width = cos * dx + sin * dy, sign * (cos * dy - sin * dx)
            if length < -limits.back_reach or np.hypot(length, width - limits.ideal_width) > limits.reach:
                continue
            if width < limits.minimum_width or width > limits.maximum_width:
                continue
            for k in range(-turns, turns + 1):
                if not whole and (heading + k < 0 or heading + k >= headings):
                    continue
                outward = sign * k * limits.heading
                if outward < -limits.inward_yaw - 1e-9 or outward > limits.outward_yaw + 1e-9:
                    continue
                if _soles_clear(limits, length, width, outward):
                    children[count, 0], children[count, 1], children[count, 2] = i, j, (heading + k) % headings
                    count += 1
    return count


@kernel
def _soles_clear(limits: Records, length: float, width: float, outward: float) -> bool:
    """Whether two soles, the second at length, width, outward from the first, keep their gap (separating axes)."""
    cos, sin = np.cos(outward), np.sin(outward)
    along = limits.half_length * (1 + abs(cos)) + limits.half_width * abs(sin) + limits.sole_gap
    across = limits.half_width * (1 + abs(cos)) + limits.half_length * abs(sin) + limits.sole_gap
    turned_length, turned_width = cos * length + sin * width, cos * width - sin * length
    return max(abs(length), abs(turned_length)) >= along or max(abs(width), abs(turned_width)) >= across


@kernel
def _wrap(angle: float) -> float:
    return angle - 2 * np.pi * np.floor((angle + np.pi) / (2 * np.pi))


@kernel
def _push(edges: Records, size: int, estimate: float, cost: float, node: int, parent: int) -> int:
    """Add an edge to a binary heap; its new size."""
    i = size
    while i > 0 and edges[(i - 1) // 2].estimate > estimate:
        edges[i] = edges[(i - 1) // 2]
        i = (i - 1) // 2
    edge = edges[i]
    edge.estimate, edge.cost, edge.node, edge.parent = estimate, cost, node, parent
    return size + 1


@kernel
def _pop(edges: Records, size: int) -> int:
    """Remove the first edge of a binary heap; its new size."""
    size -= 1
    estimate = edges[size].estimate
    i = 0
    while 2 * i + 1 < size:
        below = 2 * i + 1
        if below + 1 < size and edges[below + 1].estimate < edges[below].estimate:
            below += 1
        if edges[below].estimate >= estimate:
            break
        edges[i] = edges[below]
        i = below
    edges[i] = edges[size]
    return size
