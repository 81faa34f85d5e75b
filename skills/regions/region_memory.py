"""What the robot remembers of the ground: regions of recent frames, fused with the newest.

The camera looks ahead, so the ground under and behind the feet is known only from earlier frames. Each frame is brought
onto the ground known before, which takes the drift of the robot's estimate out; frames are kept when the camera has
moved, and the newest always counts. Regions are compared on a horizontal grid: an old one is dropped once it is old,
far, covered by newer ones, or seen differently by the newest frame. Where a foot stands on ground that no frame has
shown there must be ground under the sole; where the robot starts, before it has moved, the ground is assumed to go on
around the soles, because a first step must land between them and what the camera sees.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass, replace
from typing import NamedTuple, Protocol

import numpy as np

from skills.footsteps.footstep import Side, Stance
from skills.geometry.camera import DepthImage
from skills.geometry.polygon import contains_points
from skills.geometry.pose import IDENTITY, Pose
from skills.regions.height_grid import Cells, Comparison, HeightGrid, cells_of
from skills.regions.height_reference import HeightReference, updated
from skills.regions.memory_parameters import MemoryParameters
from skills.regions.planar_region import PlanarRegion, PlanarRegions
from skills.regions.registration import Drift, register
from skills.regions.registration_parameters import RegistrationParameters

EXPIRED, FAR, COVERED, CHANGED, VANISHED, TOO_MANY = (
    "too old",
    "too far",
    "covered by newer ones",
    "seen differently",
    "seen through",
    "too many",
)


@dataclass(frozen=True, slots=True, eq=False)
class Forgotten:
    """A region that is no longer in the map.

    Attributes:
        region: the region.
        reason: why, as a short phrase for the operator.
    """

    region: PlanarRegion
    reason: str


@dataclass(frozen=True, slots=True, eq=False)
class GroundUpdate:
    """What one frame has changed in the map.

    Attributes:
        forgotten: regions that were dropped, newest first.
        drift: how the frame lay to the ground known before.
        T_world_odometry: what takes the robot's estimates into the world since then.
    """

    forgotten: tuple[Forgotten, ...]
    drift: Drift
    T_world_odometry: Pose

    @property
    def reasons(self) -> tuple[tuple[str, int], ...]:
        """How many regions were dropped, by reason."""
        return tuple(sorted(Counter(forgotten.reason for forgotten in self.forgotten).items()))

    @property
    def summary(self) -> str:
        """What has changed, in one line for the operator."""
        forgotten = ", ".join(f"{count} {reason}" for reason, count in self.reasons)
        drift = self.drift.reason or f"estimate corrected by {1e3 * np.linalg.norm(self.drift.shift_turn[:3]):.0f} mm"
        return f"{drift}; forgot {forgotten}" if forgotten else drift


@dataclass(frozen=True, slots=True, eq=False)
class RegionMemory:
    """The map after a frame, and what is needed to join the next.

    Attributes:
        ground: the ground as known now, oldest region first; None before the first frame.
        update: what the newest frame has changed; None before the first frame.
    """

    ground: PlanarRegions | None = None
    update: GroundUpdate | None = None
    kept: tuple[Remembered, ...] = ()
    T_world_key: Pose | None = None
    start: Stance | None = None
    reference: HeightReference | None = None


class Sole(Protocol):
    """Whatever knows the size of a sole."""

    @property
    def sole_length(self) -> float:
        """From heel to toe [m]."""
        ...

    @property
    def sole_width(self) -> float:
        """From side to side [m]."""
        ...


@dataclass(frozen=True, slots=True)
class MapParameters:
    """All numbers behind the map.

    Attributes:
        memory: what is remembered.
        registration: how drift is found.
        sole_length, sole_width: size of a sole [m].
    """

    memory: MemoryParameters
    registration: RegistrationParameters
    sole_length: float
    sole_width: float

    @classmethod
    def of(cls, memory: MemoryParameters, registration: RegistrationParameters, sole: Sole) -> MapParameters:
        """The numbers of two subjects, and the sole's size from whatever knows it."""
        return cls(memory, registration, sole.sole_length, sole.sole_width)


def remember(
    memory: RegionMemory, regions: PlanarRegions, stance: Stance, image: DepthImage, parameters: MapParameters
) -> RegionMemory:
    """Join a frame to the map.

    Args:
        memory: the map before.
        regions: regions of the frame.
        stance: where the feet are, as estimated like the frame's poses.
        image: the frame; it tells where the camera is, and through which old regions it sees.
        parameters: numbers.
    """
    before = None if memory.update is None else memory.update.drift
    drift = register(regions, image, memory.reference, before, parameters.registration)
    T = drift.T_world_frame
    if T is not IDENTITY:
        regions, stance, image = regions.moved(T), stance.moved(T), image.moved(T)
    return _Frame(memory, regions, stance, image, parameters).joined(drift)


