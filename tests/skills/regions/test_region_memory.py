import numpy as np
import pytest
from block_fields import L515, block, camera_pose, look

from skills.footsteps.footstep import Stance
from skills.geometry.camera import DepthImage
from skills.geometry.polygon import contains_points
from skills.geometry.pose import Pose
from skills.regions import (
    MapParameters,
    MemoryParameters,
    PlanarRegion,
    PlanarRegions,
    RegionMemory,
    RegistrationParameters,
    extract_regions,
    remember,
)

CAMERA = L515.scaled(0.3125)
SOLE_LENGTH, SOLE_WIDTH = 0.26, 0.138


class Map:
    """A map whose frames are taken as they come, unless it is told to look for drift."""

    def __init__(
        self, memory: MemoryParameters | None = None, registration: RegistrationParameters | None = None
    ) -> None:
        still = registration or RegistrationParameters(overlap_min=1.0)
        self._parameters = MapParameters(memory or MemoryParameters(), still, SOLE_LENGTH, SOLE_WIDTH)
        self._memory = RegionMemory()

    def update(self, regions: PlanarRegions, stance: Stance, image: DepthImage) -> PlanarRegions:
        self._memory = remember(self._memory, regions, stance, image, self._parameters)
        assert self._memory.ground is not None
        return self._memory.ground

    @property
    def dropped(self) -> tuple[tuple[str, int], ...]:
        assert self._memory.update is not None
        return self._memory.update.reasons


def pad(x: float, y: float, z: float, size=0.4, time=0.0, pitch=0.0) -> PlanarRegion:
    half = 0.5 * size
    square = np.array([(-half, -half), (half, -half), (half, half), (-half, half)])
    pose = Pose.from_xyz_rpy((x, y, z), (0.0, pitch, 0.0))
    return PlanarRegion(pose, square, (square,), size * size, time)


def frame(time: float, *regions: PlanarRegion) -> PlanarRegions:
    return PlanarRegions(regions, time, round(10 * time))


def stance(x: float, z: float = 0.0) -> Stance:
    return Stance(Pose.from_xyz_rpy((x, 0.12, z)), Pose.from_xyz_rpy((x, -0.12, z)))


def blind(x: float, time: float = 0.0) -> DepthImage:
    depth = np.zeros((CAMERA.height, CAMERA.width), np.float32)
    return DepthImage(depth, CAMERA, camera_pose(x), time, round(10 * time))


def newest_height(regions: PlanarRegions, x: float, y: float) -> float:
    """Height of the last region over a place, as a raster that paints in order would have it."""
    height = np.nan
    for region in regions.regions:
        T, n = region.T_world_region, region.normal_world
        z = T.p[2] - (n[0] * (x - T.p[0]) + n[1] * (y - T.p[1])) / n[2]
        if contains_points(region.hull_region, (T.inverse @ np.array((x, y, z)))[None, :2].copy())[0]:
            height = z
    return height


def test_ground_that_was_seen_ahead_is_known_when_the_feet_reach_it():
    memory = Map()
    floor = [block(2.0, 0.0, 0.0, size=(8.0, 2.0, 0.1))]
    seen = known = frame(0.0)
    for k in range(12):
        x = 0.1 * k
        image = look(floor, camera_pose(x), CAMERA, time=0.2 * k, frame_id=k).image
        seen = extract_regions(image)
        known = memory.update(seen, stance(x), image)
    assert np.isnan(newest_height(seen, 1.1, 0.12))
    for x in (1.0, 1.1, 1.3):
        assert newest_height(known, x, 0.12) == pytest.approx(0.0, abs=0.005)


def test_the_newest_frame_comes_last():
    memory = Map()
    memory.update(frame(0.0, pad(0.8, 0.0, 0.0)), stance(0.0), blind(0.0))
    new = pad(1.0, 0.0, 0.005, time=0.5)
    known = memory.update(frame(0.5, new), stance(0.0), blind(0.3))
    assert known.regions[-1] is new
    assert (known.time, known.frame_id) == (0.5, 5)


