"""Kernels on a raster of planes: draw planar regions into it, snap a sole to it, sweep a sole over it.

A cell holds the index of the plane z = a x + b y + c that is the ground there, -1 where none is known; x and y are
measured from the corner of the raster, so that the arithmetic does not lose bits far from the world's origin.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array
from skills.kernels import kernel

Cells = NDArray[np.int32]
Indices = NDArray[np.int64]

UNSEEN, FOOTHOLD, NO_GROUND, TOO_STEEP, GROUND_ABOVE, TOO_SMALL, AT_CLIFF = range(7)
SNAP_REASONS = ("", "", "no ground", "too steep", "ground above the sole", "foothold too small", "at a cliff")
SAMPLE_SPACING = 0.01


# What a sole may stand on, for the kernels: fields are named after the parameters; `under` counts the samples that lie
# under the sole, `close` those and the ones right beside it.
SNAP_LIMITS = np.dtype(
    [
        (name, np.float64)
        for name in (
            *("tilt_tangent", "share", "support_below", "ground_above", "cliff_height"),
            *("under", "close"),
        )
    ]
)


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
    cells: Cells,
    planes: Array,
    resolution: float,
    snap_limits: NDArray[Any],
    samples: Array,
    x: float,
    y: float,
    yaw: float,
    out: Array,
) -> int:
    """Put a level sole at x, y (from the corner), yaw on the plane of the cell under its centre.

    Writes height, slopes a and b, and supported share into `out` (4,), as far as they are known when a reason against
    the foothold is found; returns FOOTHOLD or that reason. `samples` (N, 2) are points of the sole, then of its
    surroundings, see `sole_samples`.
    """
    limits = snap_limits[0]
    ny, nx = cells.shape
    scale = 1.0 / resolution
    if x < 0.0 or y < 0.0 or x * scale >= nx or y * scale >= ny:
        return NO_GROUND
    ground = cells[int(y * scale), int(x * scale)]
    if ground < 0:
        return NO_GROUND
    a, b, c = planes[ground, 0], planes[ground, 1], planes[ground, 2]
    out[0], out[1], out[2], out[3] = a * x + b * y + c, a, b, 1.0
    if a * a + b * b > limits.tilt_tangent * limits.tilt_tangent:
        return TOO_STEEP
    cos, sin = np.cos(yaw), np.sin(yaw)
    under, close = int(limits.under), int(limits.close)
    unsupported = 0
    for n in range(samples.shape[0]):
        u, v = samples[n, 0], samples[n, 1]
        px, py = x + cos * u - sin * v, y + sin * u + cos * v
        there = -1
        if px >= 0.0 and py >= 0.0 and px * scale < nx and py * scale < ny:
            there = cells[int(py * scale), int(px * scale)]
        if there == ground:
            continue
        rise = -np.inf
        if there >= 0:
            rise = (planes[there, 0] - a) * px + (planes[there, 1] - b) * py + planes[there, 2] - c
        if n >= close:
            if rise > limits.cliff_height:
                return AT_CLIFF
        elif rise > limits.ground_above:
            return GROUND_ABOVE
        elif n < under and rise < -limits.support_below:
            unsupported += 1
            out[3] = 1.0 - unsupported / limits.under
            if out[3] < limits.share:
                return TOO_SMALL
    return FOOTHOLD


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
    scale = 1.0 / resolution
    along = int(np.ceil(2 * half_length / SAMPLE_SPACING))
    across = int(np.ceil(2 * half_width / SAMPLE_SPACING))
    for n in range(soles.shape[0]):
        x, y = soles[n, 0] - corner[0], soles[n, 1] - corner[1]
        cos, sin = np.cos(soles[n, 3]), np.sin(soles[n, 3])
        smallest = np.inf
        for i in range(along + 1):
            u = half_length * (2 * i / along - 1)
            for j in range(across + 1):
                v = half_width * (2 * j / across - 1)
                dx, dy = cos * u - sin * v, sin * u + cos * v
                px, py = x + dx, y + dy
                if px < 0.0 or py < 0.0 or px * scale >= nx or py * scale >= ny:
                    continue
                there = cells[int(py * scale), int(px * scale)]
                if there >= 0:
                    ground = planes[there, 0] * px + planes[there, 1] * py + planes[there, 2]
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


def sole_samples(length: float, width: float, edge: float, toe: float, beside: float) -> tuple[Array, int, int]:
    """Points at which a sole feels the ground: under it to its very edge, right beside it, and farther around it.

    Args:
        length: length of the sole [m].
        width: its width [m].
        edge: how far from the sole is right beside it [m].
        toe: how far before the toe it feels for cliffs [m].
        beside: how far behind the heel and beside the sides [m].

    Returns:
        Points in the sole frame, (N, 2), each kind from the outside in; how many are under it, and how many under it
        or right beside it.
    """
    x = _stations(*(-0.5 * length - d for d in (beside, edge, 0.0)), *(0.5 * length + d for d in (0.0, edge, toe)))
    y = _stations(*(-0.5 * width - d for d in (beside, edge, 0.0)), *(0.5 * width + d for d in (0.0, edge, beside)))
    points = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    outside = np.max(np.abs(points) - (0.5 * length, 0.5 * width), axis=1)
    kind = np.searchsorted((1e-9, edge + 1e-9), outside)
    order = np.lexsort((-outside, kind))
    return points[order], int(np.sum(kind == 0)), int(np.sum(kind <= 1))


def _stations(*ends: float) -> Array:
    """Coordinates from the first end to the last that hold all ends and lie no farther apart than the spacing."""
    pieces = [
        np.linspace(low, high, int(np.ceil((high - low) / SAMPLE_SPACING - 1e-9)), endpoint=False)
        for low, high in pairwise(ends)
    ]
    return np.concatenate((*pieces, ends[-1:]))
