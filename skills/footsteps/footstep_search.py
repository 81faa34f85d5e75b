"""Weighted A* over a lattice of footholds (x, y, heading, side), on the ground of a raster of planes.

The lattice begins at the stance foot, so a node's pose is exact and every limit is checked on the pose that is
returned. Snapping a sole is what costs time, so an edge whose foothold is not known yet enters the open list with the
cost it would have on level ground and is snapped only when it comes first (Cohen et al., "Lazy weighted A*", 2014). A
node is closed once; on a straight path the cost is at most `heuristic_weight` times the best on the lattice. The
estimate counts the fewest steps at the least cost of a step, about half of what steps on rough ground cost.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.level_steps import fill_level_steps
from skills.footsteps.open_list import pop, push, with_room
from skills.footsteps.path_progress import judge
from skills.footsteps.plane_raster import Raster
from skills.footsteps.records import Records
from skills.footsteps.rejections import FOOTHOLD, NO_GROUND, OUTSIDE, UNSEEN
from skills.footsteps.search_space import CLOSED, EXPANDED, JUDGED, OPEN, OPENED, UNKNOWN, SearchSpace
from skills.footsteps.sole_snap import snap_sole
from skills.footsteps.step_cost import step_cost
from skills.geometry.pose import Array
from skills.kernels import kernel

REACHED, EXHAUSTED, OUT_OF_BUDGET = range(3)


@kernel
def search_footsteps(
    space: SearchSpace, open_list: Records, max_expansions: int
) -> tuple[int, int, int, float, float, Records]:
    """Search from a stance, or go on with a search that has spent its budget.

    Args:
        space: what the search works on.
        open_list: some `EDGE`s as first memory of the open list, or the one that was returned before.
        max_expansions: nodes that may be expanded, those before included.

    Returns:
        Outcome, last node, node before it, cost, progress by the estimated cost to go, and the open list.
    """
    limits, goal, lattice, stand = space.limits[0], space.goal[0], space.lattice[0], space.stand[0]
    headings, feet, nodes, grounds = space.headings, space.feet, space.nodes, space.grounds
    rejections, state = space.rejections, space.state[0]
    if not state.begun:
        root, swing = _put_feet(limits, goal, lattice, space.path, space.field, headings, feet, nodes)
        state.begun, state.best, state.start_left = 1, root, nodes[root].left
        state.size = push(open_list, 0, 0.0, 0.0, root, swing)
    size, best = state.size, state.best
    outcome = EXHAUSTED
    while size > 0:
        node, stance, cost = open_list[0].node, open_list[0].parent, open_list[0].cost
        there = nodes[node]
        square = goal.final and there.arrived and nodes[stance].arrived
        if there.status == CLOSED and not square:
            size = pop(open_list, size)
            continue
        if cost < 0.0:
            size = pop(open_list, size)
            x, y = _place(limits, lattice, feet, node)
            yaw = headings[_heading(lattice, node), 0]
            ground = grounds[node % lattice.stances]
            if ground.outcome == UNSEEN:
                _snap(space, _floor(lattice, node), x, y, yaw, ground)
            _stand_on(limits, lattice, headings, feet, nodes, grounds, stance, stand)
            cost = _take(space.raster, limits, stand, stance, x, y, yaw, there, ground, square, rejections)
            _note(space, stance, node, cost, ground.z, there.to_go)
            if cost >= 0.0:
                estimate = cost + limits.heuristic_weight * there.to_go
                size = push(open_list, size, estimate, cost, node, stance)
                if there.left < nodes[best].left:
                    best = node
            continue
        if square or (there.arrived and not goal.final and there.depth >= limits.minimum_steps):
            return REACHED, node, stance, cost, state.start_left - there.left, open_list
        if state.expansions >= max_expansions:
            outcome = OUT_OF_BUDGET
            break
        size = pop(open_list, size)
        there.status = CLOSED
        state.expansions += 1
        _note(space, stance, node, cost, np.nan, there.to_go)
        if space.log.shape[0] > 0:
            space.log[space.logged[0] - 1].reason = EXPANDED
        open_list, size, best = _expand(space, open_list, size, best, node)
    state.size, state.best = size, best
    return outcome, best, nodes[best].parent, nodes[best].cost, state.start_left - nodes[best].left, open_list


@kernel
def _note(space: SearchSpace, stance: int, node: int, cost: float, z: float, to_go: float) -> None:
    """Write down what became of a step; its cost is the reason as a negative number where it was rejected."""
    if space.log.shape[0] == 0 or cost == -1.0:
        return
    edge = space.log[space.logged[0]]
    space.logged[0] += 1
    edge.expansion, edge.parent, edge.node = space.state[0].expansions, stance, node
    edge.z, edge.cost, edge.to_go = z, max(cost, 0.0), to_go
    edge.reason = OPENED if cost >= 0.0 else int(-cost)


@kernel
def _put_feet(
    limits: Records,
    goal: Records,
    lattice: Records,
    path: Array,
    field: Array,
    headings: Array,
    feet: Array,
    nodes: Records,
) -> tuple[int, int]:
    """Put the stance foot and the swing foot where they are; their nodes."""
    snap = ((lattice.floor * lattice.headings + lattice.heading) * lattice.ny + lattice.iy) * lattice.nx + lattice.ix
    root, swing = snap + (0 if feet[0, 6] > 0 else lattice.stances), 2 * lattice.stances
    for i in range(2):
        heading, node = (lattice.headings + 1, root) if i == 0 else (lattice.headings, swing)
        x, y, z = feet[i, 0], feet[i, 1], feet[i, 2]
        judge(limits, goal, path, field, x, y, z, headings[heading], feet[i, 6], nodes[node])
    nodes[root].parent, nodes[root].status = swing, OPEN
    return root, swing


@kernel
def _snap(space: SearchSpace, floor: int, x: float, y: float, yaw: float, ground: Records) -> None:
    """Snap a sole to a floor and remember what it found."""
    found = space.snapped
    ground.outcome = snap_sole(space.raster, floor, space.snap_limits, space.samples, x, y, yaw, found)
    ground.z, ground.a, ground.b, ground.share = found[0], found[1], found[2], found[3]


@kernel
def _expand(space: SearchSpace, open_list: Records, size: int, best: int, stance: int) -> tuple[Records, int, int]:
    """Open the steps from a stance foot; the open list, its size, and the best node."""
    limits, goal, lattice, headings = space.limits[0], space.goal[0], space.lattice[0], space.headings
    nodes, grounds, rejections, stand = space.nodes, space.grounds, space.rejections, space.stand[0]
    path, field, x0, y0 = space.path, space.field, space.feet[0, 0], space.feet[0, 1]
    side, heading = stance // lattice.stances, _heading(lattice, stance)
    root = nodes[stance].parent == 2 * lattice.stances
    iy, ix = stance // lattice.nx % lattice.ny, stance % lattice.nx
    # The foot that stands where the search begins is turned as it is, not as the lattice is.
    table, row = side * lattice.headings + heading, heading
    if root:
        table, row = 2 * lattice.headings, lattice.headings + 1
    sign = 2.0 * side - 1.0
    steps = space.steps[table]
    never = space.level_rejections[table]
    if space.step_counts[table] == 0:
        space.step_counts[table] = fill_level_steps(limits, headings, headings[row, 0], heading, sign, steps, never)
    count = int(space.step_counts[table])
    for k in range(never.shape[0]):
        rejections[k] += never[k]
    open_list = with_room(open_list, size, count * lattice.floors)
    _stand_on(limits, lattice, headings, space.feet, nodes, grounds, stance, stand)
    for k in range(count * lattice.floors):
        step, floor = k // lattice.floors, k % lattice.floors
        jx, jy, turned = ix + steps[step, 0], iy + steps[step, 1], steps[step, 2]
        if jx < 0 or jy < 0 or jx >= lattice.nx or jy >= lattice.ny:
            rejections[OUTSIDE] += 1  # It has no node, and so no place in the log.
            continue
        snap = ((floor * lattice.headings + turned) * lattice.ny + jy) * lattice.nx + jx
        ground, node = grounds[snap], (1 - side) * lattice.stances + snap
        there = nodes[node]
        if ground.outcome > FOOTHOLD:
            rejections[ground.outcome] += 1
            _note(space, stance, node, -float(ground.outcome), ground.z, there.to_go)
            continue
        x, y = x0 + (jx - lattice.ix) * limits.lattice, y0 + (jy - lattice.iy) * limits.lattice
        if there.status == UNKNOWN:
            z = _height(space.raster, floor, x, y)
            if np.isnan(z):
                ground.outcome, ground.z = NO_GROUND, np.nan
                rejections[NO_GROUND] += 1
                _note(space, stance, node, -float(NO_GROUND), z, 0.0)
                continue
            there.status = JUDGED
            judge(limits, goal, path, field, x, y, z, headings[turned], sign, there)
        if there.to_go == np.inf:
            rejections[OUTSIDE] += 1
            _note(space, stance, node, -float(OUTSIDE), stand.z, there.to_go)
            continue
        square = goal.final and there.arrived and nodes[stance].arrived
        least = stand.cost + limits.step_cost + there.off_path_cost
        if not square and (there.status == CLOSED or (there.status == OPEN and least >= there.cost)):
            continue
        cost = -1.0
        if ground.outcome == FOOTHOLD:
            yaw = headings[turned, 0]
            cost = _take(space.raster, limits, stand, stance, x, y, yaw, there, ground, square, rejections)
            _note(space, stance, node, cost, ground.z, there.to_go)
            if cost < 0.0:
                continue
            least = cost
            if there.left < nodes[best].left:
                best = node
        size = push(open_list, size, least + limits.heuristic_weight * there.to_go, cost, node, stance)
    return open_list, size, best


@kernel
def _take(
    raster: Raster,
    limits: Records,
    stand: Records,
    stance: int,
    x: float,
    y: float,
    yaw: float,
    there: Records,
    ground: Records,
    square: bool,
    rejections: NDArray[np.int64],
) -> float:
    """Cost of the way to a foot by a step onto known ground.

    Negative where the step is not worth opening: the reason against it, or -1 where a better way to the foot is known.
    Where none is, the foot takes this one.
    """
    cost = step_cost(raster, limits, stand, x, y, yaw, ground)
    if cost < 0.0:
        rejections[int(-cost)] += 1
        return cost
    cost += stand.cost + there.off_path_cost
    if there.status == JUDGED or (there.status == OPEN and cost < there.cost):
        there.status, there.cost, there.parent, there.depth = OPEN, cost, stance, stand.depth + 1
        return cost
    return cost if square else -1.0


@kernel
def _stand_on(
    limits: Records,
    lattice: Records,
    headings: Array,
    feet: Array,
    nodes: Records,
    grounds: Records,
    stance: int,
    stand: Records,
) -> None:
    """Fill in what a step from a stance foot depends on."""
    swing, now = nodes[stance].parent, 2 * lattice.stances
    row = lattice.headings + 1 if swing == now else _heading(lattice, stance)
    stand.x, stand.y = _place(limits, lattice, feet, stance)
    stand.cos, stand.sin = headings[row, 1], headings[row, 2]
    stand.cost, stand.depth = nodes[stance].cost, nodes[stance].depth
    # The first two feet stand where they do, on whatever ground.
    if swing == now:
        stand.z, stand.uphill = feet[0, 2], feet[0, 4] * stand.cos + feet[0, 5] * stand.sin
        stand.swing_x, stand.swing_y, stand.swing_z, stand.swing_yaw = feet[1, 0], feet[1, 1], feet[1, 2], feet[1, 3]
        return
    ground = grounds[stance % lattice.stances]
    stand.z, stand.uphill = ground.z, ground.a * stand.cos + ground.b * stand.sin
    stand.swing_x, stand.swing_y = _place(limits, lattice, feet, swing)
    if nodes[swing].parent == now:
        stand.swing_z, stand.swing_yaw = feet[0, 2], feet[0, 3]
    else:
        stand.swing_z, stand.swing_yaw = grounds[swing % lattice.stances].z, headings[_heading(lattice, swing), 0]


@kernel
def _place(limits: Records, lattice: Records, feet: Array, node: int) -> tuple[float, float]:
    """Where a node is: x, y from the corner."""
    ix, iy = node % lattice.nx - lattice.ix, node // lattice.nx % lattice.ny - lattice.iy
    return feet[0, 0] + ix * limits.lattice, feet[0, 1] + iy * limits.lattice


@kernel
def _heading(lattice: Records, node: int) -> int:
    return node // (lattice.ny * lattice.nx) % lattice.headings


@kernel
def _floor(lattice: Records, node: int) -> int:
    return node % lattice.stances // (lattice.headings * lattice.ny * lattice.nx)


@kernel
def _height(raster: Raster, floor: int, x: float, y: float) -> float:
    """Height of a floor at x, y from the corner; NaN where it has no ground."""
    scale = 1.0 / raster.resolution
    if x < 0.0 or y < 0.0 or x * scale >= raster.cells.shape[2] or y * scale >= raster.cells.shape[1]:
        return np.nan
    plane = raster.cells[floor, int(y * scale), int(x * scale)]
    if plane < 0:
        return np.nan
    return raster.planes[plane, 0] * x + raster.planes[plane, 1] * y + raster.planes[plane, 2]
