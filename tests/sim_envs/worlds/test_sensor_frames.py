"""Frames and scans come when they are due, cost nothing unread, and know where the robot's own body is."""

# pyright: reportAttributeAccessIssue=false
from dataclasses import replace

import mujoco
import numpy as np
import pytest
from small_worlds import slab, steps, world

from sim_envs.courses import Box
from sim_envs.sensors import (
    DEPTH_NOISE_PRESETS,
    LIDAR_NOISE_PRESETS,
    DepthCameraParameters,
    LidarParameters,
    Snapshot,
    rasterize_faces,
)
from sim_envs.sensors.lidar_caster import cast_ranges
from sim_envs.sensors.ray_shapes import RayShapes
from sim_envs.worlds import SensorFrames, StateDriftParameters
from skills.geometry.pose import Pose


class Counted:
    """A sensor that gives the numbers of its snapshots and counts how often it was asked."""

    rate = 4.0

    def __init__(self):
        self.captures = 0

    def capture(self, snapshot: Snapshot) -> int:
        self.captures += 1
        return snapshot.number


def test_a_measurement_that_nobody_reads_is_never_made_and_others_once():
    model = mujoco.MjModel.from_xml_string("<mujoco><worldbody><geom size='1'/></worldbody></mujoco>")
    data, sensor = mujoco.MjData(model), Counted()
    frames = SensorFrames(sensor, 0, Pose.identity())
    assert frames.newest() is None
    for step in range(101):
        frames.advance(0.01 * step, data, Pose.identity())
    assert sensor.captures == 0
    assert [frames.newest(), frames.newest(), sensor.captures] == [4, 4, 1]


def test_scans_come_by_robot_time_and_do_not_depend_on_which_are_read():
    read, unread = world(seed=3), world(seed=3)
    first = read.lidar_scan()
    assert first is not None
    assert (first.scan_id, first.time) == (0, 0.0)
    for _ in range(10):
        read.advance(0.1)
        assert read.lidar_scan() is read.lidar_scan()
    unread.advance(1.0)
    last, same = read.lidar_scan(), unread.lidar_scan()
    assert last is not None and same is not None
    assert last.scan_id == same.scan_id == 10
    np.testing.assert_array_equal(last.ranges, same.ranges)


def points_world(scan):
    """Where the returns of a scan came from, (N, 3)."""
    e, a = scan.lidar.elevations[:, None], scan.lidar.azimuths[None]
    rays = np.stack((np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e) + 0.0 * a), axis=-1)
    seen = scan.ranges > 0
    return scan.T_world_lidar @ (rays[seen] * scan.ranges[seen][:, None])


def test_a_scan_shows_the_ground_and_a_block_where_it_was_moved():
    block = Box("block", (0.4, 0.4, 0.4), Pose.from_xyz_rpy((2.5, 0.0, 0.2)), "block")
    it = world(slab(), block, lidar_noise=LIDAR_NOISE_PRESETS["none"])
    for center in ((2.5, 0.0), (2.0, 0.6)):
        it.move_box("block", Pose.from_xyz_rpy((*center, 0.2)))
        it.advance(0.2)
        points = points_world(it.lidar_scan())
        ahead = points[points[:, 0] > 1.0]
        beside = np.abs(ahead[:, :2] - center).max(axis=1) > 0.2 + 1e-4
        np.testing.assert_allclose(ahead[beside, 2], 0.0, atol=1e-4)
        above = ahead[~beside]
        assert len(above) > 300
        assert above[:, 2].max() == pytest.approx(0.4, abs=1e-4)


