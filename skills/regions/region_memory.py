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
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Protocol

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
from skills.regions.registration import Corrections, Drift, camera_to_correct, register
from skills.regions.registration_parameters import RegistrationParameters

_SPARSE = 8  # Whether a frame has depth at all is seen on one pixel of so many each way.


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
    start: Stance | None = None
    reference: HeightReference | None = None
    cameras: Mapping[str, CameraMemory] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, eq=False)
class CameraMemory:
    """What is remembered of one camera.

    Attributes:
        drift: how its newest frame lay to the ground; None before its first.
        T_world_key: where it was when it took the newest of its frames that are kept; None before the first.
        error: what of its error has been made good.
        since: what frames of other cameras have corrected since its newest.
    """

    drift: Drift | None = None
    T_world_key: Pose | None = None
    error: CameraError = NO_ERROR
    since: Corrections = field(default_factory=Corrections)


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
    camera = memory.cameras.get(image.camera_name, CameraMemory())
    if camera.error is not NO_ERROR:
        regions = camera.error.regions_corrected(regions, image.T_world_camera)
        image = camera.error.image_corrected(image)
    if memory.T_world_map is not IDENTITY:
        T_map_world = memory.T_world_map.inverse
        regions, stance, image = regions.moved(T_map_world), stance.moved(T_map_world), image.moved(T_map_world)
    drift = register(
        regions, image, memory.reference, camera.drift, camera.since, camera.error, parameters.registration
    )
    T = drift.T_world_frame
    if T is not IDENTITY:
        regions, stance, image = regions.moved(T), stance.moved(T), image.moved(T)
    joined = _slid(_Frame(memory, regions, stance, image, parameters).joined(drift), drift)
    joined = replace(joined, cameras=_after(joined.cameras, image.camera_name, drift))
    error = camera_to_correct(drift, parameters.registration)
    return joined if error is None else _put_right(joined, image, error, parameters)


def _after(cameras: Mapping[str, CameraMemory], name: str, drift: Drift) -> Mapping[str, CameraMemory]:
    """What is remembered of all cameras after a frame of one of them."""
    others = {other: replace(camera, since=camera.since.then(drift)) for other, camera in cameras.items()}
    camera = cameras.get(name, CameraMemory())
    return {**others, name: CameraMemory(drift, camera.T_world_key, camera.error)}


def _put_right(memory: RegionMemory, image: DepthImage, error: CameraError, parameters: MapParameters) -> RegionMemory:
    """The map as it would be had a camera's error been made good all along; the ground follows with the next frame.

    Its frames have been brought onto its newest, so what is wrong with all of them is what is wrong with the camera.
    """
    name, T_map_camera = image.camera_name, image.T_world_camera
    camera, cell = memory.cameras[name], parameters.registration.cell
    left = error.less(camera.error)
    regions = tuple(
        left.region_corrected(remembered.region, T_map_camera) if remembered.camera == name else remembered.region
        for remembered in memory.kept
    )
    cells = cells_of(regions, cell)
    kept = tuple(
        replace(remembered, region=region, cells=cells.of(k))
        for k, (region, remembered) in enumerate(zip(regions, memory.kept, strict=True))
    )
    lasting = Cells.joined([remembered.cells for remembered in kept if not remembered.passing])
    reference = updated(None, lasting, T_map_camera.p, parameters.registration)
    cameras = {**memory.cameras, name: replace(camera, error=error)}
    return replace(memory, kept=kept, reference=reference, cameras=cameras)


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
        self._camera = memory.cameras.get(image.camera_name, CameraMemory())
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
        # A frame without depth makes nothing known newer.
        is_blind = not self._regions.regions and not (self._image.depth[::_SPARSE, ::_SPARSE] > 0.0).any()
        shown = self._memory.ground if is_blind and self._memory.ground is not None else self._regions
        ground = PlanarRegions((*supports, *known), shown.time, shown.frame_id)
        change = GroundUpdate(forgotten, drift, self._image.T_world_odometry)
        memory = replace(self._memory, ground=ground, update=change, kept=kept, start=self._start)
        name, passing = self._image.camera_name, not self._is_key
        fresh = (Remembered(r, newest.of(i), name, passing) for i, r in enumerate(self._regions.regions))
        memory = replace(memory, kept=(*kept, *fresh))
        if passing:
            return memory
        T_world_camera = self._image.T_world_camera
        reference = updated(self._memory.reference, newest, T_world_camera.p, registration)
        cameras = {**memory.cameras, name: replace(self._camera, T_world_key=T_world_camera)}
        return replace(memory, cameras=cameras, reference=reference)

    def _remember(self, newest: Cells) -> tuple[tuple[Remembered, ...], tuple[Forgotten, ...]]:
        """The old regions that still hold, and the others."""
        name, cell = self._image.camera_name, self._all_parameters.registration.cell
        old = [remembered for remembered in self._memory.kept if not remembered.passed_with(name)]
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
        """Whether the camera has moved since the last of its frames that was kept."""
        if self._camera.T_world_key is None:
            return True
        T_key_camera = self._camera.T_world_key.inverse @ T_world_camera
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


@dataclass(frozen=True, slots=True, eq=False)
class Remembered:
    """A region that is in the map.

    Attributes:
        region: the region.
        cells: what it covers, which is found once.
        camera: which camera has seen it.
        passing: whether it goes with the camera's next frame, because its own is not kept.
    """

    region: PlanarRegion
    cells: Cells
    camera: str
    passing: bool

    def passed_with(self, camera: str) -> bool:
        """Whether it is gone when this camera has taken another frame."""
        return self.passing and self.camera == camera
