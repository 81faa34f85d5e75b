"""Frames find their place on the ground known before, as far as that ground shows it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from block_fields import L515, Box, block, camera_pose, look, with_noise

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

CAMERA = L515.scaled(0.375)
PARAMETERS = MapParameters(MemoryParameters(), RegistrationParameters(), 0.26, 0.138)
STANCE = Stance(Pose.from_xyz_rpy((0.0, 0.12, 0.0)), Pose.from_xyz_rpy((0.0, -0.12, 0.0)))


def rough_field(seed: int, tilted: float = 0.34) -> list[Box]:
    """A pad, then three touching columns of blocks of different heights, some tilted by 11-18 degrees."""
    rng = np.random.default_rng(seed)
    field = [block(-0.4, 0.0, 0.0, size=(1.2, 1.2, 0.6))]
    for row in range(9):
        for column in range(3):
            tilt = np.deg2rad(rng.uniform(11.0, 18.0)) * rng.choice((-1.0, 1.0)) * (rng.random() < tilted)
            roll, pitch = (tilt, 0.0) if rng.random() < 0.5 else (0.0, tilt)
            top = 0.15 + rng.uniform(-0.05, 0.05)
            field.append(block(0.385 + 0.37 * row, 0.39 * (column - 1), top, roll=roll, pitch=pitch))
    return field


class Walk:
    """A camera over a field, and a map that is told a wrong pose of it."""

    def __init__(self, field: list[Box]) -> None:
        self.field = field
        self.memory = RegionMemory()
        self.T_estimate_world = Pose.identity()
        self._frames = 0

    def look(self, x: float, noise: bool = True) -> None:
        """Join a frame from above a place to the map, through the correction so far."""
        true = look(self.field, camera_pose(x, 0.15), CAMERA, 0.1 * self._frames, self._frames).image
        image = with_noise(true, self._frames) if noise else true
        image = replace(image, T_world_camera=self.T_estimate_world @ true.T_world_camera)
        if self.memory.update is not None:
            image = image.moved(self.memory.update.T_world_odometry)
        self._frames += 1
        self.memory = remember(self.memory, extract_regions(image), STANCE, image, PARAMETERS)

    def err(self, at: float, **xyz_yaw: float) -> None:
        """Let the estimate be off by so much from now on, turned about the camera over a place."""
        about = camera_pose(at, 0.15).p
        shift = np.array([xyz_yaw.get(name, 0.0) for name in "xyz"])
        turn = Pose.from_xyz_rpy((0.0, 0.0, 0.0), (0.0, 0.0, xyz_yaw.get("yaw", 0.0)))
        self.T_estimate_world = Pose(turn.R, about - turn.R @ about + shift) @ self.T_estimate_world

    def error(self, x: float) -> tuple[np.ndarray, float]:
        """How far the corrected estimate is off at the ground ahead of a place, [m] and [rad]."""
        assert self.memory.update is not None
        T = self.memory.update.T_world_odometry @ self.T_estimate_world
        ahead = np.array((x + 1.0, 0.0, 0.0))
        return T @ ahead - ahead, T.yaw


@pytest.mark.parametrize(
    ("seed", "err"),
    [
        (1, {"x": 0.05, "y": -0.03, "z": 0.02}),
        (2, {"y": 0.05, "z": -0.04, "yaw": np.deg2rad(3.0)}),
        (3, {"x": -0.04, "yaw": np.deg2rad(-3.0)}),
        (4, {"x": 0.01, "y": 0.01, "z": 0.01}),
    ],
)
def test_known_errors_are_found_to_millimetres_and_tenths_of_degrees(seed, err):
    walk = Walk(rough_field(seed))
    walk.look(0.5)
    walk.err(0.6, **err)
    for x in (0.6, 0.62):
        walk.look(x)
    position, yaw = walk.error(0.62)
    assert np.abs(position).max() < 0.006 and abs(position[2]) < 0.001
    assert abs(yaw) < np.deg2rad(0.3)


def test_where_nothing_drifts_nothing_is_invented():
    walk = Walk(rough_field(5))
    for x in np.arange(0.5, 1.2, 0.1):
        walk.look(x)
    position, yaw = walk.error(1.2)
    assert np.abs(position).max() < 0.004 and abs(position[2]) < 0.001
    assert abs(yaw) < np.deg2rad(0.2)


def test_a_floor_without_features_shows_height_only():
    walk = Walk([block(2.0, 0.0, 0.0, size=(20.0, 20.0, 0.1))])
    walk.look(0.5)
    walk.err(0.5, x=0.03, y=-0.03, z=0.01, yaw=0.02)
    for _ in range(4):
        walk.look(0.5)
    position, yaw = walk.error(0.5)
    assert abs(position[2]) < 0.001, "the height is seen"
    assert position[:2] == pytest.approx((0.03, -0.03 + 0.02), abs=0.003), "what is not seen stays as it was"
    assert yaw == pytest.approx(0.02, abs=0.002)


def test_steady_drift_is_taken_out_without_lagging_behind():
    walk = Walk(rough_field(6))
    walk.look(0.5)
    for k in range(25):
        walk.err(0.5, x=0.001, y=0.001, z=-0.001)
        walk.look(0.5 + 0.01 * k)
    position, yaw = walk.error(0.74)
    assert np.abs(position).max() < 0.006 and abs(yaw) < np.deg2rad(0.3)


def test_a_block_that_moves_does_not_pull_the_rest_along():
    field = rough_field(7, tilted=0.3)
    walk = Walk(field)
    walk.look(0.5)
    walk.look(0.51)
    moved = min(field[1:], key=lambda box: np.linalg.norm(box.top.p[:2] - (1.3, 0.0)))
    T = moved.T_world_box
    walk.field = [
        box if box is not moved else replace(box, T_world_box=Pose(T.R, T.p + np.array((0.0, 0.0, 0.08))))
        for box in field
    ]
    for k in range(3):
        walk.look(0.52 + 0.01 * k)
    position, yaw = walk.error(0.55)
    assert np.abs(position).max() < 0.005 and abs(yaw) < np.deg2rad(0.3)


def test_ground_that_cannot_be_compared_says_so():
    walk = Walk(rough_field(8))
    walk.look(0.5)
    assert walk.memory.update is not None and walk.memory.update.drift.reason == "no ground is known yet"
    walk.err(0.5, x=3.0)
    walk.look(0.5)
    assert walk.memory.update.drift.reason == "too little of the ground in view was known before"
    np.testing.assert_array_equal(walk.memory.update.T_world_odometry.p, 0.0)


def test_a_frame_that_shows_nothing_makes_nothing_newer():
    walk = Walk(rough_field(9))
    walk.look(0.5)
    before = walk.memory.ground
    walk.field = []
    walk.look(0.5, noise=False)
    assert walk.memory.update is not None and walk.memory.update.drift.reason
    assert before is not None and walk.memory.ground is not None
    assert walk.memory.ground.frame_id == before.frame_id


def test_the_same_frames_give_the_same_bits():
    def walked() -> list[np.ndarray]:
        walk = Walk(rough_field(10))
        for x in (0.5, 0.6, 0.7):
            walk.look(x)
        assert walk.memory.update is not None
        return [walk.memory.update.T_world_odometry.p, walk.memory.update.drift.shift_turn]

    for first, second in zip(walked(), walked(), strict=True):
        np.testing.assert_array_equal(first, second)
