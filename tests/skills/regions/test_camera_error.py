"""What a camera that sits askew and measures too long has seen is put right."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from block_fields import L515, block, camera_pose, look

from skills.footsteps.footstep import Stance
from skills.geometry import DepthImage, Pose
from skills.geometry.pose import rotation_about
from skills.regions import (
    MapParameters,
    MemoryParameters,
    PlanarRegions,
    RegionMemory,
    RegistrationParameters,
    extract_regions,
    remember,
)
from skills.regions.apparent_motion import ApparentMotion
from skills.regions.camera_error import NO_ERROR, CameraError

ERROR = CameraError(np.deg2rad((1.2, -0.8, 1.5)), 0.01)
FIELD = [block(1.0, 0.0, 0.0, size=(4.0, 3.0, 0.1)), block(1.1, 0.1, 0.2, size=(0.5, 0.5, 0.2), yaw=0.4, pitch=0.2)]


def seen_askew() -> tuple[DepthImage, DepthImage]:
    """An image with the error, and the same without."""
    true = look(FIELD, camera_pose(0.0), L515.scaled(0.5)).image
    T = true.T_world_camera
    believed = Pose(T.R @ rotation_about(ERROR.mount_camera), T.p)
    return replace(true, depth=true.depth * np.float32(1.01), T_world_camera=believed), true


def planes(regions: PlanarRegions) -> np.ndarray:
    """Normal and offset of each region."""
    poses = [region.T_world_region for region in regions.regions]
    return np.array([(*T.R[:, 2], T.R[:, 2] @ T.p) for T in poses])


def test_an_image_put_right_is_the_true_one():
    askew, true = seen_askew()
    right = ERROR.image_corrected(askew)
    np.testing.assert_allclose(right.depth, true.depth, rtol=1e-6)
    np.testing.assert_allclose(right.T_world_camera.R, true.T_world_camera.R, atol=1e-12)
    np.testing.assert_array_equal(right.T_world_camera.p, true.T_world_camera.p)


def test_regions_put_right_are_those_of_the_image_put_right():
    askew, true = seen_askew()
    found, wanted = extract_regions(askew), extract_regions(true)
    right = ERROR.regions_corrected(found, askew.T_world_camera)
    assert len(right.regions) == len(wanted.regions) == 2
    assert np.abs(planes(found) - planes(wanted)).max() > 0.01
    np.testing.assert_allclose(planes(right), planes(wanted), atol=1e-5)
    for region, true_region in zip(right.regions, wanted.regions, strict=True):
        assert region.area == pytest.approx(true_region.area, rel=1e-3)
        assert np.abs(region.hull_world.mean(axis=0) - true_region.hull_world.mean(axis=0)).max() < 2e-3


def test_an_error_less_itself_changes_nothing():
    askew, _ = seen_askew()
    none = ERROR.less(ERROR)
    np.testing.assert_array_equal(none.vector, NO_ERROR.vector)
    np.testing.assert_array_equal(none.image_corrected(askew).depth, askew.depth)


@pytest.mark.parametrize("correct", [True, False])
def test_a_map_is_put_right_as_soon_as_the_error_is_sure(correct):
    askew, true = seen_askew()
    found, wanted = extract_regions(askew), planes(extract_regions(true))
    stance = Stance(Pose.from_xyz_rpy((0.0, 0.12, 0.0)), Pose.from_xyz_rpy((0.0, -0.12, 0.0)))
    parameters = MapParameters(MemoryParameters(), RegistrationParameters(correct_camera=correct), 0.26, 0.138)
    memory = remember(RegionMemory(), found, stance, askew, parameters)
    assert memory.cameras[""].error is NO_ERROR, "nothing is known of it yet"
    # As after a walk that has shown the error.
    information = np.diag(np.full(7, 1e12))
    estimate = np.concatenate((np.zeros(3), ERROR.vector))
    assert memory.update is not None
    drift = replace(memory.update.drift, motion=ApparentMotion(information, information @ estimate, estimate))
    memory = replace(memory, cameras={"": replace(memory.cameras[""], drift=drift)})
    for _ in range(2):
        memory = remember(memory, found, stance, askew, parameters)
    assert memory.ground is not None
    seen = [region for region in memory.ground.regions if region.area > 0.2][-2:]
    error = np.abs(planes(PlanarRegions(tuple(seen), 0.0, 0)) - wanted).max()
    assert error < 1e-3 if correct else error > 0.01
    np.testing.assert_allclose(memory.cameras[""].error.vector, ERROR.vector if correct else 0.0, atol=1e-6)
