"""The ground as a footstep planner sees it, and its first implementation: planar regions drawn into a raster of planes.

A sole snaps to the plane of the cell under its centre; what else lies under it is measured against that plane, so that
blocks whose tops line up carry one foot together, and no polygon is ever clipped.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from math import cos, floor, sin, sqrt
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.footstep_parameters import FootstepParameters, TerrainParameters
from skills.footsteps.outline_edges import Outlines, edges_near
from skills.footsteps.plane_raster import Raster, close_seams, draw_regions, nearest_floor, plane_heights
from skills.footsteps.rejections import NO_GROUND, REASONS
from skills.footsteps.sole_snap import SNAP_LIMITS, SoleSamples, snap_sole
from skills.footsteps.supported_polygon import supported_polygon
from skills.footsteps.walls import draw_walls, spread_tops
from skills.geometry.pose import Array, Pose, readonly
from skills.regions.planar_region import PlanarRegion, PlanarRegions

_MOST_FLOORS = 4


@dataclass(frozen=True, slots=True, eq=False)
class Foothold:
    """What a sole finds where it is put down.

    Attributes:
        T_world_sole: sole frame on the ground, z along the surface normal; None where there is no ground.
        share: supported share of the sole.
        reason: why it must not stand here; empty where it may.
        margin: distance of the sole from the edges of its region, as far as it was measured [m].
    """

    T_world_sole: Pose | None
    share: float
    reason: str
    margin: float = 0.0

    @property
    def usable(self) -> bool:
        """Whether a foot may stand here."""
        return not self.reason


class Terrain(Protocol):
    """Ground to put feet on.

    The search reads `raster` itself: a terrain is whatever can be drawn into it.
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
    def raster(self) -> Raster:
        """Ground and walls."""
        ...

    def floor(self, p_world: Array) -> int:
        """Which layer of the raster is the ground nearest to a point; 0 where there is none under it."""
        ...

    def region(self, p_world: Array) -> PlanarRegion | None:
        """The planar region that is the ground nearest to a point; None where there is none."""
        ...

    def edges(self, T_world_sole: Pose, near: float) -> Array | None:
        """Edges of the region under a sole that come near its centre and have it inside; None without ground.

        Returns:
            (N, 3) unit outward normal x, y and offset from the centre, in the sole's frame [m].
        """
        ...

    def snap(self, x: float, y: float, yaw: float, parameters: FootstepParameters, z: float = np.inf) -> Foothold:
        """Put a sole on the ground: its pose, and whether it may stand there.

        Where floors lie above each other it is the one nearest to the height z, without it the highest.
        """
        ...

    def foothold_polygon(self, T_world_sole: Pose, parameters: FootstepParameters) -> Array:
        """Supported part of a sole, (N, 2) convex polygon in the sole frame, counter-clockwise [m]."""
        ...

    def heights(self, points_world: Array) -> Array:
        """Height of the ground under points (N, 2 or 3), (N,) [m]; NaN where none is known.

        Where floors lie above each other it is the one under z, without z the highest.
        """
        ...


