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
from skills.geometry.pose import IDENTITY, Pose
from skills.regions.camera_error import NO_ERROR, CameraError
from skills.regions.forgetting import REASONS, judge_regions
from skills.regions.height_reference import HeightReference, updated
from skills.regions.memory_parameters import MemoryParameters
from skills.regions.planar_region import PlanarRegion, PlanarRegions
from skills.regions.region_cells import Cells, Window, cells_of, hold
from skills.regions.registration import Drift, camera_to_correct, register
from skills.regions.registration_parameters import RegistrationParameters


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
    T_world_map: Pose = IDENTITY
    T_world_key: Pose | None = None
    start: Stance | None = None
    reference: HeightReference | None = None
    camera_error: CameraError = NO_ERROR


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
    if memory.camera_error is not NO_ERROR:
        regions = memory.camera_error.regions_corrected(regions, image.T_world_camera)
        image = memory.camera_error.image_corrected(image)
    if memory.T_world_map is not IDENTITY:
        T_map_world = memory.T_world_map.inverse
        regions, stance, image = regions.moved(T_map_world), stance.moved(T_map_world), image.moved(T_map_world)
    before = None if memory.update is None else memory.update.drift
    drift = register(regions, image, memory.reference, before, memory.camera_error, parameters.registration)
    T = drift.T_world_frame
    if T is not IDENTITY:
        regions, stance, image = regions.moved(T), stance.moved(T), image.moved(T)
    joined = _slid(_Frame(memory, regions, stance, image, parameters).joined(drift), drift)
    error = camera_to_correct(drift, parameters.registration)
    return joined if error is None else _put_right(joined, image.T_world_camera, error, parameters)


def _put_right(memory: RegionMemory, T_map_camera: Pose, error: CameraError, parameters: MapParameters) -> RegionMemory:
    """The map as it would be had the camera's error been made good all along; the ground follows with the next frame.

    Frames have been brought onto the newest, so what is wrong with all of them is what is wrong with its camera.
    """
    left, cell = error.less(memory.camera_error), parameters.registration.cell
    regions = tuple(left.region_corrected(remembered.region, T_map_camera) for remembered in memory.kept)
    cells = cells_of(regions, cell)
    kept = tuple(Remembered(region, cells.of(k)) for k, region in enumerate(regions))
    reference = updated(None, cells, T_map_camera.p, parameters.registration)
    return replace(memory, kept=kept, reference=reference, camera_error=error)


def _slid(memory: RegionMemory, drift: Drift) -> RegionMemory:
    """The map where its camera sees it now.

    Frames of a camera that is mounted askew agree only in a map that slides along with the walk. The robot does not.
    """
    T_world_map = memory.T_world_map
    if drift.apparent_world.any():
        T_world_map = Pose(np.eye(3), T_world_map.p - drift.apparent_world)
    if T_world_map is IDENTITY or memory.ground is None or memory.update is None:
        return memory
    update = replace(memory.update, T_world_odometry=T_world_map @ memory.update.T_world_odometry)
    return replace(memory, ground=memory.ground.moved(T_world_map), update=update, T_world_map=T_world_map)


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
        now, registration = self._regions.time, self._all_parameters.registration
        newest = cells_of(self._regions.regions, registration.cell)
        kept, forgotten = self._remember(newest)
        known = (*(remembered.region for remembered in kept), *self._regions.regions)
        unseen = self._unseen(Cells.joined([*(remembered.cells for remembered in kept), newest]))
        supports = tuple(self._support(side, now) for side in unseen)
        ground = PlanarRegions((*supports, *known), now, self._regions.frame_id)
        change = GroundUpdate(forgotten, drift, self._image.T_world_odometry)
        memory = replace(self._memory, ground=ground, update=change, kept=kept, start=self._start)
        if not self._is_key:
            return memory
        T_world_camera = self._image.T_world_camera
        fresh = tuple(Remembered(region, newest.of(i)) for i, region in enumerate(self._regions.regions))
        reference = updated(self._memory.reference, newest, T_world_camera.p, registration)
        return replace(memory, kept=(*kept, *fresh), T_world_key=T_world_camera, reference=reference)

    def _remember(self, newest: Cells) -> tuple[tuple[Remembered, ...], tuple[Forgotten, ...]]:
        """The old regions that still hold, and the others."""
        old, cell = self._memory.kept, self._all_parameters.registration.cell
        reasons = judge_regions(
            Cells.joined([remembered.cells for remembered in old]),
            newest,
            np.array([self._regions.time - remembered.region.time for remembered in old]),
            self._image,
            Window.around(self._stance.mid_feet, self._parameters.radius, cell),
            self._is_key,
            self._parameters,
        )
        judged = tuple(zip(old, reasons, strict=True))
        forgotten = tuple(Forgotten(remembered.region, REASONS[reason]) for remembered, reason in judged if reason)
        return tuple(remembered for remembered, reason in judged if not reason), forgotten

    def _moved_on(self, T_world_camera: Pose) -> bool:
        """Whether the camera has moved since the last frame that was kept."""
        if self._memory.T_world_key is None:
            return True
        T_key_camera = self._memory.T_world_key.inverse @ T_world_camera
        angle = np.arccos(np.clip(0.5 * (np.trace(T_key_camera.R) - 1.0), -1.0, 1.0))
        moved = np.linalg.norm(T_key_camera.p) >= self._parameters.key_distance
        return bool(moved or angle >= self._parameters.key_angle)

    def _unseen(self, known: Cells) -> list[Side]:
        """The feet that have no known ground under the middle, toe, heel and sides of the sole."""
        probes = np.array([(0, 0, 0), (1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0)]) * (*self._sole, 0.0)
        points = np.concatenate([self._stance.sole(side) @ (0.4 * probes) for side in Side])
        found = hold(known, points, self._all_parameters.registration.cell, self._parameters.same_height)
        return [side for side, on in zip(Side, found.reshape(2, -1), strict=True) if not on.all()]

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
