"""Kernels for walls: regions too steep to stand on, as the heights between which they fill the cells of a raster."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.plane_raster import Raster
from skills.footsteps.records import Records
from skills.geometry.pose import Array
from skills.kernels import kernel

# Samples of a wall per cell, so that no cell on it is missed.
_DENSITY = 1.5
# Nobody who looks for a wall looks farther than this from a body's middle, a sole's, or a third of a swing [m].
NEAR = 0.3
# Cells of walls in one cell of the map that tells how high they are nearby.
_COARSE = 4
# Where the body feels for high ground [m].
_GROUND_SPACING = 0.04


@kernel
def draw_walls(
    vertices: Array,
    starts: NDArray[np.int64],
    rotations: Array,
    origins: Array,
    corner: Array,
    resolution: float,
    walls: NDArray[np.float32],
) -> None:
    """Widen the heights (lowest, highest) of the cells in `walls` (ny, nx, 2) by steep regions.

    `vertices` are the outlines, region after region, in coordinates of their planes: the first level, the second up
    the slope; even-odd. `rotations` (R, 3, 3) have those directions in their first two columns.
    """
    ny, nx = walls.shape[0], walls.shape[1]
    crossings = np.empty(vertices.shape[0] + 1)
    spacing = resolution / _DENSITY
    for r in range(rotations.shape[0]):
        begin, end = starts[r], starts[r + 1]
        low, high = np.inf, -np.inf
        for v in range(begin, end):
            low, high = min(low, vertices[v, 0]), max(high, vertices[v, 0])
        if not (np.isfinite(low) and np.isfinite(high) and np.isfinite(np.sum(origins[r]))):
            continue
        columns = int((high - low) / spacing) + 1
        for column in range(columns):
            u = low + (high - low) * (column + 0.5) / columns
            count = _cross(vertices, begin, end, u, crossings)
            for k in range(0, count - 1, 2):
                rows = int((crossings[k + 1] - crossings[k]) / spacing) + 2
                for row in range(rows):
                    v = crossings[k] + (crossings[k + 1] - crossings[k]) * row / (rows - 1)
                    x = (rotations[r, 0, 0] * u + rotations[r, 0, 1] * v + origins[r, 0] - corner[0]) / resolution
                    y = (rotations[r, 1, 0] * u + rotations[r, 1, 1] * v + origins[r, 1] - corner[1]) / resolution
                    z = rotations[r, 2, 0] * u + rotations[r, 2, 1] * v + origins[r, 2]
                    if x >= 0.0 and y >= 0.0 and x < nx and y < ny:
                        iy, ix = int(y), int(x)
                        walls[iy, ix, 0] = min(walls[iy, ix, 0], z)
                        walls[iy, ix, 1] = max(walls[iy, ix, 1], z)


@kernel
def spread_tops(walls: NDArray[np.float32], resolution: float) -> NDArray[np.float32]:
    """The highest point of walls that come within `NEAR` of any point of a large cell; -inf where none does.

    It tells in one look that no wall is near, or none that is high enough to matter.
    """
    ny, nx = walls.shape[0] // _COARSE + 1, walls.shape[1] // _COARSE + 1
    highest = np.full((ny, nx), np.float32(-np.inf))
    for iy in range(walls.shape[0]):
        for ix in range(walls.shape[1]):
            j, i = iy // _COARSE, ix // _COARSE
            highest[j, i] = max(highest[j, i], walls[iy, ix, 1])
    span = int(np.ceil(NEAR / (_COARSE * resolution)))
    along, tops = np.full_like(highest, np.float32(-np.inf)), np.full_like(highest, np.float32(-np.inf))
    for j in range(ny):
        for i in range(nx):
            for k in range(max(i - span, 0), min(i + span, nx - 1) + 1):
                along[j, i] = max(along[j, i], highest[j, k])
    for j in range(ny):
        for i in range(nx):
            for k in range(max(j - span, 0), min(j + span, ny - 1) + 1):
                tops[j, i] = max(tops[j, i], along[k, i])
    return tops


@kernel
def near_top(raster: Raster, x: float, y: float) -> float:
    """Highest point of walls within `NEAR` of x, y; -inf where there is none."""
    scale = 1.0 / (_COARSE * raster.wall_resolution)
    tops = raster.wall_tops
    if tops.shape[0] == 0:
        return -np.inf
    iy, ix = int(max(y * scale, 0.0)), int(max(x * scale, 0.0))
    return tops[min(iy, tops.shape[0] - 1), min(ix, tops.shape[1] - 1)]


@kernel
def _cross(vertices: Array, begin: int, end: int, u: float, crossings: Array) -> int:
    """Where an outline crosses a line u = constant, in order; how often."""
    count = 0
    for v in range(begin, end):
        w = v + 1 if v + 1 < end else begin
        if (vertices[v, 0] <= u) != (vertices[w, 0] <= u):
            t = (u - vertices[v, 0]) / (vertices[w, 0] - vertices[v, 0])
            at = vertices[v, 1] + t * (vertices[w, 1] - vertices[v, 1])
            place = count
            while place > 0 and crossings[place - 1] > at:
                crossings[place] = crossings[place - 1]
                place -= 1
            crossings[place] = at
            count += 1
    return count


@kernel
def wall_top(raster: Raster, x: float, y: float, z: float, above: float) -> float:
    """Highest point of a wall at x, y that reaches down to `above` over z or lower; -inf where there is none."""
    walls, scale = raster.walls, 1.0 / raster.wall_resolution
    if x < 0.0 or y < 0.0 or x * scale >= walls.shape[1] or y * scale >= walls.shape[0]:
        return -np.inf
    iy, ix = int(y * scale), int(x * scale)
    return walls[iy, ix, 1] if walls[iy, ix, 0] <= z + above else -np.inf


@kernel
def body_clear(raster: Raster, limits: Records, x: float, y: float, z: float, cos: float, sin: float) -> bool:
    """Whether a body over feet at height z, its middle at x, y, touches no wall and no high ground."""
    if raster.top > z + limits.body_base and not _clear_of_ground(raster, limits, x, y, z, cos, sin):
        return False
    if near_top(raster, x, y) < z + limits.body_base:
        return True
    spacing = raster.wall_resolution / _DENSITY
    along, across = int(limits.body_depth / spacing) + 1, int(limits.body_width / spacing) + 1
    for i in range(along + 1):
        u = limits.body_depth * (i / along - 0.5)
        for j in range(across + 1):
            v = limits.body_width * (j / across - 0.5)
            if not _free(raster, limits, x + cos * u - sin * v, y + sin * u + cos * v, z):
                return False
    return True


@kernel
def _clear_of_ground(raster: Raster, limits: Records, x: float, y: float, z: float, cos: float, sin: float) -> bool:
    """Whether no ground lies between the lower and the upper end of a body."""
    along, across = int(limits.body_depth / _GROUND_SPACING) + 1, int(limits.body_width / _GROUND_SPACING) + 1
    scale, planes = 1.0 / raster.resolution, raster.planes
    for i in range(along + 1):
        u = limits.body_depth * (i / along - 0.5)
        for j in range(across + 1):
            v = limits.body_width * (j / across - 0.5)
            px, py = x + cos * u - sin * v, y + sin * u + cos * v
            if px < 0.0 or py < 0.0 or px * scale >= raster.cells.shape[2] or py * scale >= raster.cells.shape[1]:
                continue
            for floor in range(raster.cells.shape[0]):
                there = raster.cells[floor, int(py * scale), int(px * scale)]
                if there >= 0:
                    height = planes[there, 0] * px + planes[there, 1] * py + planes[there, 2] - z
                    if limits.body_base < height < limits.body_top:
                        return False
    return True


@kernel
def way_clear(raster: Raster, limits: Records, x0: float, y0: float, x1: float, y1: float, z: float) -> bool:
    """Whether the middle of a body over feet at height z, some cells wide, crosses no wall on its straight way."""
    length = np.hypot(x1 - x0, y1 - y0)
    steps = int(length * _DENSITY / raster.wall_resolution) + 1
    # A single line would slip through where the cells of two walls meet at a corner.
    aside = raster.wall_resolution / max(length, raster.wall_resolution)
    for line in range(-1, 2):
        dx, dy = -line * aside * (y1 - y0), line * aside * (x1 - x0)
        for i in range(steps + 1):
            x, y = x0 + (x1 - x0) * i / steps + dx, y0 + (y1 - y0) * i / steps + dy
            if not _free(raster, limits, x, y, z):
                return False
    return True


@kernel
def wall_on_way(raster: Raster, x0: float, y0: float, x1: float, y1: float, z: float, step_over: float) -> bool:
    """Whether a foot on its straight way meets a wall that is too high to be stepped over at height z."""
    steps = int(np.hypot(x1 - x0, y1 - y0) * _DENSITY / raster.wall_resolution) + 1
    for i in range(steps + 1):
        top = wall_top(raster, x0 + (x1 - x0) * i / steps, y0 + (y1 - y0) * i / steps, z, step_over)
        if top > z + step_over:
            return True
    return False


@kernel
def _free(raster: Raster, limits: Records, x: float, y: float, z: float) -> bool:
    return wall_top(raster, x, y, z, limits.body_top) < z + limits.body_base
