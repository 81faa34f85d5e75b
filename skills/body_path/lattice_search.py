"""A* over a lattice with 16 neighbours, from any place to any place: our own planner of the body path.

Each node is the middle of a cell of the layers. Edges are the motions to the 8 cells around and to the 8 a knight's
move away; they cost what `path_cost` says, and the straight line at the price of good ground bounds what is left.
Start and goal lie between nodes and are joined to those around them.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.body_path.ground_layers import GROUND
from skills.body_path.path_cost import body_fits, density, look_up, motion_cost, motion_fits
from skills.footsteps.open_list import EDGE, pop, push, with_room
from skills.footsteps.records import Records
from skills.geometry.pose import Array
from skills.kernels import kernel

NEIGHBOURS = np.array(
    [
        *((1, 0), (2, 1), (1, 1), (1, 2), (0, 1), (-1, 2), (-1, 1), (-2, 1)),
        *((-1, 0), (-2, -1), (-1, -1), (-1, -2), (0, -1), (1, -2), (1, -1), (2, -1)),
    ]
)
"""Columns and rows to each neighbour, by their heading; the opposite of one is 8 further on."""

JOINED = 1.6  # Start and goal are joined to nodes within so many cells.
_NEARER = 12.0  # Where the goal cannot be reached a metre nearer to it is worth more than any metre costs.

_HALF, _ALL = 8, 16


@kernel
def search_lattice(
    layers: Array,
    cells: NDArray[np.float32],
    scale: Records,
    start: Array,
    goal: Array,
    beyond: float,
    way_out: float,
) -> tuple[Array, float, bool, int]:
    """The cheapest way over the lattice.

    Args:
        layers: of the ground.
        cells: of the height map.
        scale: one `SCALE`.
        start: (2,) [m].
        goal: (3,) x, y [m] and heading [rad].
        beyond: cost of a metre beyond the map where the goal lies there; 0 where it lies in the map.
        way_out: where the body does not fit at the start, it may leave to nodes within this distance [m].

    Returns:
        The points of the way (N, 2); its cost; whether it reaches the goal, or the border on the way to one beyond;
        how many nodes were expanded. Where the goal cannot be reached the way leads as near to it as is worth it.
    """
    rows, columns = layers.shape[1], layers.shape[2]
    nodes = rows * columns
    at_start, at_goal = nodes, nodes + 1
    costs, parents = np.full(nodes + 2, np.inf), np.full(nodes + 2, -1)
    closed = np.zeros(nodes + 2, np.bool_)
    densities, fits = np.full((nodes, _ALL), np.nan), np.full((nodes, _HALF), -1, np.int8)
    heads = np.empty((_ALL, 3))
    for d in range(_ALL):
        length = np.sqrt(float(NEIGHBOURS[d, 0] ** 2 + NEIGHBOURS[d, 1] ** 2))
        heads[d, 0], heads[d, 1], heads[d, 2] = NEIGHBOURS[d, 0] / length, NEIGHBOURS[d, 1] / length, length
    open_list, size = np.empty(4096, EDGE), 0
    goal_open = beyond == 0.0 and body_fits(layers, cells, scale, goal[0], goal[1], np.cos(goal[2]), np.sin(goal[2]))
    costs[at_start] = 0.0
    size = _leave(layers, cells, scale, start, goal, way_out, costs, parents, open_list)
    if goal_open and _apart(start[0], start[1], goal) < JOINED * scale.spacing:
        size = _reach(layers, cells, scale, start[0], start[1], goal, at_start, 0.0, costs, parents, open_list, size)
    nearest, best, expanded = at_start, _NEARER * _apart(start[0], start[1], goal), 0
    while size > 0:
        node, cost = open_list[0].node, open_list[0].cost
        size = pop(open_list, size)
        if closed[node]:
            continue
        closed[node] = True
        expanded += 1
        if node == at_goal:
            break
        i, j = node // columns, node % columns
        x, y = scale.x + j * scale.spacing, scale.y + i * scale.spacing
        distance = _apart(x, y, goal)
        if cost + _NEARER * distance < best:
            nearest, best = node, cost + _NEARER * distance
        open_list = with_room(open_list, size, _ALL + 1)
        if goal_open and distance < JOINED * scale.spacing:
            size = _reach(layers, cells, scale, x, y, goal, node, cost, costs, parents, open_list, size)
        if beyond > 0.0 and (i == 0 or j == 0 or i == rows - 1 or j == columns - 1):
            through = cost + beyond * distance
            if through < costs[at_goal]:
                costs[at_goal], parents[at_goal] = through, node
                size = push(open_list, size, through, through, at_goal, node)
        for d in range(_ALL):
            column, row = j + NEIGHBOURS[d, 0], i + NEIGHBOURS[d, 1]
            if not (0 <= row < rows and 0 <= column < columns):
                continue
            to = row * columns + column
            if closed[to]:
                continue
            cos, sin, length = heads[d, 0], heads[d, 1], heads[d, 2] * scale.spacing
            to_x, to_y = scale.x + column * scale.spacing, scale.y + row * scale.spacing
            if not (
                _fits(layers, cells, scale, fits, node, d, x, y, cos, sin)
                and _fits(layers, cells, scale, fits, to, d, to_x, to_y, cos, sin)
            ):
                continue
            here = _density(layers, scale, densities, node, d, x, y, cos, sin)
            through = cost + 0.5 * length * (here + _density(layers, scale, densities, to, d, to_x, to_y, cos, sin))
            if through >= costs[to]:
                continue
            if heads[d, 2] > 1.0 and not body_fits(layers, cells, scale, 0.5 * (x + to_x), 0.5 * (y + to_y), cos, sin):
                continue
            costs[to], parents[to] = through, node
            size = push(open_list, size, through + _apart(to_x, to_y, goal), through, to, node)
    reached = bool(closed[at_goal])
    end = at_goal if reached else nearest
    if reached and beyond > 0.0:
        end = int(parents[at_goal])
    return _trace(scale, columns, start, goal, end, parents), float(costs[end]), reached, expanded


@kernel
def _leave(
    layers: Array,
    cells: NDArray[np.float32],
    scale: Records,
    start: Array,
    goal: Array,
    way_out: float,
    costs: Array,
    parents: NDArray[np.int64],
    open_list: Records,
) -> int:
    """Join the start to the nodes around it; how many edges there are."""
    rows, columns = layers.shape[1], layers.shape[2]
    size = 0
    ground, _, _ = look_up(layers, GROUND, (start[0] - scale.x) / scale.spacing, (start[1] - scale.y) / scale.spacing)
    # Where no node around can be reached the robot stands too near to something. It may leave, but not up or down.
    for radius in (JOINED * scale.spacing, way_out):
        checked = radius != way_out
        reach = int(np.ceil(radius / scale.spacing))
        middle_j = int(np.round((start[0] - scale.x) / scale.spacing))
        middle_i = int(np.round((start[1] - scale.y) / scale.spacing))
        for i in range(max(middle_i - reach, 0), min(middle_i + reach + 1, rows)):
            for j in range(max(middle_j - reach, 0), min(middle_j + reach + 1, columns)):
                x, y = scale.x + j * scale.spacing, scale.y + i * scale.spacing
                dx, dy = x - start[0], y - start[1]
                length = np.sqrt(dx * dx + dy * dy)
                if length > radius:
                    continue
                if checked:
                    free = motion_fits(layers, cells, scale, start[0], start[1], x, y)
                elif length > 0.0 and abs(layers[GROUND, i, j] - ground) < scale.ground_clearance:
                    free = body_fits(layers, cells, scale, x, y, dx / length, dy / length)
                else:
                    free = False
                if free and size < len(open_list):
                    node = i * columns + j
                    cost = motion_cost(layers, scale, start[0], start[1], x, y)
                    costs[node], parents[node] = cost, rows * columns
                    size = push(open_list, size, cost + _apart(x, y, goal), cost, node, rows * columns)
        if size > 0:
            break
    return size


@kernel
def _reach(
    layers: Array,
    cells: NDArray[np.float32],
    scale: Records,
    x: float,
    y: float,
    goal: Array,
    node: int,
    cost: float,
    costs: Array,
    parents: NDArray[np.int64],
    open_list: Records,
    size: int,
) -> int:
    """Join a node to the goal, where the way is free and cheaper; how many edges there are."""
    at_goal = layers.shape[1] * layers.shape[2] + 1
    through = cost + motion_cost(layers, scale, x, y, goal[0], goal[1])
    if through < costs[at_goal] and motion_fits(layers, cells, scale, x, y, goal[0], goal[1]):
        costs[at_goal], parents[at_goal] = through, node
        size = push(open_list, size, through, through, at_goal, node)
    return size


@kernel
def _apart(x: float, y: float, goal: Array) -> float:
    return np.sqrt((goal[0] - x) ** 2 + (goal[1] - y) ** 2)


@kernel
def _fits(
    layers: Array,
    cells: NDArray[np.float32],
    scale: Records,
    fits: NDArray[np.int8],
    node: int,
    d: int,
    x: float,
    y: float,
    cos: float,
    sin: float,
) -> bool:
    """Whether the body fits at a node, asked once for a heading and its opposite."""
    if fits[node, d % _HALF] < 0:
        fits[node, d % _HALF] = body_fits(layers, cells, scale, x, y, cos, sin)
    return fits[node, d % _HALF] == 1


@kernel
def _density(
    layers: Array, scale: Records, densities: Array, node: int, d: int, x: float, y: float, cos: float, sin: float
) -> float:
    """Cost of a metre at a node, asked once for a heading."""
    if np.isnan(densities[node, d]):
        densities[node, d] = density(layers, scale, x, y, cos, sin)[0]
    return densities[node, d]


@kernel
def _trace(scale: Records, columns: int, start: Array, goal: Array, end: int, parents: NDArray[np.int64]) -> Array:
    """The points of the way to a node (N, 2), from the start on."""
    at_start = len(parents) - 2
    count, node = 1, end
    while node != at_start:
        count += 1
        node = parents[node]
    points = np.empty((count, 2))
    points[0, 0], points[0, 1] = start[0], start[1]
    node = end
    for k in range(count - 1, 0, -1):
        if node == at_start + 1:
            points[k, 0], points[k, 1] = goal[0], goal[1]
        else:
            points[k, 0] = scale.x + (node % columns) * scale.spacing
            points[k, 1] = scale.y + (node // columns) * scale.spacing
        node = parents[node]
    return points