@dataclass(frozen=True, slots=True, eq=False)
class RegionTerrain:
    """Planar regions as a raster of planes; see `Terrain` for the attributes."""

    frame_id: int
    corner_world: Array
    raster: Raster
    ground: tuple[PlanarRegion, ...]
    outlines: Outlines

    def floor(self, p_world: Array) -> int:
        """Which layer of the raster is the ground nearest to a point; 0 where there is none under it."""
        x, y = p_world[:2] - self.corner_world
        return nearest_floor(self.raster, x, y, p_world[2])

    def region(self, p_world: Array) -> PlanarRegion | None:
        """The planar region that is the ground nearest to a point; None where there is none."""
        plane = self._plane(p_world)
        return self.ground[plane] if plane >= 0 else None

    def edges(self, T_world_sole: Pose, near: float) -> Array | None:
        """Edges of the region under a sole that come near its centre and have it inside; None without ground."""
        plane = self._plane(T_world_sole.p)
        return edges_near(self.outlines, plane, T_world_sole.R, T_world_sole.p, near) if plane >= 0 else None

    def _plane(self, p_world: Array) -> int:
        """Index of the region that is the ground nearest to a point; -1 where there is none."""
        cells = self.raster.cells
        ix, iy = (floor(n) for n in (p_world[:2] - self.corner_world) / self.raster.resolution)
        inside = 0 <= iy < cells.shape[1] and 0 <= ix < cells.shape[2]
        return int(cells[self.floor(p_world), iy, ix]) if inside else -1

    def snap(self, x: float, y: float, yaw: float, parameters: FootstepParameters, z: float = np.inf) -> Foothold:
        """Put a sole on the ground: its pose, and whether it may stand there."""
        x, y, yaw = float(x), float(y), float(yaw)
        limits, samples = foothold_rules(parameters)
        x_corner, y_corner = (float(n) for n in np.array((x, y)) - self.corner_world)
        best, least = Foothold(None, 0.0, REASONS[NO_GROUND]), np.inf
        for layer in range(self.raster.cells.shape[0]):
            found = np.full(4, np.nan)
            outcome = snap_sole(self.raster, layer, limits, samples, x_corner, y_corner, yaw, found)
            height, a, b, share = found
            off = -height if np.isinf(z) else abs(height - z)
            if off < least:
                T_world_sole = sole_on_slope(x, y, height, yaw, a, b)
                best, least = Foothold(T_world_sole, float(share), REASONS[outcome]), off
        return best

    def foothold_polygon(self, T_world_sole: Pose, parameters: FootstepParameters) -> Array:
        """Supported part of a sole, (N, 2) convex polygon in the sole frame, counter-clockwise [m]."""
        limits, samples = foothold_rules(parameters)
        under = samples[: int(limits["under"][0])]
        points = T_world_sole @ np.column_stack((under, np.zeros(len(under))))
        cells = self.raster.cells
        iy, ix = np.floor((points[:, 1::-1] - self.corner_world[::-1]) / self.raster.resolution).astype(int).T
        inside = (iy >= 0) & (ix >= 0) & (iy < cells.shape[1]) & (ix < cells.shape[2])
        planes = np.unique(cells[:, iy[inside], ix[inside]])
        regions = [self.ground[plane] for plane in planes if plane >= 0]
        return supported_polygon(T_world_sole, regions, parameters)

    def heights(self, points_world: Array) -> Array:
        """Height of the ground under points (N, 2 or 3), (N,) [m]; NaN where none is known."""
        points = np.full((len(points_world), 3), np.inf)
        points[:, : points_world.shape[1]] = points_world
        points[:, :2] -= self.corner_world
        heights = np.empty(len(points))
        plane_heights(self.raster, points, heights)
        return heights


def region_terrain(
    regions: PlanarRegions, low_world: Array, high_world: Array, parameters: TerrainParameters
) -> RegionTerrain:
    """Draw regions into a raster of planes between two corners.

    Of regions that overlap on one floor the later wins a cell, of two with the same time the higher one. Regions too
    steep to stand on are walls.

    Args:
        regions: planar regions in the world.
        low_world: (2,) corner of the raster with the smallest x and y [m].
        high_world: (2,) corner with the largest.
        parameters: cell size and what counts as ground.
    """
    resolution = float(parameters.resolution)
    low = readonly(np.floor(np.asarray(low_world, dtype=np.float64) / resolution) * resolution, (2,))
    nx, ny = (max(1, int(n)) for n in np.ceil((np.asarray(high_world) - low) / resolution))
    steepest = np.cos(parameters.steepest_region)
    ground = [region for region in regions.regions if region.T_world_region.R[2, 2] > steepest]
    steep = [region for region in regions.regions if abs(region.T_world_region.R[2, 2]) <= steepest]
    outlines = Outlines.of(ground)
    times = np.array([region.time for region in ground], dtype=np.float64)
    cells, planes, top = _draw(outlines, times, low, resolution, (ny, nx))
    if ground:
        width, step = float(parameters.seam_width), float(parameters.seam_step)
        cells = np.stack([close_seams(layer, planes, resolution, width, step) for layer in cells])
    walls = _draw_walls(steep, low, float(parameters.wall_resolution), np.asarray(high_world) - low)
    tops = spread_tops(walls, float(parameters.wall_resolution)) if len(walls) else np.zeros((0, 0), dtype=np.float32)
    for array in (cells, planes, walls, tops):
        array.flags.writeable = False
    raster = Raster(cells, planes, resolution, walls, float(parameters.wall_resolution), tops, top)
    return RegionTerrain(regions.frame_id, low, raster, tuple(ground), outlines)


