"""Weighted A* over a lattice of footholds (x, y, heading, side), on the ground of a raster of planes.

The lattice is anchored at the stance foot, so a node's pose is exact and every limit is checked on the pose that is
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
from skills.footsteps.search_space import CLOSED, JUDGED, OPEN, UNKNOWN, SearchSpace
from skills.footsteps.sole_snap import FOOTHOLD, NO_GROUND, UNSEEN, snap_sole
from skills.footsteps.step_cost import OUTSIDE, step_cost
from skills.geometry.pose import Array
from skills.kernels import kernel

REACHED, EXHAUSTED, OUT_OF_BUDGET = range(3)


@kernel
def search_footsteps(
    space: SearchSpace, open_list: Records, max_expansions: int
) -> tuple[int, int, int, float, int, float]:
    """Search from a stance.

    Args:
        space: what the search works on, fresh.
        open_list: some `EDGE`s as first memory of the open list.
        max_expansions: nodes that may be expanded.

    Returns:
        Outcome, last node, node before it, cost, expansions, progress by the estimated cost to go.
    """
    limits, goal, lattice, stand = space.limits[0], space.goal[0], space.lattice[0], space.stand[0]
    headings, feet, nodes, grounds = space.headings, space.feet, space.nodes, space.grounds
    reference, rejections = space.reference, space.rejections
    root, swing = _put_feet(limits, goal, lattice, space.path, space.field, headings, feet, nodes)
    start_to_go, best = nodes[root].to_go, root
    size = push(open_list, 0, 0.0, 0.0, root, swing)
    outcome, expansions = EXHAUSTED, 0
    while size > 0:
        node, stance, cost = open_list[0].node, open_list[0].parent, open_list[0].cost
        size = pop(open_list, size)
        square = goal.final and nodes[node].arrived and nodes[stance].arrived
        if nodes[node].status == CLOSED and not square:
            continue
        if cost < 0.0:
            x, y = _place(limits, lattice, feet, node)
            ground = grounds[node % lattice.stances]
            if ground.outcome == UNSEEN:
                _snap(space, _floor(lattice, node), x, y, headings[_heading(lattice, node), 0], ground)
            _stand_on(limits, lattice, headings, feet, nodes, grounds, stance, stand)
            cost = _take(space.raster, limits, reference, stand, stance, x, y, nodes[node], ground, square, rejections)
            if cost >= 0.0:
                estimate = cost + limits.heuristic_weight * nodes[node].to_go
                size = push(open_list, size, estimate, cost, node, stance)
                if nodes[node].to_go < nodes[best].to_go:
                    best = node
            continue
        there = nodes[node]
        if square or (there.arrived and not goal.final and there.depth >= limits.minimum_steps):
            return REACHED, node, stance, cost, expansions, start_to_go - there.to_go
        if expansions >= max_expansions:
            outcome = OUT_OF_BUDGET
            break
        there.status = CLOSED
        expansions += 1
        open_list, size, best = _expand(space, open_list, size, best, node)
    return outcome, best, nodes[best].parent, nodes[best].cost, expansions, start_to_go - nodes[best].to_go


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
        heading, node = (lattice.heading, root) if i == 0 else (lattice.headings, swing)
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
    path, field, reference, x0, y0 = space.path, space.field, space.reference, space.feet[0, 0], space.feet[0, 1]
    side, heading = stance // lattice.stances, _heading(lattice, stance)
    iy, ix = stance // lattice.nx % lattice.ny, stance % lattice.nx
    table, sign = side * lattice.headings + heading, 2.0 * side - 1.0
    steps = space.steps[table]
    if space.step_counts[table] == 0:
        space.step_counts[table] = fill_level_steps(limits, headings, heading, sign, steps)
    count = int(space.step_counts[table])
    open_list = with_room(open_list, size, count * lattice.floors)
    _stand_on(limits, lattice, headings, space.feet, nodes, grounds, stance, stand)
    for k in range(count * lattice.floors):
        step, floor = k // lattice.floors, k % lattice.floors
        jx, jy, turned = ix + steps[step, 0], iy + steps[step, 1], steps[step, 2]
        if jx < 0 or jy < 0 or jx >= lattice.nx or jy >= lattice.ny:
            rejections[OUTSIDE] += 1
            continue
        snap = ((floor * lattice.headings + turned) * lattice.ny + jy) * lattice.nx + jx
        ground = grounds[snap]
        if ground.outcome > FOOTHOLD:
            rejections[ground.outcome] += 1
            continue
        node = (1 - side) * lattice.stances + snap
        there = nodes[node]
        x, y = x0 + (jx - lattice.ix) * limits.lattice, y0 + (jy - lattice.iy) * limits.lattice
        if there.status == UNKNOWN:
            z = _height(space.raster, floor, x, y)
            if np.isnan(z):
                ground.outcome = NO_GROUND
                rejections[NO_GROUND] += 1
                continue
            there.status = JUDGED
            judge(limits, goal, path, field, x, y, z, headings[turned], sign, there)
        if there.to_go == np.inf:
            rejections[OUTSIDE] += 1
            continue
        square = goal.final and there.arrived and nodes[stance].arrived
        least = stand.cost + limits.step_cost + there.off_path_cost
        if not square and (there.status == CLOSED or (there.status == OPEN and least >= there.cost)):
            continue
        cost = -1.0
        if ground.outcome == FOOTHOLD:
            cost = _take(space.raster, limits, reference, stand, stance, x, y, there, ground, square, rejections)
            if cost < 0.0:
                continue
            least = cost
            if there.to_go < nodes[best].to_go:
                best = node
        size = push(open_list, size, least + limits.heuristic_weight * there.to_go, cost, node, stance)
    return open_list, size, best


@kernel
def _take(
    raster: Raster,
    limits: Records,
    reference: Array,
    stand: Records,
    stance: int,
    x: float,
    y: float,
    there: Records,
    ground: Records,
    square: bool,
    rejections: NDArray[np.int64],
) -> float:
    """Cost of the way to a foot by a step onto known ground; negative where the step is not worth opening.

    Where no better way to the foot is known, it takes this one.
    """
    cost = step_cost(raster, limits, reference, stand, x, y, ground)
    if cost < 0.0:
        rejections[int(-cost)] += 1
        return -1.0
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
    swing, heading = nodes[stance].parent, _heading(lattice, stance)
    stand.x, stand.y = _place(limits, lattice, feet, stance)
    stand.cos, stand.sin = headings[heading, 1], headings[heading, 2]
    stand.cost, stand.depth = nodes[stance].cost, nodes[stance].depth
    # The first two feet stand where they do, on whatever ground.
    if swing == 2 * lattice.stances:
        stand.z, stand.uphill = feet[0, 2], feet[0, 4] * stand.cos + feet[0, 5] * stand.sin
        stand.swing_x, stand.swing_y, stand.swing_z = feet[1, 0], feet[1, 1], feet[1, 2]
        return
    ground = grounds[stance % lattice.stances]
    stand.z, stand.uphill = ground.z, ground.a * stand.cos + ground.b * stand.sin
    stand.swing_x, stand.swing_y = _place(limits, lattice, feet, swing)
    stand.swing_z = feet[0, 2] if nodes[swing].parent == 2 * lattice.stances else grounds[swing % lattice.stances].z


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