class _Frame:
    """One frame that joins a map."""

    def __init__(
        self,
        memory: RegionMemory,
        regions: PlanarRegions,
        stance: Stance,
        image: DepthImage,
        parameters: MapParameters,
    ) -> None:
        self._memory, self._regions, self._stance, self._image = memory, regions, stance, image
        self._parameters = parameters.memory
        self._all_parameters = parameters
        self._start = memory.start or stance
        self._is_key = self._moved_on(image.T_world_camera)

    def joined(self, drift: Drift) -> RegionMemory:
        """The map with this frame in it."""
        now, cell = self._regions.time, self._parameters.cell
        newest = tuple(Remembered(region, cells_of(region, cell)) for region in self._regions.regions)
        kept, forgotten = self._remember(newest)
        known = tuple(remembered.region for remembered in (*kept, *newest))
        unseen = [side for side in Side if not self._stands_on(self._stance.sole(side), known)]
        supports = tuple(self._support(side, now) for side in unseen)
        ground = PlanarRegions((*supports, *known), now, self._regions.frame_id)
        change = GroundUpdate(forgotten, drift, self._image.T_world_odometry)
        memory = replace(self._memory, ground=ground, update=change, kept=kept, start=self._start)
        if not self._is_key:
            return memory
        T_world_camera, registration = self._image.T_world_camera, self._all_parameters.registration
        reference = updated(self._memory.reference, self._regions, T_world_camera, registration)
        return replace(memory, kept=(*kept, *newest), T_world_key=T_world_camera, reference=reference)

    def _remember(self, newest: tuple[Remembered, ...]) -> tuple[tuple[Remembered, ...], tuple[Forgotten, ...]]:
        """The old regions that still hold, and the others."""
        parameters, old = self._parameters, self._memory.kept
        grid = HeightGrid(self._stance.mid_feet, parameters.radius, parameters.cell)
        for remembered in newest:
            grid.paint(remembered.cells)
        grid.freeze()
        vanished = _seen_through([remembered.cells for remembered in old], self._image, parameters.same_height)
        kept: list[Remembered] = []
        forgotten: list[Forgotten] = []
        for remembered, gone in zip(reversed(old), reversed(vanished), strict=True):
            comparison = grid.compare(remembered.cells, parameters.same_height)
            reason = self._reason_to_forget(remembered.region, comparison, gone)
            if not reason and len(kept) + len(newest) >= parameters.regions_max:
                reason = TOO_MANY
            if reason:
                forgotten.append(Forgotten(remembered.region, reason))
            else:
                kept.append(remembered)
                grid.paint(remembered.cells)
        return tuple(reversed(kept)), tuple(forgotten)

    def _reason_to_forget(self, region: PlanarRegion, cells: Comparison, gone: bool) -> str:
        parameters = self._parameters
        if self._regions.time - region.time > parameters.age_max:
            return EXPIRED
        if cells.inside == 0:
            return FAR
        if cells.seen >= parameters.changed_share * cells.inside and cells.differing > 0.5 * cells.seen:
            return CHANGED
        if gone:
            return VANISHED
        # A frame that will not be kept replaces nothing: the next one may see less.
        if self._is_key and cells.covered >= parameters.covered_share * cells.inside:
            return COVERED
        return ""

    def _moved_on(self, T_world_camera: Pose) -> bool:
        """Whether the camera has moved since the last frame that was kept."""
        if self._memory.T_world_key is None:
            return True
        T_key_camera = self._memory.T_world_key.inverse @ T_world_camera
        angle = np.arccos(np.clip(0.5 * (np.trace(T_key_camera.R) - 1.0), -1.0, 1.0))
        moved = np.linalg.norm(T_key_camera.p) >= self._parameters.key_distance
        return bool(moved or angle >= self._parameters.key_angle)

    def _stands_on(self, T_world_sole: Pose, known: tuple[PlanarRegion, ...]) -> bool:
        """Whether known ground is under the middle, toe, heel and sides of a sole."""
        probes = np.array([(0, 0, 0), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)])
        points = T_world_sole @ (0.4 * probes * (*self._sole, 0.0))
        found = np.zeros(len(points), dtype=bool)
        for region in known:
            points_region = region.T_world_region.inverse @ points
            near = np.abs(points_region[:, 2]) <= self._parameters.same_height
            if near.any():
                found |= near & contains_points(region.hull_region, np.ascontiguousarray(points_region[:, :2]))
        return bool(found.all())

    def _support(self, side: Side, time: float) -> PlanarRegion:
        """Ground assumed under a sole, and around it while the foot stands where it stood at the start."""
        parameters, T_world_sole = self._parameters, self._stance.sole(side)
        moved = np.linalg.norm(T_world_sole.p - self._start.sole(side).p) > parameters.same_height
        half = 0.5 * (1.0 if moved else parameters.start_support) * np.array(self._sole)
        pad = np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]) * half
        return PlanarRegion(T_world_sole, pad, (pad,), float(4.0 * half[0] * half[1]), time)

    @property
    def _sole(self) -> tuple[float, float]:
        return self._all_parameters.sole_length, self._all_parameters.sole_width


class Remembered(NamedTuple):
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
