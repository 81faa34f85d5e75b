"""Any number of depth cameras: each sees from its own place with its own errors, more often where the robot goes."""

from __future__ import annotations

import numpy as np
import pytest
from small_worlds import slab, steps, world

from sim_envs.courses import Box
from sim_envs.robot import CameraMount, RobotDescription
from sim_envs.sensors import DEPTH_NOISE_PRESETS, DepthCameraParameters
from skills.footsteps.footstep import Footstep, Side
from skills.geometry.pose import Pose, wrap_angle
from skills.regions.own_body import without_body

YAWS = {"front": 0.0, "rear": 180.0, "left": 90.0, "right": -90.0}
PLACES = {"front": (0.14, 0.0), "rear": (-0.16, 0.0), "left": (0.0, 0.19), "right": (0.0, -0.19)}
ROBOT = RobotDescription(
    cameras=tuple(CameraMount(name=name, position=(*PLACES[name], 0.03), yaw_deg=yaw) for name, yaw in YAWS.items())
)
CAMERA = DepthCameraParameters(resolution=0.125)
FIELD = Box("field", (6.0, 6.0, 0.2), Pose.from_xyz_rpy((0.0, 0.0, -0.1)), "pad")


def wide_world(**options):
    return world(FIELD, robot=ROBOT, camera=CAMERA, **options)


def points_world(image) -> np.ndarray:
    v, u = np.nonzero(image.depth)
    c = image.camera
    rays = np.column_stack(((u - c.cx) / c.fx, (v - c.cy) / c.fy, np.ones(len(u))))
    return image.T_world_camera @ (rays * image.depth[v, u][:, None])


def test_each_camera_sees_the_ground_where_it_looks():
    it = wide_world(noise=DEPTH_NOISE_PRESETS["none"])
    for name, yaw_deg in YAWS.items():
        image = it.depth_image(name)
        assert image is not None and image.camera_name == name
        points = points_world(without_body(image))
        np.testing.assert_allclose(points[:, 2], 0.0, atol=2e-3)
        middle = points[:, :2].mean(axis=0) - image.T_world_camera.p[:2]
        assert abs(wrap_angle(np.arctan2(middle[1], middle[0]) - np.deg2rad(yaw_deg))) < 0.1


def test_no_two_cameras_share_errors_or_numbers():
    it, quiet = wide_world(), wide_world(noise=DEPTH_NOISE_PRESETS["none"])
    frames = it.depth_frames()
    assert list(frames) == list(YAWS) and len(set(frames.values())) == len(YAWS)
    errors = []
    for name in YAWS:
        noisy, clean = it.depth_image(name), quiet.depth_image(name)
        assert noisy is not None and clean is not None and noisy.frame_id == frames[name]
        errors.append((noisy.depth - clean.depth)[48:].ravel())
    correlations = np.corrcoef(errors)[np.triu_indices(len(errors), 1)]
    assert np.abs(correlations).max() < 0.2


def sideways_steps(count: int) -> tuple[Footstep, ...]:
    """Steps to the left on level ground."""
    made, y = [], {Side.LEFT: 0.12, Side.RIGHT: -0.12}
    for step in steps(count, length=0.0):
        y[step.side] += 0.12
        pose = Pose.from_xyz_rpy((0.0, y[step.side], 0.0))
        made.append(Footstep(step.sequence_id, step.side, pose, step.foothold_sole, 0.6, 0.2, 0.1, np.zeros((0, 3))))
    return tuple(made)


@pytest.mark.parametrize(
    ("sent", "ahead"), [((), "front"), (steps(5, length=0.3), "front"), (sideways_steps(6), "left")]
)
def test_the_camera_that_looks_where_the_robot_goes_has_the_full_rate(sent, ahead):
    it = wide_world()
    it.send_footsteps(sent)
    it.advance(0.5)
    before = it.depth_frames()
    it.advance(1.0)
    taken = {name: (frame - before[name]) / len(YAWS) for name, frame in it.depth_frames().items()}
    assert taken == {name: pytest.approx(30 if name == ahead else 5, abs=1) for name in YAWS}


def test_one_camera_has_the_full_rate_wherever_it_looks():
    rear = RobotDescription(cameras=(CameraMount(name="rear", yaw_deg=180.0),))
    it = world(slab(), robot=rear)
    it.advance(1.0)
    assert it.depth_frames() == {"rear": 30}