def test_old_regions_expire_with_a_reason():
    memory = Map()
    memory.update(frame(0.0, pad(0.5, 0.0, 0.0)), stance(0.0), blind(0.0))
    kept = memory.update(frame(7.9), stance(0.0), blind(0.5))
    assert np.isfinite(newest_height(kept, 0.5, 0.0)) and memory.dropped == ()
    gone = memory.update(frame(8.1), stance(0.0), blind(0.5))
    assert np.isnan(newest_height(gone, 0.5, 0.0)) and memory.dropped == (("too old", 1),)


def test_regions_far_from_the_feet_are_dropped():
    memory = Map()
    memory.update(frame(0.0, pad(0.5, 0.0, 0.0)), stance(0.0), blind(0.0))
    memory.update(frame(1.0), stance(3.0), blind(3.0))
    assert memory.dropped == (("too far", 1),)


def test_ground_seen_differently_replaces_the_old():
    memory = Map()
    memory.update(frame(0.0, pad(0.5, 0.0, 0.0)), stance(0.0), blind(0.0))
    known = memory.update(frame(1.0, pad(0.6, 0.0, -0.05, time=1.0)), stance(0.0), blind(0.0))
    assert memory.dropped == (("seen differently", 1),)
    assert newest_height(known, 0.5, 0.0) == pytest.approx(-0.05)
    # What is left there is the ground assumed around the feet, not the old region.
    assert all(region.time == 1.0 for region in known.regions)


def test_a_block_that_the_camera_now_sees_through_is_forgotten():
    memory = Map()
    pillar = block(0.8, 0.0, 0.2, size=(0.3, 0.3, 0.2))
    floor = block(0.8, 0.0, 0.0, size=(3.0, 2.0, 0.1))
    image = look([floor, pillar], camera_pose(0.0), CAMERA).image
    known = memory.update(extract_regions(image), stance(0.0), image)
    assert newest_height(known, 0.8, 0.0) == pytest.approx(0.2, abs=0.01)
    # The floor where the block stood returns no depth, but the floor behind it does.
    image = look([floor], camera_pose(0.0), CAMERA, time=1.0).image
    known = memory.update(PlanarRegions((), 1.0, 1), stance(0.0), image)
    assert dict(memory.dropped)["seen through"] == 1
    assert newest_height(known, 0.8, 0.0) == pytest.approx(0.0, abs=0.01)


@pytest.mark.parametrize("drift", [RegistrationParameters(overlap_min=1.0), RegistrationParameters()])
def test_blocks_that_vanish_over_a_pit_appear_or_move_are_so_in_the_map_within_three_frames(drift):
    pad = block(-0.3, 0.0, 0.0, size=(1.4, 1.4, 0.6))
    rows = [block(0.6 + 0.4 * k, y, 0.05 * k, size=(0.38, 0.38, 0.6)) for k in range(4) for y in (-0.4, 0.0, 0.4)]
    vanishing, moving, appearing = rows[4], rows[6], block(1.0, 0.4, 0.2, size=(0.38, 0.38, 0.6))
    memory, frame_id = Map(registration=drift), 0
    after = [box for box in rows if box not in (vanishing, moving)]
    after += [appearing, block(1.35, -0.4, 0.2, size=(0.38, 0.38, 0.6))]
    known = frame(0.0)
    for boxes, frames in ((rows, 4), (after, 3)):
        for _ in range(frames):
            image = look([pad, *boxes], camera_pose(0.0), CAMERA, time=0.1 * frame_id, frame_id=frame_id).image
            known = memory.update(extract_regions(image), stance(-0.2), image)
            frame_id += 1
    assert np.isnan(newest_height(known, 1.0, 0.0)), "nothing is left over the pit"
    assert newest_height(known, 1.0, 0.4) == pytest.approx(0.2, abs=0.01)
    assert newest_height(known, 1.35, -0.4) == pytest.approx(0.2, abs=0.01)
    for x in (0.6, 1.8):
        assert newest_height(known, x, 0.0) == pytest.approx(0.125 * (x - 0.6), abs=0.01), "the rest stays as it was"


