"""What the robot remembers of the ground: regions of recent frames, fused with the newest.

The camera looks ahead, so the ground under and behind the feet is known only from earlier frames. Frames are kept when
the camera has moved; the newest always counts. Regions are compared on a horizontal grid: an old one is dropped once
it is old, far, covered by newer ones, or seen differently by the newest frame. Where a foot stands on ground that no
frame has shown there must be ground under the sole; where the robot starts, before it has moved, the ground is assumed
to go on around the soles, because a first step must land between them and what the camera sees.
"""

from __future__ import annotations

from collections import Counter
from typing import NamedTuple

import numpy as np

from skills.footsteps.footstep import Side, Stance
from skills.geometry.camera import DepthImage
from skills.geometry.polygon import contains_points
from skills.geometry.pose import Pose
from skills.regions.height_grid import Cells, Comparison, HeightGrid, cells_of
from skills.regions.memory_parameters import MemoryParameters
from skills.regions.planar_region import PlanarRegion, PlanarRegions

EXPIRED, FAR, COVERED, CHANGED, VANISHED, TOO_MANY = "expired", "far", "covered", "changed", "vanished", "too many"


class RegionMemory:
    """Fuses the regions of each new frame with those of earlier ones."""

    def __init__(self, parameters: MemoryParameters | None = None) -> None:
        self.parameters = parameters or MemoryParameters()
        self._kept: tuple[_Remembered, ...] = ()
        self._T_world_key: Pose | None = None
        self._start: Stance | None = None
        self._dropped: tuple[tuple[str, int], ...] = ()

    @property
    def dropped(self) -> tuple[tuple[str, int], ...]:
        """How many old regions the last update dropped, by reason."""
        return self._dropped

    def reset(self) -> None:
        """Forget everything."""
        self._kept, self._T_world_key, self._start, self._dropped = (), None, None, ()

    def update(self, regions: PlanarRegions, stance: Stance, image: DepthImage) -> PlanarRegions:
        """The ground as known now, oldest region first.

        Args:
            regions: regions of the newest frame.
            stance: where the feet are.
            image: the newest frame; it tells where the camera is, and through which old regions it sees.
        """
        reasons: Counter[str] = Counter()
        is_key = self._is_key(image.T_world_camera)
        newest = tuple(_Remembered(region, cells_of(region, self.parameters.cell)) for region in regions.regions)
        kept = self._remember(newest, regions.time, stance, image, is_key, reasons)
        known = tuple(remembered.region for remembered in (*kept, *newest))
        unseen = [side for side in Side if not self._stands_on(stance.sole(side), known)]
        supports = tuple(self._support(side, stance, regions.time) for side in unseen)
        self._kept = kept
        if is_key:
            self._T_world_key, self._kept = image.T_world_camera, (*kept, *newest)
        self._dropped = tuple(sorted(reasons.items()))
        return PlanarRegions((*supports, *known), regions.time, regions.frame_id)

    def _remember(
        self,
        newest: tuple[_Remembered, ...],
        now: float,
        stance: Stance,
        image: DepthImage,
        is_key: bool,
        reasons: Counter[str],
    ) -> tuple[_Remembered, ...]:
        """The old regions that still hold; counts why the others do not."""
        grid = HeightGrid(stance.mid_feet, self.parameters.radius, self.parameters.cell)
        for remembered in newest:
            grid.paint(remembered.cells)
        grid.freeze()
        vanished = _seen_through([remembered.cells for remembered in self._kept], image, self.parameters.same_height)
        kept: list[_Remembered] = []
        for remembered, gone in zip(reversed(self._kept), reversed(vanished), strict=True):
            comparison = grid.compare(remembered.cells, self.parameters.same_height)
            reason = self._reason_to_forget(now - remembered.region.time, comparison, is_key, gone)
            if not reason and len(kept) + len(newest) >= self.parameters.regions_max:
                reason = TOO_MANY
            if reason:
                reasons[reason] += 1
            else:
                kept.append(remembered)
                grid.paint(remembered.cells)
        return tuple(reversed(kept))

    def _reason_to_forget(self, age: float, cells: Comparison, is_key: bool, gone: bool) -> str:
        parameters = self.parameters
        if age > parameters.age_max:
            return EXPIRED
        if cells.inside == 0:
            return FAR
        if cells.seen >= parameters.changed_share * cells.inside and cells.differing > 0.5 * cells.seen:
            return CHANGED
        if gone:
            return VANISHED
        # A frame that will not be kept replaces nothing: the next one may see less.
        if is_key and cells.covered >= parameters.covered_share * cells.inside:
            return COVERED
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

    def _support(self, side: Side, stance: Stance, time: float) -> PlanarRegion:
        """Ground assumed under a sole, and around it while the foot stands where it stood at the start."""
        p = self.parameters
        if self._start is None:
            self._start = stance
        moved = np.linalg.norm(stance.sole(side).p - self._start.sole(side).p) > p.same_height
        half = 0.5 * (1.0 if moved else p.start_support) * np.array((p.sole_length, p.sole_width))
        pad = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]) * half
        return PlanarRegion(stance.sole(side), pad, (pad,), float(4.0 * half[0] * half[1]), time)


class _Remembered(NamedTuple):
    """A region and its cells, which are found once."""

    region: PlanarRegion
    cells: Cells


def _seen_through(old: list[Cells], image: DepthImage, same_height: float) -> list[bool]:
    """For each old region, whether the newest image shows something clearly behind most of it."""
    if not old:
        return []
    camera = image.camera
    counts = np.array([len(cells.probes_world) for cells in old])
    points = image.T_world_camera.inverse @ np.concatenate([cells.probes_world for cells in old])
    ahead = np.maximum(points[:, 2], camera.near)
    u = np.round(points[:, 0] / ahead * camera.fx + camera.cx).astype(int)
    v = np.round(points[:, 1] / ahead * camera.fy + camera.cy).astype(int)
    in_view = (points[:, 2] > camera.near) & (u >= 0) & (u < camera.width) & (v >= 0) & (v < camera.height)
    measured = np.where(in_view, image.depth[np.where(in_view, v, 0), np.where(in_view, u, 0)], 0.0)
    # Where the old surface is seen at a slant, its error in height shows as a larger one in depth.
    behind = measured > points[:, 2] + 2.0 * same_height
    starts = np.concatenate(([0], np.cumsum(counts)[:-1]))
    seen, gone = (np.add.reduceat(flags.astype(int), starts) for flags in (measured > 0.0, behind))
    return (gone > np.maximum(0.5 * seen, 0.25 * counts)).tolist()
