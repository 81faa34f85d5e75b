"""One map from several cameras: each finds its own place on it, and what one has seen the others do not take away."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from block_fields import L515, block, camera_pose, look, with_noise

from skills.footsteps.footstep import Stance
from skills.geometry.pose import Pose
from skills.regions import (
    MapParameters,
    MemoryParameters,
    RegionMemory,
    RegistrationParameters,
    extract_regions,
    remember,
)

CAMERA = L515.scaled(0.3125)
PARAMETERS = MapParameters(MemoryParameters(), RegistrationParameters(), 0.26, 0.138)
STANCE = Stance(Pose.from_xyz_rpy((0.0, 0.12, 0.0)), Pose.from_xyz_rpy((0.0, -0.12, 0.0)))
YAWS = {"front": 0.0, "rear": np.pi}


def field() -> list:
    """A pad with rough ground before and behind it."""
    rng = np.random.default_rng(3)
    boxes = [block(0.0, 0.0, 0.0, size=(0.8, 1.2, 0.6))]
    for side in (-1.0, 1.0):
        for row in range(4):
            for column in range(3):
                roll, pitch = np.deg2rad(rng.uniform(-15.0, 15.0, 2)) * (rng.random(2) < 0.4)
                x, y, top = side * (0.585 + 0.37 * row), 0.39 * (column - 1), rng.uniform(0.0, 0.1)
                boxes.append(block(x, y, top, roll=roll, pitch=pitch))
    return boxes


class Walk:
    """Cameras that look ahead and back from one robot, whose estimate errs."""

    def __init__(self) -> None:
        self.memory, self.field = RegionMemory(), field()
        self.T_estimate_world = Pose.identity()
        self.frames = 0

    def look(self, name: str, x: float, time: float) -> None:
        true = look(self.field, camera_pose(x, 0.05, yaw=YAWS[name]), CAMERA, time, self.frames).image
        image = replace(with_noise(true, self.frames), camera_name=name)
        image = image.moved(self.T_estimate_world)
        image = replace(image, T_world_odometry=Pose.identity())
        if self.memory.update is not None:
            image = image.moved(self.memory.update.T_world_odometry)
        self.frames += 1
        self.memory = remember(self.memory, extract_regions(image), STANCE, image, PARAMETERS)

    def error(self) -> np.ndarray:
        """How far the corrected estimate is off."""
        assert self.memory.update is not None
        return (self.memory.update.T_world_odometry @ self.T_estimate_world).p


@pytest.mark.parametrize("names", [("front", "rear"), ("rear", "front")])
def test_drift_is_taken_out_by_whichever_camera_looks(names):
    walk = Walk()
    for name in names:
        walk.look(name, 0.0, 0.0)
    walk.T_estimate_world = Pose.from_xyz_rpy((0.03, -0.02, 0.02))
    walk.look(names[1], 0.02, 0.1)
    np.testing.assert_allclose(walk.error(), 0.0, atol=8e-3)
    # The other one finds nothing left to correct, though it has seen nothing of it itself.
    walk.look(names[0], 0.02, 0.1)
    np.testing.assert_allclose(walk.error(), 0.0, atol=6e-3)


def test_steady_drift_is_learned_by_each_camera_and_never_counted_twice():
    walk = Walk()
    for k in range(13):
        walk.T_estimate_world = Pose.from_xyz_rpy((0.001 * k, 0.0, -0.001 * k))
        walk.look("front", 0.005 * k, 0.1 * k)
        if k % 3 == 0:
            walk.look("rear", 0.005 * k, 0.1 * k)
    np.testing.assert_allclose(walk.error(), 0.0, atol=6e-3)
    for name in YAWS:
        drift = walk.memory.cameras[name].drift
        assert drift is not None
        # The estimate runs ahead by 1 cm/s and sinks by as much: so much has each frame to be moved back.
        np.testing.assert_allclose(drift.motion.estimate[[0, 2]], (-0.01, 0.01), atol=6e-3)


def heights_ahead(memory: RegionMemory) -> np.ndarray:
    """Where the middles of the regions well ahead are, in order."""
    assert memory.ground is not None
    middles = [region.T_world_region.p for region in memory.ground.regions if region.T_world_region.p[0] > 0.9]
    return np.array(sorted(middle.tolist() for middle in middles))


def test_ground_that_one_camera_sees_stays_while_another_looks():
    walk = Walk()
    walk.look("front", 0.0, 0.0)
    lifted = Pose.from_xyz_rpy((0.0, 0.0, 0.06))
    walk.field = [
        box if box.T_world_box.p[0] < 0.8 else replace(box, T_world_box=lifted @ box.T_world_box) for box in walk.field
    ]
    # This frame is not kept for long: its camera has hardly moved.
    walk.look("front", 0.01, 0.1)
    seen = heights_ahead(walk.memory)
    walk.look("rear", 0.01, 0.1)
    assert len(seen) > 5
    np.testing.assert_allclose(heights_ahead(walk.memory), seen, atol=1e-3)
