# pyright: reportAttributeAccessIssue=false
from typing import Any

import mujoco
import numpy as np
import pytest
from dm_control import composer

from sim_envs.robot import Biped, RobotDescription
from sim_envs.sensors import (
    DEPTH_NOISE_PRESETS,
    DepthCamera,
    DepthCameraParameters,
    Snapshot,
    geom_mesh,
    rasterize_faces,
)
from skills.geometry.camera import looking
from skills.geometry.pose import Pose

QUIET = DEPTH_NOISE_PRESETS["none"]


@pytest.fixture(scope="module")
def standing_robot():
    """The robot on flat ground, its left leg swung forward: model, data, poses of all geoms and its camera."""
    arena = composer.Arena()
    world: Any = arena.mjcf_model
    world.worldbody.add("geom", type="plane", size=(0, 0, 1))
    robot = Biped(RobotDescription())
    frame = arena.add_free_entity(robot)
    frame.pos = (0, 0, 0.864)
    model = mujoco.MjModel.from_xml_string(world.to_xml_string(), world.get_assets())
    data = mujoco.MjData(model)
    prefix = f"{robot.mjcf_model.model}/"
    angles = {"left": {"hip_pitch": -1.1, "knee": 0.9, "ankle_pitch": 0.2}}
    angles["right"] = {"hip_pitch": -0.45, "knee": 0.9, "ankle_pitch": -0.45}
    for side, joints in angles.items():
        for joint, angle in joints.items():
            data.joint(f"{prefix}{side}_{joint}").qpos[0] = angle
    mujoco.mj_forward(model, data)
    body = data.body(f"{prefix}{robot.description.cameras[0].body}")
    T_world_camera = Pose(body.xmat.reshape(3, 3), body.xpos) @ robot.description.cameras[0].T_body_camera
    return model, data, data.geom_xpos.copy(), data.geom_xmat.reshape(-1, 3, 3).copy(), T_world_camera


def test_intrinsics_are_those_of_an_l515():
    camera = DepthCameraParameters().camera
    assert (camera.width, camera.height, camera.cx, camera.cy) == (1024, 768, 511.5, 383.5)
    assert camera.fx == pytest.approx(731.2, abs=0.05)
    assert camera.fy == pytest.approx(737.6, abs=0.1)


def test_a_smaller_image_shows_the_same_view():
    full, half = DepthCameraParameters().camera, DepthCameraParameters(resolution=0.5).camera
    assert (half.width, half.height) == (512, 384)
    assert (half.width - 1 - half.cx + 0.5) / half.fx == pytest.approx((full.width - 1 - full.cx + 0.5) / full.fx)


def test_the_camera_looks_down_by_its_pitch():
    view = looking((1, 2, 3), pitch=0.3, yaw=0.5)
    np.testing.assert_allclose(view.R[:, 2], (np.cos(0.3) * np.cos(0.5), np.cos(0.3) * np.sin(0.5), -np.sin(0.3)))
    assert view.R[2, 0] == pytest.approx(0)
    assert view.R[2, 1] < 0


def test_the_robots_own_legs_are_in_the_image(standing_robot):
    model, _, positions, rotations, T_world_camera = standing_robot
    camera = DepthCamera(model, DepthCameraParameters(), QUIET, seed=0)
    mesh = camera.mesh
    raster = rasterize_faces(mesh, positions, rotations, camera.camera, T_world_camera)
    geoms, pixels = np.unique(mesh.face_geom_ids[raster.face], return_counts=True)
    seen = {model.body(model.geom_bodyid[geom]).name.split("/")[-1] for geom in geoms}
    assert (
        {"world", "left_shin", "left_foot"}
        <= seen
        <= {"world", "left_thigh", "left_shin", "left_ankle_link", "left_foot"}
    )
    assert 0.02 < 1 - pixels[geoms == 0].item() / raster.depth.size < 0.4


def test_round_links_are_within_millimetres_of_rays(standing_robot):
    model, data, positions, rotations, _ = standing_robot
    camera = DepthCameraParameters().camera
    view = looking((1.6, 0.7, 1.4), pitch=0.45, yaw=np.pi + 0.42)
    mesh = geom_mesh(model)
    raster = rasterize_faces(mesh, positions, rotations, camera, view)
    on_robot = (raster.face >= 0) & (mesh.face_geom_ids[raster.face] > 0)
    v, u = np.nonzero(on_robot)
    chosen = np.random.default_rng(0).choice(len(u), 2000, replace=False)
    u, v = u[chosen], v[chosen]
    rays = np.column_stack(((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, np.ones(len(u))))
    directions = (rays / np.linalg.norm(rays, axis=1)[:, None]) @ view.R.T
    geom, distance = np.zeros((len(u), 1), dtype=np.int32), np.zeros((len(u), 1))
    seen_groups = np.array([[1], [1], [1], [0], [0], [0]], dtype=np.uint8)
    origin = view.p.reshape(3, 1).copy()
    mujoco.mj_multiRay(
        model, data, origin, directions.reshape(-1, 1), seen_groups, 1, -1, geom, distance, None, len(u), 1e10
    )
    errors = np.abs(raster.depth[v, u] - distance[:, 0] / np.linalg.norm(rays, axis=1))
    same = mesh.face_geom_ids[raster.face[v, u]] == geom[:, 0]
    assert same.mean() > 0.98  # the rest lies on silhouettes
    assert np.quantile(errors[same], 0.99) < 3e-3
    assert np.median(errors[same]) < 5e-4


def test_a_capture_tells_where_and_when_it_was_taken(standing_robot):
    model, _, positions, rotations, T_world_camera = standing_robot
    camera = DepthCamera(model, DepthCameraParameters(resolution=0.25), DEPTH_NOISE_PRESETS["standard"], seed=0)
    instant = Snapshot(1.5, 45, positions, rotations, T_world_camera)
    image = camera.capture(instant)
    assert (image.time, image.frame_id, image.camera) == (1.5, 45, camera.camera)
    np.testing.assert_array_equal(image.T_world_camera.R, T_world_camera.R)
    again = camera.capture(instant)
    np.testing.assert_array_equal(image.depth, again.depth)


def test_the_robot_believes_in_its_estimate_and_not_in_the_mount_error(standing_robot):
    model, _, positions, rotations, T_world_camera = standing_robot
    small = DepthCameraParameters(resolution=0.25)
    crooked = DepthCamera(model, small, DEPTH_NOISE_PRESETS["hard"], seed=0)
    T_estimate_world = Pose.from_xyz_rpy((0.1, 0, 0), (0, 0, 0.2))
    image = crooked.capture(Snapshot(0.0, 0, positions, rotations, T_world_camera, T_estimate_world))
    np.testing.assert_array_equal(image.T_world_camera.p, (T_estimate_world @ T_world_camera).p)
    straight = DepthCamera(model, small, QUIET, seed=0)
    turned = straight.render(positions, rotations, T_world_camera @ Pose(crooked._noise.R_mount, np.zeros(3)))
    seen = (turned > 0) & (image.depth > 0)
    assert np.median(np.abs(image.depth - 1.01 * turned)[seen]) < 0.01