def _draw(
    outlines: Outlines, times: Array, corner: Array, resolution: float, shape: tuple[int, int]
) -> tuple[NDArray[np.int32], Array, float]:
    """Cells (floors, ny, nx), planes and the height of the top; as many layers as there are floors above each other."""
    planes = np.zeros((len(times), 3))
    cells = np.empty((0, *shape), dtype=np.int32)
    more_floors, top = 1, -np.inf
    while more_floors and len(cells) < _MOST_FLOORS:
        layer = np.full(shape, -1, dtype=np.int32)
        more_floors, top = draw_regions(outlines, times, corner, resolution, cells, layer, planes)
        cells = np.concatenate((cells, layer[None]))
    return cells, planes, top


def _draw_walls(steep: list[PlanarRegion], corner: Array, resolution: float, size: Array) -> NDArray[np.float32]:
    """Lowest and highest points of steep regions, (ny, nx, 2); empty where there are none."""
    walled = [region for region in steep if len(region.hull_region) >= 3]
    if not walled:
        return np.zeros((0, 0, 2), dtype=np.float32)
    R = np.array([region.T_world_region.R for region in walled])
    level = np.stack((-R[:, 1, 2], R[:, 0, 2], np.zeros(len(R))), axis=1)
    level /= np.linalg.norm(level, axis=1, keepdims=True)
    frames = np.stack((level, np.cross(R[:, :, 2], level), R[:, :, 2]), axis=2)
    turns = np.transpose(R[:, :, :2], (0, 2, 1)) @ frames[:, :, :2]
    outlines = [region.hull_region @ turn for region, turn in zip(walled, turns, strict=True)]
    origins = np.array([region.T_world_region.p for region in walled])
    nx, ny = (max(1, int(n)) for n in np.ceil(size / resolution))
    walls = np.empty((ny, nx, 2), dtype=np.float32)
    walls[:, :, 0], walls[:, :, 1] = np.inf, -np.inf
    starts = np.cumsum([0] + [len(outline) for outline in outlines])
    draw_walls(np.concatenate(outlines), starts, readonly(frames), origins, corner, resolution, walls)
    return walls


def sole_on_slope(x: float, y: float, z: float, yaw: float, a: float, b: float) -> Pose:
    """Sole at a point of a plane of slopes a = dz/dx, b = dz/dy; its x axis points along `yaw` when seen from above."""
    # Plain numbers: a plan makes many of these, and numpy takes ten times longer for three of them.
    c, s = cos(yaw), sin(yaw)
    rise, up = a * c + b * s, sqrt(a * a + b * b + 1.0)
    along = sqrt(1.0 + rise * rise)
    fx, fy, fz = c / along, s / along, rise / along
    ux, uy, uz = -a / up, -b / up, 1.0 / up
    lx, ly, lz = uy * fz - uz * fy, uz * fx - ux * fz, ux * fy - uy * fx
    return Pose(np.array(((fx, lx, ux), (fy, ly, uy), (fz, lz, uz))), np.array((x, y, z)))


def slopes(T_world_sole: Pose) -> tuple[float, float]:
    """Slopes dz/dx and dz/dy of a sole's plane."""
    nx, ny, nz = T_world_sole.R[:, 2]
    return float(-nx / nz), float(-ny / nz)


@lru_cache(maxsize=8)
def foothold_rules(parameters: FootstepParameters) -> tuple[NDArray[np.void], Array]:
    """The limits on a foothold as the kernels take them, one `SNAP_LIMITS`, and where the sole feels the ground."""
    samples = SoleSamples.of(parameters)
    derived = {"tilt_tangent": float(np.tan(parameters.tilt))}
    derived |= {name: getattr(samples, name) for name in ("under", "close", "cliff", "shin")}
    limits = pack(SNAP_LIMITS, parameters, derived)
    limits.flags.writeable = False
    return limits, samples.points_sole


def pack(layout: np.dtype[np.void], parameters: FootstepParameters, derived: dict[str, float]) -> NDArray[np.void]:
    """One record of a layout, from the parameters of the same names and from derived values."""
    names = layout.names or ()
    values = tuple(derived[name] if name in derived else getattr(parameters, name) for name in names)
    return np.array([values], dtype=layout)
