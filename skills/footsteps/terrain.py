"""The ground as a footstep planner sees it, and its first implementation: planar regions drawn into a raster of planes.

A sole snaps to the plane of the cell under its centre; what else lies under it is measured against that plane, so that
blocks whose tops line up carry one foot together, and no polygon is ever clipped.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.footstep_parameters import FootstepParameters, TerrainParameters
from skills.footsteps.plane_raster import (
    SNAP_LIMITS,
    SNAP_REASONS,
    close_seams,
    draw_regions,
    plane_heights,
    snap_sole,
    sole_samples,
    sweep_soles,
)
from skills.geometry.polygon import convex_hull
from skills.geometry.pose import Array, Pose, readonly
from skills.regions.planar_region import PlanarRegion, PlanarRegions


@dataclass(frozen=True, slots=True, eq=False)
class Foothold:
    """What a sole finds where it is put down.

    Attributes:
        T_world_sole: sole frame on the ground, z along the surface normal; None where there is no ground.
        share: supported share of the sole.
        reason: why it must not stand here; empty where it may.
    """

    T_world_sole: Pose | None
    share: float
    reason: str

    @property
    def usable(self) -> bool:
        """Whether a foot may stand here."""
        return not self.reason


class Terrain(Protocol):
    """Ground to put feet on.

    The search reads `cells` and `planes` itself: a terrain is whatever can be drawn into them.
    """

    @property
    def frame_id(self) -> int:
        """Newest depth image behind it."""
        ...

    @property
    def corner_world(self) -> Array:
        """Corner of the raster with the smallest x and y, (2,) [m]."""
        ...

    @property
    def resolution(self) -> float:
        """Cell size [m]."""
        ...

    @property
    def cells(self) -> NDArray[np.int32]:
        """Index of the plane that is the ground in a cell, (ny, nx); -1 where none is known."""
        ...

    @property
    def planes(self) -> Array:
        """Planes z = a x + b y + c with x and y from the corner, (P, 3)."""
        ...

    def snap(self, x: float, y: float, yaw: float, parameters: FootstepParameters) -> Foothold:
        """Put a sole on the ground: its pose, and whether it may stand there."""
        ...

    def foothold_polygon(self, T_world_sole: Pose, parameters: FootstepParameters) -> Array:
        """Supported part of a sole, (N, 2) convex polygon in the sole frame, counter-clockwise [m]."""
        ...

    def heights(self, points_world: Array) -> Array:
        """Height of the ground under points (N, 2 or 3), (N,) [m]; NaN where none is known."""
        ...

    def clearances(self, soles_world: Array, half_length: float, half_width: float) -> Array:
        """Smallest height of each sole above the ground under it, (N,) [m]; +inf where none is known.

        Args:
            soles_world: (N, 6) rows x, y, z, yaw of the sole's centre, slopes dz/dx and dz/dy of the sole.
            half_length: half the length of the sole [m].
            half_width: half its width [m].
        """
        ...


@dataclass(frozen=True, slots=True, eq=False)
class RegionTerrain:
    """Planar regions as a raster of planes; see `Terrain` for the attributes."""

    frame_id: int
    corner_world: Array
    resolution: float
    cells: NDArray[np.int32]
    planes: Array

    def snap(self, x: float, y: float, yaw: float, parameters: FootstepParameters) -> Foothold:
        """Put a sole on the ground: its pose, and whether it may stand there."""
        x, y, yaw = float(x), float(y), float(yaw)
        found = np.full(4, np.nan)
        from_corner = np.array((x, y)) - self.corner_world
        limits, samples = foothold_rules(parameters)
        x_corner, y_corner = (float(n) for n in from_corner)
        outcome = snap_sole(self.cells, self.planes, self.resolution, limits, samples, x_corner, y_corner, yaw, found)
        z, a, b, share = found
        T_world_sole = None if np.isnan(z) else sole_on_slope(x, y, z, yaw, a, b)
        return Foothold(T_world_sole, 0.0 if np.isnan(share) else float(share), SNAP_REASONS[outcome])

    def foothold_polygon(self, T_world_sole: Pose, parameters: FootstepParameters) -> Array:
        """Supported part of a sole, (N, 2) convex polygon in the sole frame, counter-clockwise [m]."""
        limits, samples = foothold_rules(parameters)
        under = samples[: int(limits["under"][0])]
        points_sole = np.column_stack((under, np.zeros(len(under))))
        points_world = T_world_sole @ points_sole
        rise = self.heights(points_world) - points_world[:, 2]
        supported = (rise >= -parameters.support_below) & (rise <= parameters.ground_above)
        return convex_hull(_row_ends(points_sole[supported, :2]))

    def heights(self, points_world: Array) -> Array:
        """Height of the ground under points (N, 2 or 3), (N,) [m]; NaN where none is known."""
        return plane_heights(self.cells, self.planes, self.resolution, self.corner_world, points_world)

    def clearances(self, soles_world: Array, half_length: float, half_width: float) -> Array:
        """Smallest height of each sole above the ground under it, (N,) [m]; +inf where none is known."""
        smallest = np.empty(len(soles_world))
        sweep_soles(
            self.cells,
            self.planes,
            self.resolution,
            self.corner_world,
            half_length,
            half_width,
            np.ascontiguousarray(soles_world),
            smallest,
        )
        return smallest


def region_terrain(
    regions: PlanarRegions, low_world: Array, high_world: Array, parameters: TerrainParameters
) -> RegionTerrain:
    """Draw regions into a raster of planes between two corners.

    Of overlapping regions the later wins a cell, of two with the same time the higher one. Walls are left out.

    Args:
        regions: planar regions in the world.
        low_world: (2,) corner of the raster with the smallest x and y [m].
        high_world: (2,) corner with the largest.
        parameters: cell size and what counts as ground.
    """
    resolution = float(parameters.resolution)
    low = readonly(np.floor(np.asarray(low_world, dtype=np.float64) / resolution) * resolution, (2,))
    nx, ny = (int(n) for n in np.ceil((np.asarray(high_world) - low) / resolution))
    cells = np.full((max(ny, 1), max(nx, 1)), -1, dtype=np.int32)
    steepest = np.cos(parameters.steepest_region)
    ground = [region for region in regions.regions if region.T_world_region.R[2, 2] > steepest]
    planes = np.zeros((len(ground), 3))
    if ground:
        _draw(ground, low, resolution, cells, planes)
        cells = close_seams(cells, planes, resolution, float(parameters.seam_width), float(parameters.seam_step))
    cells.flags.writeable = False
    return RegionTerrain(regions.frame_id, low, resolution, cells, readonly(planes))


def _draw(
    ground: list[PlanarRegion], corner: Array, resolution: float, cells: NDArray[np.int32], planes: Array
) -> None:
    rings = [(i, ring) for i, region in enumerate(ground) for ring in (region.hull_region, *region.holes_region)]
    draw_regions(
        np.concatenate([ring for _, ring in rings]),
        np.cumsum([0] + [len(ring) for _, ring in rings]),
        np.array([i for i, _ in rings]),
        np.array([region.T_world_region.R for region in ground]),
        np.array([region.T_world_region.p for region in ground]),
        np.array([region.time for region in ground], dtype=np.float64),
        corner,
        resolution,
        cells,
        planes,
    )


def sole_on_slope(x: float, y: float, z: float, yaw: float, a: float, b: float) -> Pose:
    """Sole at a point of a plane of slopes a = dz/dx, b = dz/dy; its x axis points along `yaw` when seen from above."""
    forward = np.array((np.cos(yaw), np.sin(yaw), a * np.cos(yaw) + b * np.sin(yaw)))
    up = np.array((-a, -b, 1.0))
    forward /= np.linalg.norm(forward)
    up /= np.linalg.norm(up)
    return Pose(np.column_stack((forward, np.cross(up, forward), up)), np.array((x, y, z)))


def slopes(T_world_sole: Pose) -> tuple[float, float]:
    """Slopes dz/dx and dz/dy of a sole's plane."""
    nx, ny, nz = T_world_sole.R[:, 2]
    return float(-nx / nz), float(-ny / nz)


