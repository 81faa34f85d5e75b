"""Kernels on a raster of planes: draw planar regions into it, snap a sole to it, sweep a sole over it.

A cell holds the index of the plane z = a x + b y + c that is the ground there, -1 where none is known; x and y are
measured from the corner of the raster, so that the arithmetic does not lose bits far from the world's origin.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array
from skills.kernels import kernel

Cells = NDArray[np.int32]
Indices = NDArray[np.int64]

UNSEEN, FOOTHOLD, NO_GROUND, TOO_STEEP, GROUND_ABOVE, TOO_SMALL, AT_CLIFF = range(7)
SNAP_REASONS = ("", "", "no ground", "too steep", "ground above the sole", "foothold too small", "at a cliff")
SAMPLE_SPACING = 0.013


class SnapLimits(NamedTuple):
    """What a sole may stand on, as floats for the kernels; see `FootstepParameters`."""

    half_length: float
    half_width: float
    steepest: float  # tangent of the steepest slope
    share: float
    support_below: float
    ground_above: float
    cliff_height: float
    cliff_toe: float
    cliff_side: float


@kernel
def draw_regions(
    vertices: Array,
    ring_starts: Indices,
    ring_regions: Indices,
    rotations: Array,
    origins: Array,
    times: Array,
    corner: Array,
    resolution: float,
    cells: Cells,
    planes: Array,
) -> None:
    """Fill `planes` (R, 3) and `cells` (ny, nx) from the outlines of regions; even-odd, so holes stay open.

    The later region wins a cell, of two with the same time the higher one. Regions with a NaN plane are not drawn.
    """
    ny, nx = cells.shape
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
                        if there < 0 or times[r] != times[there]:
                            cells[iy, ix] = r
                            continue
                        x, y = (ix + 0.5) * resolution, (iy + 0.5) * resolution
                        mine = planes[r, 0] * x + planes[r, 1] * y + planes[r, 2]
                        other = planes[there, 0] * x + planes[there, 1] * y + planes[there, 2]
                        if mine > other:
                            cells[iy, ix] = r
        ring = last


@kernel
def close_seams(cells: Cells, planes: Array, resolution: float, width: float, tolerance: float) -> Cells:
    """Give empty cells between two planes that agree in height there the plane of the nearer side.

    A gap up to `width` wide along x or y whose sides differ by no more than `tolerance` is closed; returns new cells.
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
def snap_sole(
    cells: Cells, planes: Array, resolution: float, limits: SnapLimits, x: float, y: float, yaw: float, out: Array
) -> int:
    """Put a level sole at x, y (from the corner), yaw on the plane of the cell under its centre.

    Writes height, slopes a and b, and supported share into `out` (4,); returns FOOTHOLD or the reason why not.
    """
    ny, nx = cells.shape
    ix, iy = int(np.floor(x / resolution)), int(np.floor(y / resolution))
    if ix < 0 or iy < 0 or ix >= nx or iy >= ny or cells[iy, ix] < 0:
        return NO_GROUND
    ground = cells[iy, ix]
    a, b, c = planes[ground, 0], planes[ground, 1], planes[ground, 2]
    out[0], out[1], out[2] = a * x + b * y + c, a, b
    if a * a + b * b > limits.steepest * limits.steepest:
        return TOO_STEEP
    cos, sin = np.cos(yaw), np.sin(yaw)
    length, width = 2 * limits.half_length, 2 * limits.half_width
    along = int(np.ceil(length / SAMPLE_SPACING))
    across = int(np.ceil(width / SAMPLE_SPACING))
    before = int(np.ceil(limits.cliff_toe / SAMPLE_SPACING))
    beside = int(np.ceil(limits.cliff_side / SAMPLE_SPACING))
    supported = 0
    cliff = False
    for i in range(-beside, along + before + 1):
        if i < 0:
            u = -limits.half_length + limits.cliff_side * i / beside
        elif i > along:
            u = limits.half_length + limits.cliff_toe * (i - along) / before
        else:
            u = -limits.half_length + length * i / along
        for j in range(-beside, across + beside + 1):
            if j < 0:
                v = -limits.half_width + limits.cliff_side * j / beside
            elif j > across:
                v = limits.half_width + limits.cliff_side * (j - across) / beside
            else:
                v = -limits.half_width + width * j / across
            under = 0 <= i <= along and 0 <= j <= across
            px, py = x + cos * u - sin * v, y + sin * u + cos * v
            jx, jy = int(np.floor(px / resolution)), int(np.floor(py / resolution))
            if jx < 0 or jy < 0 or jx >= nx or jy >= ny:
                continue
            there = cells[jy, jx]
            if there == ground:
                supported += under
            elif there >= 0:
                rise = (planes[there, 0] - a) * px + (planes[there, 1] - b) * py + planes[there, 2] - c
                if under:
                    if rise > limits.ground_above:
                        return GROUND_ABOVE
                    supported += rise >= -limits.support_below
                elif rise > limits.cliff_height:
                    cliff = True
    out[3] = supported / ((along + 1) * (across + 1))
    if cliff:
        return AT_CLIFF
    return FOOTHOLD if out[3] >= limits.share else TOO_SMALL


@kernel
def sweep_soles(
    cells: Cells,
    planes: Array,
    resolution: float,
    corner: Array,
    half_length: float,
    half_width: float,
    soles: Array,
    clearances: Array,
) -> None:
    """Smallest height of each sole above the ground under it; +inf where no ground is known.

    `soles` (N, 6) rows x, y, z, yaw of the centre in the world and slopes a, b; `clearances` (N,) is filled.
    """
    ny, nx = cells.shape
    along = int(np.ceil(2 * half_length / resolution))
    across = int(np.ceil(2 * half_width / resolution))
    for n in range(soles.shape[0]):
        x, y = soles[n, 0] - corner[0], soles[n, 1] - corner[1]
        cos, sin = np.cos(soles[n, 3]), np.sin(soles[n, 3])
        smallest = np.inf
        for i in range(along + 1):
            u = half_length * (2 * i / along - 1)
            for j in range(across + 1):
                v = half_width * (2 * j / across - 1)
                dx, dy = cos * u - sin * v, sin * u + cos * v
                jx, jy = int(np.floor((x + dx) / resolution)), int(np.floor((y + dy) / resolution))
                if jx < 0 or jy < 0 or jx >= nx or jy >= ny:
                    continue
                there = cells[jy, jx]
                if there >= 0:
                    ground = planes[there, 0] * (x + dx) + planes[there, 1] * (y + dy) + planes[there, 2]
                    smallest = min(smallest, soles[n, 2] + soles[n, 4] * dx + soles[n, 5] * dy - ground)
        clearances[n] = smallest


def plane_heights(cells: Cells, planes: Array, resolution: float, corner: Array, points_world: Array) -> Array:
    """Height of the ground under points (N, 2); NaN where none is known."""
    from_corner = points_world[:, :2] - corner
    index = np.floor(from_corner / resolution).astype(np.int64)
    inside = np.all((index >= 0) & (index < cells.shape[::-1]), axis=1)
    heights = np.full(len(points_world), np.nan)
    ground = cells[index[inside, 1], index[inside, 0]]
    a, b, c = planes[ground].T
    heights[inside] = np.where(ground >= 0, a * from_corner[inside, 0] + b * from_corner[inside, 1] + c, np.nan)
    return heights