def test_scans_and_their_body_follow_the_estimate():
    drift = StateDriftParameters(velocity=(0.1, 0.0, 0.0), yaw_jump=0.1, yaw_jump_time=0.5)
    believed, true = world(drift=drift), world()
    for it in (believed, true):
        it.advance(1.0)
    T = believed.state().T_world_pelvis @ true.state().T_world_pelvis.inverse
    for estimate, truth in (
        (believed.lidar_scan(), true.lidar_scan()),
        (believed.depth_image("front"), true.depth_image("front")),
    ):
        assert estimate is not None and truth is not None
        for one, other in zip(estimate.body_world, truth.body_world, strict=True):
            np.testing.assert_allclose(one.start_world, T @ other.start_world, atol=1e-9)
            np.testing.assert_allclose(one.end_world, T @ other.end_world, atol=1e-9)
    estimate, truth = believed.lidar_scan(), true.lidar_scan()
    assert estimate is not None and truth is not None
    np.testing.assert_allclose(estimate.T_world_lidar.R, (T @ truth.T_world_lidar).R, atol=1e-9)
    np.testing.assert_array_equal(estimate.ranges, truth.ranges)


def inside(points, capsules, tolerance=1e-4):
    """Which points lie in one of the capsules, (N,)."""
    found = np.full(len(points), False)
    for capsule in capsules:
        axis, p = capsule.end_world - capsule.start_world, points - capsule.start_world
        share = np.clip(p @ axis / max(axis @ axis, 1e-12), 0.0, 1.0)
        found |= np.linalg.norm(p - share[:, None] * axis, axis=1) <= capsule.radius + tolerance
    return found


@pytest.fixture(scope="module")
def walking_views():
    """A walk whose every control step has a frame and a scan: world, image and scan at several instants."""
    camera = DepthCameraParameters(resolution=0.25, rate=100.0, body_margin=0.0)
    lidar = LidarParameters(rate=100.0, body_margin=0.0)
    noise = {"noise": DEPTH_NOISE_PRESETS["none"], "lidar_noise": LIDAR_NOISE_PRESETS["none"]}
    it = world(camera=camera, lidar=lidar, **noise)
    it.send_footsteps(steps(5, length=0.4))
    views = []
    for _ in range(16):
        it.advance(0.17)
        views.append((it.geom_poses(), it.depth_image("front"), it.lidar_scan()))
    return it, views


def is_robot(it, geoms):
    model = it.model
    root = model.body("atlas_class/").id
    return (geoms >= 0) & (model.body_rootid[model.geom_bodyid[geoms]] == root)


def test_every_pixel_of_the_robot_lies_in_its_capsules_and_hardly_one_of_the_ground(walking_views):
    it, views = walking_views
    mesh = it.depth_cameras["front"].mesh
    seen, blinded = 0, 0
    for (positions, rotations), image, _ in views:
        raster = rasterize_faces(mesh, positions, rotations, image.camera, image.T_world_camera)
        v, u = np.nonzero(raster.face >= 0)
        c = image.camera
        rays = np.column_stack(((u - c.cx) / c.fx, (v - c.cy) / c.fy, np.ones(len(u))))
        masked = inside(image.T_world_camera @ (rays * raster.depth[v, u][:, None]), image.body_world)
        own = is_robot(it, mesh.face_geom_ids[raster.face[v, u]])
        assert masked[own].all()
        seen, blinded = seen + own.sum(), blinded + (masked & ~own).sum()
    assert seen > 3000
    assert blinded < 0.03 * seen


def test_every_return_from_the_robot_lies_in_its_capsules(walking_views):
    it, views = walking_views
    shapes = it.lidar.shapes
    own = is_robot(it, shapes.geom_ids)
    robot = RayShapes(shapes.geom_ids[own], shapes.kinds[own], shapes.sizes[own], shapes.radii[own])
    seen = 0
    for (positions, rotations), _, scan in views:
        of_robot = cast_ranges(robot, positions, rotations, scan.lidar, scan.T_world_lidar)
        on_robot = replace(scan, ranges=np.where(of_robot == scan.ranges, scan.ranges, np.float32(0.0)))
        points = points_world(on_robot)
        seen += len(points)
        assert inside(points, scan.body_world).all()
    assert seen > 3000
