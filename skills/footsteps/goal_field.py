"""How far every place is from a goal over ground that a foot may reach: what guides a search for the whole way.

Places on a grid of each floor are joined by short moves over connected ground and, where ground ends, by hops as far as
a step reaches; Dijkstra's algorithm (1959) spreads the least cost from the goal. It leaves out how a foot is turned and
how much of it is supported, so the field is lower than what steps cost. Walls keep the middle of the body away.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.open_list import EDGE, pop, push, with_room
from skills.footsteps.plane_raster import FLOOR_HEIGHT, Raster, floor_near
from skills.footsteps.records import Records
from skills.footsteps.walls import way_clear
from skills.geometry.pose import Array
from skills.kernels import kernel

# Ground that a foot may stand on: most of a circle as wide as the foot lies flush within this height [m].
_FLUSH = 0.03
_LEAST_FLUSH = 6
_CIRCLE = np.array([(np.cos(angle), np.sin(angle)) for angle in np.linspace(0.0, 2 * np.pi, 8, endpoint=False)])
# How far ahead of a place its heading looks [m].
_LOOK_AHEAD = 0.35
# Along walls, and so far beside them [m], a way costs this many times more: there is less room to step.
_ALONG_WALLS, _BESIDE = 3.0, 0.1
# What is spread beyond the start, so that ways around what the field does not know are guided too.
_SPREAD, _SPREAD_STEPS = 1.2, 4.0


@kernel
def spread_field(
    raster: Raster, limits: Records, open_list: Records, goal: Array, start: Array, field: Array
) -> tuple[float, float]:
    """Fill `field` (floors, rows, columns, 3) with cost to the goal, heading and ground height of each place.

    `goal` and `start` are x, y from the corner and z. Places that are not reached have an infinite cost; it spreads
    some way past the start. Returns the cost of the reached place nearest to the start, and how far that is from it.
    """
    floors, ny, nx = field.shape[0], field.shape[1], field.shape[2]
    parents = np.full(floors * ny * nx, -1)
    closed = np.zeros(floors * ny * nx, np.bool_)
    border = np.zeros(floors * ny * nx, np.bool_)
    _find_ground(raster, limits, field)
    _block_by_walls(raster, limits, field)
    _find_border(limits, field, border)
    size = _open_near(limits, field, open_list, goal)
    cell = limits.field_cell
    most = int(limits.reach / cell)
    closest, at_closest, bound = np.inf, np.inf, np.inf
    while size > 0:
        cost, node = open_list[0].estimate, open_list[0].node
        size = pop(open_list, size)
        if closed[node]:
            continue
        if cost > bound:
            break
        closed[node] = True
        floor, iy, ix = node // (ny * nx), node // nx % ny, node % nx
        z, dearer = field[floor, iy, ix, 2], field[floor, iy, ix, 1]
        away = np.sqrt(((ix + 0.5) * cell - start[0]) ** 2 + ((iy + 0.5) * cell - start[1]) ** 2)
        if away < closest and abs(z - start[2]) < limits.max_step_height:
            closest, at_closest = away, cost
            if away < 1.5 * cell:
                bound = min(bound, _SPREAD * cost + _SPREAD_STEPS * limits.step_cost)
        span = most if border[node] else 2
        open_list = with_room(open_list, size, floors * (2 * span + 1) ** 2)
        for j in range(max(iy - span, 0), min(iy + span, ny - 1) + 1):
            for i in range(max(ix - span, 0), min(ix + span, nx - 1) + 1):
                hop = abs(j - iy) > 2 or abs(i - ix) > 2
                # Of long moves every other will do: short ones lead on from where they end.
                if (abs(j - iy) + abs(i - ix)) % 2 == 0 and (hop or abs(j - iy) != 1):
                    continue
                distance = cell * np.sqrt(float((j - iy) ** 2 + (i - ix) ** 2))
                for k in range(floors):
                    other = (k * ny + j) * nx + i
                    if closed[other] or (hop and not border[other]):
                        continue
                    # A place without ground has no height, and fails every comparison.
                    least, jz = cost + limits.step_cost * distance / limits.stride, field[k, j, i, 2]
                    if not (least < field[k, j, i, 0] and abs(jz - z) <= limits.max_step_height):
                        continue
                    way = _way(raster, limits, ix, iy, z, i, j, jz, distance, hop) * max(dearer, field[k, j, i, 1])
                    if cost + way < field[k, j, i, 0]:
                        field[k, j, i, 0], parents[other] = cost + way, node
                        size = push(open_list, size, cost + way, 0.0, other, node)
    _find_headings(cell, field, parents)
    return at_closest, closest


@kernel
def _way(
    raster: Raster,
    limits: Records,
    ix: int,
    iy: int,
    z: float,
    jx: int,
    jy: int,
    jz: float,
    distance: float,
    hop: bool,
) -> float:
    """Cost of moving between two places; infinite where that is too far or through a wall."""
    cell, rise = limits.field_cell, abs(jz - z)
    if distance > limits.reach or (rise > limits.reach_up_height and distance > limits.reach_up):
        return np.inf
    if hop and raster.walls.shape[0] > 0:
        x0, y0, x1, y1 = (ix + 0.5) * cell, (iy + 0.5) * cell, (jx + 0.5) * cell, (jy + 0.5) * cell
        if not way_clear(raster, limits, x0, y0, x1, y1, 0.5 * (z + jz)):
            return np.inf
    return limits.step_cost * distance / limits.stride + limits.height_cost * rise


@kernel
def _find_ground(raster: Raster, limits: Records, field: Array) -> None:
    """Give every place its height, NaN where a foot may not stand, no cost yet, and 1 for what a way costs there."""
    cells, planes, scale = raster.cells, raster.planes, 1.0 / raster.resolution
    for floor in range(field.shape[0]):
        for j in range(field.shape[1]):
            for i in range(field.shape[2]):
                x, y = (i + 0.5) * limits.field_cell, (j + 0.5) * limits.field_cell
                field[floor, j, i, 0], field[floor, j, i, 1], field[floor, j, i, 2] = np.inf, 1.0, np.nan
                ix, iy = int(x * scale), int(y * scale)
                if iy >= cells.shape[1] or ix >= cells.shape[2] or cells[floor, iy, ix] < 0:
                    continue
                plane = cells[floor, iy, ix]
                a, b = planes[plane, 0], planes[plane, 1]
                z = a * x + b * y + planes[plane, 2]
                if a * a + b * b <= limits.tilt_tangent * limits.tilt_tangent and _flush(raster, limits, x, y, z, a, b):
                    field[floor, j, i, 2] = z


@kernel
def _flush(raster: Raster, limits: Records, x: float, y: float, z: float, a: float, b: float) -> bool:
    """Whether most of a circle as wide as a foot lies flush around a point, and nothing rises on it."""
    scale, flush = 1.0 / raster.resolution, 0
    for k in range(_CIRCLE.shape[0]):
        dx, dy = limits.half_width * _CIRCLE[k, 0], limits.half_width * _CIRCLE[k, 1]
        px, py = x + dx, y + dy
        if px < 0.0 or py < 0.0 or py * scale >= raster.cells.shape[1] or px * scale >= raster.cells.shape[2]:
            continue
        there = floor_near(raster.cells, raster.planes, int(py * scale), int(px * scale), px, py, z)
        if there < 0:
            continue
        planes = raster.planes
        rise = planes[there, 0] * px + planes[there, 1] * py + planes[there, 2] - z - a * dx - b * dy
        if rise > _FLUSH:
            return False
        if rise >= -_FLUSH:
            flush += 1
    return flush >= _LEAST_FLUSH


@kernel
def _block_by_walls(raster: Raster, limits: Records, field: Array) -> None:
    """Take the places from which half the body's depth reaches into a wall; beyond that they cost more."""
    radius, cell, walls = 0.5 * limits.body_depth, limits.field_cell, raster.walls
    narrow = 0.5 * np.hypot(limits.body_depth, limits.body_width) + _BESIDE
    span = int(np.ceil(narrow / cell))
    lowest = np.inf
    for k in range(field.shape[0]):
        for j in range(field.shape[1]):
            for i in range(field.shape[2]):
                if field[k, j, i, 2] < lowest:
                    lowest = field[k, j, i, 2]
    for wy in range(walls.shape[0]):
        for wx in range(walls.shape[1]):
            if not walls[wy, wx, 1] >= lowest + limits.body_base:
                continue
            x, y = (wx + 0.5) * raster.wall_resolution, (wy + 0.5) * raster.wall_resolution
            iy, ix = int(y / cell), int(x / cell)
            for j in range(max(iy - span, 0), min(iy + span, field.shape[1] - 1) + 1):
                for i in range(max(ix - span, 0), min(ix + span, field.shape[2] - 1) + 1):
                    away = np.sqrt(((i + 0.5) * cell - x) ** 2 + ((j + 0.5) * cell - y) ** 2)
                    for k in range(field.shape[0]):
                        z = field[k, j, i, 2]
                        if walls[wy, wx, 0] <= z + limits.body_top and walls[wy, wx, 1] >= z + limits.body_base:
                            if away <= radius:
                                field[k, j, i, 2] = np.nan
                            elif away <= narrow:
                                field[k, j, i, 1] = _ALONG_WALLS