@lru_cache(maxsize=8)
def foothold_rules(parameters: FootstepParameters) -> tuple[NDArray[np.void], Array]:
    """The limits on a foothold as the kernels take them, one `SNAP_LIMITS`, and where the sole feels the ground."""
    samples, under, close = sole_samples(
        parameters.sole_length,
        parameters.sole_width,
        parameters.sole_edge,
        max(parameters.cliff_toe, parameters.sole_edge),
        max(parameters.cliff_side, parameters.sole_edge),
    )
    derived = {"tilt_tangent": float(np.tan(parameters.tilt)), "under": under, "close": close}
    limits = pack(SNAP_LIMITS, parameters, derived)
    limits.flags.writeable = False
    return limits, readonly(samples)


def pack(layout: np.dtype[np.void], parameters: FootstepParameters, derived: dict[str, float]) -> NDArray[np.void]:
    """One record of a layout, from the parameters of the same names and from derived values."""
    names = layout.names or ()
    values = tuple(derived[name] if name in derived else getattr(parameters, name) for name in names)
    return np.array([values], dtype=layout)


def _row_ends(points: Array) -> Array:
    """Of points on a grid the first and the last of each row, which have the same convex hull."""
    ordered = points[np.lexsort((points[:, 1], points[:, 0]))]
    starts = np.flatnonzero(np.diff(ordered[:, 0], prepend=np.nan) != 0.0)
    return np.concatenate((ordered[starts], ordered[np.append(starts[1:], len(ordered)) - 1]))
