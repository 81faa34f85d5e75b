"""Kernels on a raster of planes: planar regions drawn into it, and what is ground at a point.

A cell holds the index of the plane z = a x + b y + c that is the ground there, -1 where none is known; x and y are
measured from the corner of the raster, so that the arithmetic does not lose bits far from the world's origin. Ground
that lies higher above other ground than a robot is another floor, in a layer of its own: stairs wind over themselves.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.outline_edges import Outlines
from skills.geometry.pose import Array
from skills.kernels import kernel

Cells = NDArray[np.int32]

# Ground this far above other ground is another floor [m]; what is nearer hides what is below, or is newer.
FLOOR_HEIGHT = 1.2


class Raster(NamedTuple):
    """Ground and walls as the kernels take them; x and y are measured from the corner [m].

    Attributes:
        cells: plane indices by floor, (floors, rows, columns).
        planes: planes (P, 3).
        resolution: cell size [m].
        walls: lowest and highest point of walls, (rows, columns, 2), in larger cells; empty where there are no walls.
        wall_resolution: their size [m].
        wall_tops: highest point of a wall near each place, (rows, columns), see `spread_tops`; empty likewise.
        top: no ground is higher [m].
    """

    cells: Cells
    planes: Array
    resolution: float
    walls: NDArray[np.float32]
    wall_resolution: float
    wall_tops: NDArray[np.float32]
    top: float


@kernel
def draw_regions(
    outlines: Outlines,
    times: Array,
    corner: Array,
    resolution: float,
    drawn: Cells,
    cells: Cells,
    planes: Array,
) -> tuple[int, float]:
    """Fill `planes` (R, 3) and a layer of `cells` (ny, nx) from the outlines of regions; even-odd, so holes stay open.

    Of regions on one floor the later wins a cell, of two with the same time the higher one. Regions with a NaN plane,
    and those on floors of layers already `drawn` (floors, ny, nx), are left out. Returns how many cells have one more
    floor, and the height of the highest vertex.
    """
    vertices, ring_starts, ring_regions = outlines.vertices, outlines.ring_starts, outlines.ring_regions
    rotations, origins = outlines.rotations, outlines.origins
    ny, nx = cells.shape
    more_floors, top = 0, -np.inf
    region_count = rotations.shape[0]
    for r in range(region_count):
        nz = rotations[r, 2, 2]
        a, b = -rotations[r, 0, 2] / nz, -rotations[r, 1, 2] / nz
        planes[r, 0], planes[r, 1] = a, b
        planes[r, 2] = origins[r, 2] - a * (origins[r, 0] - corner[0]) - b * (origins[r, 1] - corner[1])
    vertex_count = vertices.shape[0]
    xy = np.empty((vertex_count, 2))
    crossings = np.empty(vertex_count + 1)
    ring = 0
    while ring < ring_regions.shape[0]:
        r = ring_regions[ring]
        last = ring
        while last < ring_regions.shape[0] and ring_regions[last] == r:
            last += 1
        low, high = ring_starts[ring], ring_starts[last]
        lowest, highest = np.inf, -np.inf
        for v in range(low, high):
            for k in range(2):
                xy[v, k] = (
                    rotations[r, k, 0] * vertices[v, 0]
                    + rotations[r, k, 1] * vertices[v, 1]
                    + origins[r, k]
                    - corner[k]
                ) / resolution - 0.5
            lowest, highest = min(lowest, xy[v, 1]), max(highest, xy[v, 1])
            z = rotations[r, 2, 0] * vertices[v, 0] + rotations[r, 2, 1] * vertices[v, 1] + origins[r, 2]
            top = max(top, z) if z == z else top
        if np.isfinite(planes[r, 2]) and np.isfinite(lowest) and np.isfinite(highest):
            for iy in range(max(0, int(np.ceil(lowest))), min(ny - 1, int(np.floor(highest))) + 1):
                count = 0
                for k in range(ring, last):
                    begin, end = ring_starts[k], ring_starts[k + 1]
                    for v in range(begin, end):
                        w = v + 1 if v + 1 < end else begin
                        if (xy[v, 1] <= iy) != (xy[w, 1] <= iy):
                            x = xy[v, 0] + (iy - xy[v, 1]) / (xy[w, 1] - xy[v, 1]) * (xy[w, 0] - xy[v, 0])
                            place = count
                            while place > 0 and crossings[place - 1] > x:
                                crossings[place] = crossings[place - 1]
                                place -= 1
                            crossings[place] = x
                            count += 1
                for k in range(0, count - 1, 2):
                    first = max(0, int(np.ceil(max(crossings[k], -1.0))))
                    stop = min(nx - 1, int(np.floor(min(crossings[k + 1], float(nx)))))
                    for ix in range(first, stop + 1):
                        there = cells[iy, ix]
                        if there < 0 and drawn.shape[0] == 0:
                            cells[iy, ix] = r
                            continue
                        x, y = (ix + 0.5) * resolution, (iy + 0.5) * resolution
                        if drawn.shape[0] > 0 and _is_drawn(drawn, planes, r, iy, ix, x, y):
                            continue
                        rise = _rise(planes, r, there, x, y) if there >= 0 else np.inf
                        if there >= 0 and abs(rise) >= FLOOR_HEIGHT:
                            more_floors += 1
                        elif rise > 0.0 or times[r] != times[there]:
                            cells[iy, ix] = r
        ring = last
    return more_floors, top


@kernel
def _rise(planes: Array, plane: int, other: int, x: float, y: float) -> float:
    """How far a plane is above another at a point."""
    a, b = planes[plane, 0] - planes[other, 0], planes[plane, 1] - planes[other, 1]
    return a * x + b * y + planes[plane, 2] - planes[other, 2]


@kernel
def _is_drawn(drawn: Cells, planes: Array, plane: int, iy: int, ix: int, x: float, y: float) -> bool:
    """Whether a plane lies on a floor of the layers drawn before."""
    for floor in range(drawn.shape[0]):
        there = drawn[floor, iy, ix]
        if there >= 0 and abs(_rise(planes, plane, there, x, y)) < FLOOR_HEIGHT:
            return True
    return False


@kernel
def close_seams(cells: Cells, planes: Array, resolution: float, width: float, tolerance: float) -> Cells:
    """Give empty cells between two planes that agree in height there the plane of the nearer side.

    A gap up to `width` wide along x or y whose sides differ by no more than `tolerance` is closed. Cells of one floor,
    (ny, nx); returns new ones.
    """
    ny, nx = cells.shape
    most = int(width / resolution + 0.5)
    closed = cells.copy()
    for iy in range(ny):
        for ix in range(nx):
            if cells[iy, ix] >= 0:
                continue
            x, y = (ix + 0.5) * resolution, (iy + 0.5) * resolution
            for axis in range(2):
                dx, dy = (1, 0) if axis == 0 else (0, 1)
                before, after = 1, 1
                while before <= most and ix - before * dx >= 0 and iy - before * dy >= 0:
                    if cells[iy - before * dy, ix - before * dx] >= 0:
                        break
                    before += 1
                else:
                    continue
                while after <= most + 1 - before and ix + after * dx < nx and iy + after * dy < ny:
                    if cells[iy + after * dy, ix + after * dx] >= 0:
                        break
                    after += 1
                else:
                    continue
                p, q = cells[iy - before * dy, ix - before * dx], cells[iy + after * dy, ix + after * dx]
                rise = (
                    (planes[q, 0] - planes[p, 0]) * x + (planes[q, 1] - planes[p, 1]) * y + planes[q, 2] - planes[p, 2]
                )
                if abs(rise) <= tolerance:
                    closed[iy, ix] = p if before <= after else q
                    break
    return closed


@kernel
def floor_near(cells: Cells, planes: Array, iy: int, ix: int, x: float, y: float, z: float) -> int:
    """The plane in a cell that is the ground to one who stands at height z at x, y in it; -1 where there is none."""
    best, highest = -1, -np.inf
    for floor in range(cells.shape[0]):
        there = cells[floor, iy, ix]
        if there < 0:
            continue
        height = planes[there, 0] * x + planes[there, 1] * y + planes[there, 2]
        if height <= z + 0.5 * FLOOR_HEIGHT and height > highest:
            best, highest = there, height
    return best


@kernel
def nearest_floor(raster: Raster, x: float, y: float, z: float) -> int:
    """The layer whose ground at x, y from the corner is nearest in height to z; 0 where there is none."""
    scale = 1.0 / raster.resolution
    floors, ny, nx = raster.cells.shape
    best, least = 0, np.inf
    if x >= 0.0 and y >= 0.0 and x * scale < nx and y * scale < ny:
        for floor in range(floors):
            there = raster.cells[floor, int(y * scale), int(x * scale)]
            if there >= 0:
                plane = raster.planes[there]
                off = abs(plane[0] * x + plane[1] * y + plane[2] - z)
                if off < least:
                    best, least = floor, off
    return best


@kernel
def plane_heights(raster: Raster, points: Array, heights: Array) -> None:
    """Height of the ground under points x, y from the corner and z, (N, 3); NaN where none is known."""
    scale = 1.0 / raster.resolution
    _, ny, nx = raster.cells.shape
    for n in range(points.shape[0]):
        x, y, z = points[n, 0], points[n, 1], points[n, 2]
        heights[n] = np.nan
        if x >= 0.0 and y >= 0.0 and x * scale < nx and y * scale < ny:
            iy, ix = int(y * scale), int(x * scale)
            there = raster.cells[0, iy, ix]
            if raster.cells.shape[0] > 1:
                there = floor_near(raster.cells, raster.planes, iy, ix, x, y, z)
            if there >= 0:
                heights[n] = raster.planes[there, 0] * x + raster.planes[there, 1] * y + raster.planes[there, 2]