@kernel
def _find_border(limits: Records, field: Array, border: NDArray[np.bool_]) -> None:
    """Mark the places that lack ground within reach of a short move on some side."""
    floors, ny, nx = field.shape[0], field.shape[1], field.shape[2]
    for floor in range(floors):
        for j in range(ny):
            for i in range(nx):
                z = field[floor, j, i, 2]
                if np.isnan(z):
                    continue
                joined = 0
                for dj in range(-1, 2):
                    for di in range(-1, 2):
                        if 0 <= j + dj < ny and 0 <= i + di < nx:
                            for k in range(floors):
                                if abs(field[k, j + dj, i + di, 2] - z) <= limits.max_step_height:
                                    joined += 1
                                    break
                border[(floor * ny + j) * nx + i] = joined < 9


@kernel
def _open_near(limits: Records, field: Array, open_list: Records, goal: Array) -> int:
    """Open the places near the goal; how many."""
    cell, size = limits.field_cell, 0
    span = int(limits.ideal_width / cell) + 1
    gx, gy = int(goal[0] / cell), int(goal[1] / cell)
    for k in range(field.shape[0]):
        for j in range(max(gy - span, 0), min(gy + span, field.shape[1] - 1) + 1):
            for i in range(max(gx - span, 0), min(gx + span, field.shape[2] - 1) + 1):
                away = np.hypot((i + 0.5) * cell - goal[0], (j + 0.5) * cell - goal[1])
                if abs(field[k, j, i, 2] - goal[2]) <= limits.goal_height_tolerance and away <= limits.ideal_width:
                    cost = limits.step_cost * away / limits.stride
                    field[k, j, i, 0] = cost
                    size = push(open_list, size, cost, 0.0, (k * field.shape[1] + j) * field.shape[2] + i, -1)
    return size


