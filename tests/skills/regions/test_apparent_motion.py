"""Drift, a mount that is askew and a wrong scale are told apart by how the ground seems to move."""

from __future__ import annotations

import numpy as np
import pytest

from skills.geometry.pose import Pose, rotation_z
from skills.regions import RegistrationParameters
from skills.regions.apparent_motion import ApparentMotion, causes_of, shift_by

PARAMETERS = RegistrationParameters()


def walked(drift: np.ndarray, mount: np.ndarray, scale: float, frames: int = 400) -> ApparentMotion:
    """What is known after frames of a walk that sways, each with a millimetre of noise."""
    rng = np.random.default_rng(0)
    time = 0.1 * np.arange(frames + 1)
    way = np.column_stack(
        (0.17 * time + 0.03 * np.sin(6.2 * time + 1.0), 0.07 * np.sin(3.1 * time), 0.02 * np.sin(6.2 * time))
    )
    motion = ApparentMotion.unknown()
    for k in range(frames):
        R_world_camera = Pose.from_xyz_rpy((0.0, 0.0, 0.0), (0.0, 0.8, 0.1)).R @ rotation_z(-np.pi / 2)
        causes = causes_of(0.1, way[k + 1] - way[k], R_world_camera)
        # What a camera that believes in a wrong pose sees of a point that stands still.
        turned = R_world_camera @ np.cross(mount, R_world_camera.T @ (way[k + 1] - way[k]))
        shift = 0.1 * drift + turned + scale * (way[k + 1] - way[k]) + rng.normal(0.0, (1e-3, 1e-3, 2e-4))
        motion = motion.learned(causes, shift, 1.0, 1.0, PARAMETERS)
    return motion


@pytest.mark.parametrize(
    ("drift", "mount", "scale"),
    [
        ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), 0.0),
        ((0.006, 0.006, 0.006), (0.0, 0.0, 0.0), 0.0),
        ((0.0, 0.0, 0.0), (0.02, -0.02, 0.02), 0.01),
        ((0.0, 0.01, 0.0), (-0.01, 0.02, 0.03), -0.01),
    ],
)
def test_a_walk_that_sways_tells_them_apart(drift, mount, scale):
    estimate = walked(np.array(drift), np.array(mount), scale).estimate
    np.testing.assert_allclose(estimate[:3], drift, atol=0.002)
    np.testing.assert_allclose(estimate[3:6], mount, atol=np.deg2rad(0.4))
    assert estimate[6] == pytest.approx(scale, abs=0.006)


def test_a_camera_that_is_as_believed_is_blamed_for_nothing():
    motion = walked(np.array((0.006, -0.006, 0.006)), np.zeros(3), 0.0)
    causes = causes_of(0.1, np.array((0.02, 0.0, 0.0)), np.eye(3))
    np.testing.assert_array_equal(shift_by(motion.camera, causes, PARAMETERS), 0.0)


def test_a_frame_that_is_not_trusted_teaches_nothing():
    causes = causes_of(0.1, np.array((0.02, 0.0, 0.0)), np.eye(3))
    motion = ApparentMotion.unknown().learned(causes, np.ones(3), 0.0, 1.0, PARAMETERS)
    np.testing.assert_array_equal(motion.estimate, 0.0)