def test_a_camera_that_sees_nothing_makes_nothing_vanish():
    memory = Map()
    memory.update(frame(0.0, pad(1.0, 0.0, 0.0)), stance(0.0), blind(0.0))
    memory.update(frame(0.1), stance(0.0), blind(0.0))
    assert memory.dropped == ()


def test_ground_that_is_only_hidden_is_remembered():
    memory = Map()
    floor, wall = block(0.8, 0.0, 0.0, size=(3.0, 2.0, 0.1)), block(0.5, 0.0, 0.6, size=(0.1, 2.0, 0.7))
    image = look([floor], camera_pose(0.0), CAMERA).image
    memory.update(extract_regions(image), stance(0.0), image)
    hidden = look([floor, wall], camera_pose(0.0), CAMERA, time=1.0).image
    known = memory.update(PlanarRegions((), 1.0, 1), stance(0.0), hidden)
    assert newest_height(known, 1.0, 0.0) == pytest.approx(0.0, abs=0.01)


def test_memory_stays_bounded():
    memory, floor = Map(), block(5.0, 0.0, 0.0, size=(16.0, 2.0, 0.1))
    for k in range(60):
        x = 0.1 * k
        image = look([floor], camera_pose(x), CAMERA, time=0.1 * k, frame_id=k).image
        known = memory.update(extract_regions(image), stance(x), image)
        assert len(known.regions) <= 25
    few = Map(MemoryParameters(regions_max=3))
    for k in range(10):
        known = few.update(frame(0.1 * k, pad(0.2 * k, 0.8, 0.0, 0.15, 0.1 * k)), stance(0.2 * k, 5.0), blind(0.2 * k))
        assert len(known.regions) <= 3 + 2
    assert dict(few.dropped)["too many"] == 1


def test_frames_without_motion_replace_each_other():
    memory, known = Map(), frame(0.0)
    for k in range(20):
        known = memory.update(frame(0.1 * k, pad(0.8, 0.0, 0.0, time=0.1 * k)), stance(0.0), blind(0.0))
    assert len(known.regions) <= 2 + 2


def test_unseen_feet_stand_on_assumed_ground_that_goes_on_around_them_at_the_start():
    feet = Stance(Pose.from_xyz_rpy((0.0, 0.12, 0.3), (0.0, 0.2, 0.5)), Pose.from_xyz_rpy((0.0, -0.12, 0.25)))
    memory, parameters = Map(), MemoryParameters()
    left, right = memory.update(frame(0.0), feet, blind(0.0)).regions
    np.testing.assert_array_equal(left.T_world_region.p, feet.T_world_left.p)
    np.testing.assert_array_equal(left.normal_world, feet.T_world_left.R[:, 2])
    assert np.ptp(right.hull_region[:, 0]) == pytest.approx(parameters.start_support * SOLE_LENGTH)

    moved = Stance(feet.T_world_left, Pose.from_xyz_rpy((0.4, -0.12, 0.25)))
    left, right = memory.update(frame(1.0), moved, blind(0.0)).regions
    assert np.ptp(left.hull_region[:, 0]) == pytest.approx(parameters.start_support * SOLE_LENGTH)
    assert np.ptp(right.hull_region[:, 0]) == pytest.approx(SOLE_LENGTH)
    assert np.ptp(right.hull_region[:, 1]) == pytest.approx(SOLE_WIDTH)


def test_seen_feet_need_no_assumed_ground():
    seen = pad(0.0, 0.0, 0.0, size=1.0)
    assert Map().update(frame(0.0, seen), stance(0.0), blind(0.0)).regions == (seen,)
    below = Map().update(frame(0.0, seen), stance(0.0, z=0.3), blind(0.0))
    assert len(below.regions) == 3 and below.regions[-1] is seen
