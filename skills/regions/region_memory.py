"""What the robot remembers of the ground: regions of recent frames, fused with the newest.

The camera looks ahead, so the ground under and behind the feet is known only from earlier frames. Frames are kept when
the camera has moved; the newest always counts. Regions are compared on a horizontal grid: an old one is dropped once
it is old, far, covered by newer ones, or seen differently by the newest frame. Where a foot stands on ground that no
frame has shown, the ground is assumed to go on a little around its sole.
"""

from __future__ import annotations

from collections import Counter
from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from skills.footsteps.footstep import Side, Stance
from skills.geometry.camera import DepthImage
from skills.geometry.polygon import contains_points
from skills.geometry.pose import Array, Pose
from skills.regions.parameters import MemoryParameters
from skills.regions.planar_region import PlanarRegion, PlanarRegions

EXPIRED, FAR, COVERED, CHANGED, VANISHED, TOO_MANY = "expired", "far", "covered", "changed", "vanished", "too many"

_PROBES = 32  # points at which an old region is compared with the newest depth image


class RegionMemory:
    """Fuses the regions of each new frame with those of earlier ones."""

    def __init__(self, parameters: MemoryParameters | None = None) -> None:
        self.parameters = parameters or MemoryParameters()
        self._kept: tuple[PlanarRegion, ...] = ()
        self._T_world_key: Pose | None = None
        self._dropped: tuple[tuple[str, int], ...] = ()

    @property
    def dropped(self) -> tuple[tuple[str, int], ...]:
        """How many old regions the last update dropped, by reason."""
        return self._dropped

    def reset(self) -> None:
        """Forget everything."""
        self._kept, self._T_world_key, self._dropped = (), None, ()

    def update(self, regions: PlanarRegions, stance: Stance, image: DepthImage) -> PlanarRegions:
        """The ground as known now, oldest region first.

        Args:
            regions: regions of the newest frame.
            stance: where the feet are.
            image: the newest frame; it tells where the camera is, and through which old regions it sees.
        """
        reasons: Counter[str] = Counter()
        is_key = self._is_key(image.T_world_camera)
        kept = self._remember(regions, stance, image, is_key, reasons)
        known = (*kept, *regions.regions)
        unseen = [side for side in Side if not self._stands_on(stance.sole(side), known)]
        supports = tuple(self._support(stance.sole(side), regions.time) for side in unseen)
        self._kept = kept
        if is_key:
            self._T_world_key, self._kept = image.T_world_camera, known
        self._dropped = tuple(sorted(reasons.items()))
        return PlanarRegions((*supports, *known), regions.time, regions.frame_id)

    def _remember(
        self, newest: PlanarRegions, stance: Stance, image: DepthImage, is_key: bool, reasons: Counter[str]
    ) -> tuple[PlanarRegion, ...]:
        """The old regions that still hold; counts why the others do not."""
        grid = _HeightGrid(stance.mid_feet, self.parameters)
        for region in newest.regions:
            grid.paint(grid.footprint(region))
        grid.freeze()
        kept: list[PlanarRegion] = []
        for region in reversed(self._kept):
            footprint = grid.footprint(region)
            reason = self._reason_to_forget(region, newest.time, grid.compare(footprint), image)
            # A frame that will not be kept replaces nothing: the next one may see less.
            if reason == COVERED and not is_key:
                reason = ""
            if not reason and len(kept) + len(newest.regions) >= self.parameters.regions_max:
                reason = TOO_MANY
            if reason:
                reasons[reason] += 1
            else:
                kept.append(region)
                grid.paint(footprint)
        return tuple(reversed(kept))

    def _reason_to_forget(self, region: PlanarRegion, now: float, cells: _Comparison, image: DepthImage) -> str:
        parameters = self.parameters
        if now - region.time > parameters.age_max:
            return EXPIRED
        if cells.inside == 0:
            return FAR
        if cells.seen >= parameters.changed_share * cells.inside and cells.differing > 0.5 * cells.seen:
            return CHANGED
        if cells.covered >= parameters.covered_share * cells.inside:
            return COVERED
        if _seen_through(region, image, parameters):
            return VANISHED
        return ""

    def _is_key(self, T_world_camera: Pose) -> bool:
        if self._T_world_key is None:
            return True
        T_key_camera = self._T_world_key.inverse @ T_world_camera
        angle = np.arccos(np.clip(0.5 * (np.trace(T_key_camera.R) - 1.0), -1.0, 1.0))
        moved = np.linalg.norm(T_key_camera.p) >= self.parameters.key_distance
        return bool(moved or angle >= self.parameters.key_angle)

    def _stands_on(self, T_world_sole: Pose, known: tuple[PlanarRegion, ...]) -> bool:
        """Whether known ground is under the middle, toe, heel and sides of a sole."""
        p = self.parameters
        probes = (
            0.4 * np.array([(0, 0, 0), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)]) * (p.sole_length, p.sole_width, 0)
        )
        points = T_world_sole @ probes
        found = np.zeros(len(points), dtype=bool)
        for region in known:
            points_region = region.T_world_region.inverse @ points
            near = np.abs(points_region[:, 2]) <= p.same_height
            if near.any():
                found |= near & contains_points(region.hull_region, np.ascontiguousarray(points_region[:, :2]))
        return bool(found.all())

    def _support(self, T_world_sole: Pose, time: float) -> PlanarRegion:
        """Ground assumed under a sole."""
        p = self.parameters
        half = 0.5 * p.support_scale * np.array((p.sole_length, p.sole_width))
        pad = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]) * half
        return PlanarRegion(T_world_sole, pad, (pad,), float(4.0 * half[0] * half[1]), time)