@kernel
def _find_headings(cell: float, field: Array, parents: NDArray[np.int64]) -> None:
    """The direction to the place some way on towards the goal; NaN next to it."""
    ny, nx = field.shape[1], field.shape[2]
    for node in range(parents.shape[0]):
        floor, iy, ix = node // (ny * nx), node // nx % ny, node % nx
        field[floor, iy, ix, 1] = np.nan
        ahead = parents[node]
        if ahead < 0:
            continue
        dx, dy = ahead % nx - ix, ahead // nx % ny - iy
        while parents[ahead] >= 0 and np.hypot(dx, dy) * cell < _LOOK_AHEAD:
            ahead = parents[ahead]
            dx, dy = ahead % nx - ix, ahead // nx % ny - iy
        field[floor, iy, ix, 1] = np.arctan2(dy, dx)


@kernel
def look_up(limits: Records, field: Array, x: float, y: float, z: float) -> tuple[float, float]:
    """Cost to the goal and heading at a point x, y from the corner near ground of height z; infinite off the field."""
    cell, best, heading = limits.field_cell, np.inf, np.nan
    per_metre = limits.step_cost / limits.stride
    iy, ix = int(np.floor(y / cell)), int(np.floor(x / cell))
    for j in range(max(iy - 1, 0), min(iy + 1, field.shape[1] - 1) + 1):
        for i in range(max(ix - 1, 0), min(ix + 1, field.shape[2] - 1) + 1):
            away = per_metre * np.sqrt(((i + 0.5) * cell - x) ** 2 + ((j + 0.5) * cell - y) ** 2)
            for k in range(field.shape[0]):
                cost = field[k, j, i, 0] + away
                if cost < best and abs(field[k, j, i, 2] - z) < 0.5 * FLOOR_HEIGHT:
                    best, heading = cost, field[k, j, i, 1]
    return best, heading


def empty_field() -> Array:
    """The field of a search that a path guides."""
    return np.zeros((0, 0, 0, 3))


def open_edges(count: int = 4096) -> Records:
    """First memory of an open list."""
    return np.empty(count, dtype=EDGE)
