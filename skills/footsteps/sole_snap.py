"""Kernels for a sole on a raster of planes: snap it to the ground, sweep it over the ground."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.footstep_parameters import FootstepParameters
from skills.footsteps.plane_raster import Raster, floor_near
from skills.footsteps.rejections import (
    AT_CLIFF,
    AT_DROP,
    AT_SHIN,
    AT_WALL,
    FOOTHOLD,
    GROUND_ABOVE,
    NO_GROUND,
    TOO_SMALL,
    TOO_STEEP,
)
from skills.footsteps.walls import near_top, wall_top
from skills.geometry.pose import Array, readonly
from skills.kernels import kernel

SAMPLE_SPACING = 0.01


# Farther around the sole, where only high or low ground counts, it is felt for at fewer points [m].
_FAR_SPACING = 0.02

# What a sole may stand on, for the kernels: fields are named after the parameters; `under` counts the samples that lie
# under the sole, `close` those and the ones right beside it, `cliff` and `shin` those and what lies farther out.
SNAP_LIMITS = np.dtype(
    [
        (name, np.float64)
        for name in (
            *("tilt_tangent", "share", "support_below", "ground_above", "cliff_height", "shin_height", "drop_depth"),
            *("body_base", "under", "close", "cliff", "shin"),
        )
    ]
)


@kernel
def snap_sole(
    raster: Raster,
    floor: int,
    snap_limits: NDArray[Any],
    samples: Array,
    x: float,
    y: float,
    yaw: float,
    out: Array,
) -> int:
    """Put a level sole at x, y (from the corner), yaw on the plane of the cell under its centre.

    Writes height, slopes a and b, and supported share into `out` (4,), as far as they are known when a reason against
    the foothold is found; returns FOOTHOLD or that reason. `samples` (N, 2) are those of `SoleSamples`.
    """
    limits = snap_limits[0]
    cells, planes = raster.cells, raster.planes
    floors, ny, nx = cells.shape
    scale = 1.0 / raster.resolution
    if x < 0.0 or y < 0.0 or x * scale >= nx or y * scale >= ny:
        return NO_GROUND
    ground = cells[floor, int(y * scale), int(x * scale)]
    if ground < 0:
        return NO_GROUND
    a, b, c = planes[ground, 0], planes[ground, 1], planes[ground, 2]
    out[0], out[1], out[2], out[3] = a * x + b * y + c, a, b, 1.0
    if a * a + b * b > limits.tilt_tangent * limits.tilt_tangent:
        return TOO_STEEP
    walled = near_top(raster, x, y) > out[0] + limits.cliff_height
    cos, sin = np.cos(yaw), np.sin(yaw)
    under, close, cliff, shin = int(limits.under), int(limits.close), int(limits.cliff), int(limits.shin)
    unsupported = 0
    for n in range(samples.shape[0]):
        u, v = samples[n, 0], samples[n, 1]
        px, py = x + cos * u - sin * v, y + sin * u + cos * v
        there = -1
        if px >= 0.0 and py >= 0.0 and px * scale < nx and py * scale < ny:
            iy, ix = int(py * scale), int(px * scale)
            there = cells[0, iy, ix]
            if floors > 1:
                there = floor_near(cells, planes, iy, ix, px, py, out[0])
        if walled and n < cliff and wall_top(raster, px, py, out[0], limits.body_base) > out[0] + limits.cliff_height:
            return AT_WALL
        if there == ground:
            continue
        rise = -np.inf
        if there >= 0:
            rise = (planes[there, 0] - a) * px + (planes[there, 1] - b) * py + planes[there, 2] - c
        if n >= shin:
            if rise < -limits.drop_depth:
                return AT_DROP
        elif n >= cliff:
            if rise > limits.shin_height:
                return AT_SHIN
        elif n >= close:
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
    raster: Raster,
    corner: Array,
    half_length: float,
    half_width: float,
    soles: Array,
    clearances: Array,
) -> None:
    """Smallest height of each sole above the ground, or the wall, under it; +inf where no ground is known.

    `soles` (N, 6) rows x, y, z, yaw of the centre in the world and slopes a, b; `clearances` (N,) is filled.
    """
    planes = raster.planes
    floors, ny, nx = raster.cells.shape
    scale = 1.0 / raster.resolution
    along = int(np.ceil(2 * half_length / SAMPLE_SPACING))
    across = int(np.ceil(2 * half_width / SAMPLE_SPACING))
    for n in range(soles.shape[0]):
        x, y = soles[n, 0] - corner[0], soles[n, 1] - corner[1]
        cos, sin = np.cos(soles[n, 3]), np.sin(soles[n, 3])
        smallest = np.inf
        walled = near_top(raster, x, y) > -np.inf
        for i in range(along + 1):
            u = half_length * (2 * i / along - 1)
            for j in range(across + 1):
                v = half_width * (2 * j / across - 1)
                dx, dy = cos * u - sin * v, sin * u + cos * v
                px, py = x + dx, y + dy
                if px < 0.0 or py < 0.0 or px * scale >= nx or py * scale >= ny:
                    continue
                height = soles[n, 2] + soles[n, 4] * dx + soles[n, 5] * dy
                iy, ix = int(py * scale), int(px * scale)
                there = raster.cells[0, iy, ix]
                if floors > 1:
                    there = floor_near(raster.cells, planes, iy, ix, px, py, height)
                if there >= 0:
                    ground = planes[there, 0] * px + planes[there, 1] * py + planes[there, 2]
                    smallest = min(smallest, height - ground)
                if walled:
                    smallest = min(smallest, height - wall_top(raster, px, py, height, 0.0))
        clearances[n] = smallest


@dataclass(frozen=True, slots=True, eq=False)
class SoleSamples:
    """Points at which a sole feels the ground, and how many are of which kind.

    Attributes:
        points_sole: (N, 2) in the sole frame: under it, right beside it, then where cliffs, shin and drops count [m].
        under, close, cliff, shin: the number of points up to and with each kind; the rest are for drops.
    """

    points_sole: Array
    under: int
    close: int
    cliff: int
    shin: int

    @classmethod
    def of(cls, parameters: FootstepParameters) -> SoleSamples:
        """Under the sole to its very edge, then as far around it as the parameters say."""
        p = parameters
        half = (0.5 * p.sole_length, 0.5 * p.sole_width)
        toe, side = max(p.cliff_toe, p.sole_edge), max(p.cliff_side, p.sole_edge)
        x = _stations(
            *(-half[0] - d for d in (side, p.sole_edge, 0.0)), *(half[0] + d for d in (0.0, p.sole_edge, toe))
        )
        y = _stations(
            *(-half[1] - d for d in (side, p.sole_edge, 0.0)), *(half[1] + d for d in (0.0, p.sole_edge, side))
        )
        points = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
        outside = np.max(np.abs(points) - half, axis=1)
        kind = np.searchsorted((1e-9, p.sole_edge + 1e-9), outside)
        near = points[np.lexsort((-outside, kind))]
        around_shin = _band(half, (side, toe), (p.shin_side, p.shin_toe))
        around_drop = _band(half, (0.0, 0.0), (p.drop_distance, p.drop_distance))
        counts = np.cumsum((np.sum(kind == 0), np.sum(kind == 1), np.sum(kind == 2), len(around_shin)))
        return cls(readonly(np.concatenate((near, around_shin, around_drop))), *(int(n) for n in counts))


def _band(half: tuple[float, float], inner: tuple[float, float], outer: tuple[float, float]) -> Array:
    """Points around a sole between two distances beside it and from its toe, (N, 2); the heel is a side."""
    if outer[0] <= inner[0] and outer[1] <= inner[1]:
        return np.zeros((0, 2))
    spans = [(-half[0] - outer[0], half[0] + outer[1]), (-half[1] - outer[0], half[1] + outer[0])]
    x, y = (np.linspace(low, high, 2 + int((high - low) / _FAR_SPACING)) for low, high in spans)
    points = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1).reshape(-1, 2)
    toe = points[:, 0] > half[0] + inner[1]
    return points[toe | (points[:, 0] < -half[0] - inner[0]) | (np.abs(points[:, 1]) > half[1] + inner[0])]


def _stations(*ends: float) -> Array:
    """Coordinates from the first end to the last that hold all ends and lie no farther apart than the spacing."""
    pieces = [
        np.linspace(low, high, int(np.ceil((high - low) / SAMPLE_SPACING - 1e-9)), endpoint=False)
        for low, high in pairwise(ends)
    ]
    return np.concatenate((*pieces, ends[-1:]))