class _Footprint(NamedTuple):
    """A window of the grid around a region, the region's cells in it, and its height in each."""

    window: tuple[slice, slice]
    mask: NDArray[np.bool_]
    heights: Array


class _Comparison(NamedTuple):
    """Cells of a region: all, covered by newer regions, seen by the newest frame, and seen there at another height."""

    inside: int
    covered: int
    seen: int
    differing: int


class _HeightGrid:
    """Heights of regions on a horizontal grid around the feet."""

    def __init__(self, middle: Array, parameters: MemoryParameters) -> None:
        self._cell = parameters.cell
        self._same_height = parameters.same_height
        size = int(np.ceil(2.0 * parameters.radius / parameters.cell))
        # Anchored to multiples of the cell, so that standing still changes nothing.
        self._corner = np.floor(middle[:2] / parameters.cell) * parameters.cell - parameters.radius
        self._height = np.full((size, size), np.nan)
        self._newest = self._height

    def freeze(self) -> None:
        """Take what was painted so far as the newest frame."""
        self._newest = self._height.copy()

    def paint(self, footprint: _Footprint) -> None:
        """Fill in a region where nothing newer is."""
        patch = self._height[footprint.window]
        empty = footprint.mask & np.isnan(patch)
        patch[empty] = footprint.heights[empty]

    def compare(self, footprint: _Footprint) -> _Comparison:
        """Hold a region against what is newer; cells next to a covered one count as covered, outlines being noisy."""
        window, mask, heights = footprint
        known = ~np.isnan(self._height[window])
        covered = (
            mask & cv2.dilate(known.astype(np.uint8), np.ones((3, 3), np.uint8)).astype(bool) if mask.size else mask
        )
        newest = self._newest[window]
        seen = mask & ~np.isnan(newest)
        differing = seen & (np.abs(newest - heights) > self._same_height)
        return _Comparison(*(int(np.count_nonzero(cells)) for cells in (mask, covered, seen, differing)))

    def footprint(self, region: PlanarRegion) -> _Footprint:
        """The region's cells, without those outside the grid."""
        n = len(self._height)
        rings = [(region.T_world_region.R[:2, :2] @ ring.T).T for ring in (region.hull_region, *region.holes_region)]
        offset = (region.T_world_region.p[:2] - self._corner) / self._cell - 0.5
        rings = [ring / self._cell + offset for ring in rings]
        low = np.clip(np.floor(rings[0].min(axis=0)).astype(int), 0, n)
        high = np.clip(np.ceil(rings[0].max(axis=0)).astype(int) + 1, low, n)
        mask = np.zeros((high[1] - low[1], high[0] - low[0]), np.uint8)
        if mask.size:
            cv2.fillPoly(
                mask, [np.round((ring - low) * 16).astype(np.int32).reshape(-1, 1, 2) for ring in rings], (1,), 8, 4
            )
        p, normal = region.T_world_region.p, region.normal_world
        x = self._corner[0] + (np.arange(low[0], high[0]) + 0.5) * self._cell - p[0]
        y = self._corner[1] + (np.arange(low[1], high[1]) + 0.5) * self._cell - p[1]
        heights = p[2] - (normal[0] * x[None, :] + normal[1] * y[:, None]) / normal[2]
        return _Footprint((slice(low[1], high[1]), slice(low[0], high[0])), mask.astype(bool), heights)


def _seen_through(region: PlanarRegion, image: DepthImage, parameters: MemoryParameters) -> bool:
    """Whether the newest image shows something clearly behind most of an old region that is in view."""
    camera = image.camera
    corners = np.concatenate(region.convex_parts_region)
    middles = np.array([part.mean(axis=0) for part in region.convex_parts_region])
    spread = np.concatenate(
        (middles, 0.5 * (corners + np.repeat(middles, [len(p) for p in region.convex_parts_region], 0)))
    )
    spread = spread[:: len(spread) // _PROBES + 1]
    points = image.T_world_camera.inverse @ (region.T_world_region @ np.column_stack((spread, np.zeros(len(spread)))))
    points = points[points[:, 2] > camera.near]
    u = np.round(points[:, 0] / points[:, 2] * camera.fx + camera.cx).astype(int)
    v = np.round(points[:, 1] / points[:, 2] * camera.fy + camera.cy).astype(int)
    in_view = (u >= 0) & (u < camera.width) & (v >= 0) & (v < camera.height)
    measured = image.depth[v[in_view], u[in_view]]
    expected = points[in_view, 2]
    valid = measured > 0.0
    behind = valid & (measured > expected + 2.0 * parameters.same_height)
    return bool(np.count_nonzero(behind) > max(0.5 * np.count_nonzero(valid), 0.25 * len(spread)))
