"""The lidar's ranges are those of MuJoCo's own rays, for every shape, wherever it is moved.

The reference is `mj_ray`, one ray at a time: `mj_multiRay` prunes bodies and loses hits on some.
"""

# pyright: reportAttributeAccessIssue=false
import mujoco
import numpy as np
import pytest

from sim_envs.sensors import LIDAR_NOISE_PRESETS, Lidar, LidarParameters, Snapshot
from skills.geometry.lidar import SpinningLidar
from skills.geometry.pose import Pose

QUIET = LIDAR_NOISE_PRESETS["none"]
SEEN_GROUPS = np.array((1, 1, 1, 0, 0, 0), dtype=np.uint8)
VIEW = Pose.from_xyz_rpy((0.3, -0.2, 1.6), (0.05, 0.4, 0.7))
SHAPES = {
    "box": 'type="box" size="0.3 0.2 0.1" euler="20 30 40"',
    "sphere": 'type="sphere" size="0.4"',
    "ellipsoid": 'type="ellipsoid" size="0.5 0.3 0.2" euler="20 30 40"',
    "capsule": 'type="capsule" size="0.2 0.5" euler="70 20 10"',
    "cylinder": 'type="cylinder" size="0.3 0.4" euler="60 30 0"',
    "rectangle": 'type="plane" size="0.5 0.4 1" euler="-4 -6 0"',
}


def posed(worldbody: str):
    """Model, data and the poses of all geoms."""
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{worldbody}</worldbody></mujoco>")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def snapshot(data, T_world_lidar=VIEW, number=0) -> Snapshot:
    return Snapshot(0.0, number, data.geom_xpos.copy(), data.geom_xmat.reshape(-1, 3, 3).copy(), T_world_lidar)


def directions(lidar: SpinningLidar, T_world_lidar: Pose):
    """Of all rays in the world, (rings, columns, 3)."""
    e, a = lidar.elevations[:, None], lidar.azimuths[None]
    rays = np.stack((np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e) + 0.0 * a), axis=-1)
    return rays @ T_world_lidar.R.T


def mujoco_ranges(model, data, lidar: SpinningLidar, T_world_lidar: Pose, rings, columns):
    """Ranges by MuJoCo's own rays, seen from outside only, 0 where they are out of range."""
    geom = np.zeros((1, 1), dtype=np.int32)
    rays = directions(lidar, T_world_lidar)[rings, columns]
    distances = np.array(
        [mujoco.mj_ray(model, data, T_world_lidar.p.copy(), ray.copy(), SEEN_GROUPS, 1, -1, geom, None) for ray in rays]
    )
    return np.where((distances >= lidar.near) & (distances <= lidar.far), distances, 0.0)


def assert_matches_rays(model, data, T_world_lidar=VIEW, hits=50, count=2000):
    sensor = Lidar(model, LidarParameters(), QUIET, seed=0)
    scan = sensor.capture(snapshot(data, T_world_lidar))
    rng = np.random.default_rng(0)
    seen, unseen = np.nonzero(scan.ranges), np.nonzero(scan.ranges == 0)
    on, off = rng.integers(0, len(seen[0]), count // 2), rng.integers(0, max(len(unseen[0]), 1), count // 2)
    rings, columns = seen[0][on], seen[1][on]
    if len(unseen[0]):
        rings, columns = np.append(rings, unseen[0][off]), np.append(columns, unseen[1][off])
    truth = mujoco_ranges(model, data, sensor.lidar, T_world_lidar, rings, columns)
    assert np.count_nonzero(truth) >= hits
    agree = np.isclose(scan.ranges[rings, columns], truth, rtol=1e-5, atol=1e-5)
    assert np.mean(agree) >= 0.999  # Rounding decides whether a ray that grazes an edge meets it.


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("place", ["2 1 1", "-1.5 0.1 1.3", "0.3 -2.4 1.1", "0.5 0.1 0.1"])
def test_every_shape_is_met_where_rays_meet_it(shape, place):
    assert_matches_rays(*posed(f'<geom pos="{place}" {SHAPES[shape]}/>'))


@pytest.mark.parametrize("shape", [shape for shape in SHAPES if shape != "rectangle"])
def test_all_rays_that_meet_a_shape_are_cast_at_it(shape):
    """Every ray, near the poles and across the seam of the columns too: none is culled that would have hit."""
    small = LidarParameters(rings=60, columns=180, vertical_fov_deg=170.0)
    for place in ("0.4 -0.2 3.0", "-3 -0.25 1.6", "0.3 1.5 -0.5", "1.3 0.6 1.2"):
        model, data = posed(f'<geom pos="{place}" {SHAPES[shape]}/>')
        sensor = Lidar(model, small, QUIET, seed=0)
        ranges = sensor.capture(snapshot(data)).ranges
        rings, columns = np.divmod(np.arange(ranges.size), ranges.shape[1])
        truth = mujoco_ranges(model, data, sensor.lidar, VIEW, rings, columns)
        assert np.count_nonzero(truth) > 5
        np.testing.assert_allclose(ranges.ravel(), truth, rtol=1e-5, atol=1e-5)


def test_a_field_of_boxes_on_a_plane_matches_rays():
    rng = np.random.default_rng(3)
    geoms = '<geom type="plane" size="0 0 1"/>'
    for _ in range(60):
        x, y, z, roll, pitch, yaw = rng.uniform((-6, -6, 0, -20, -20, -180), (6, 6, 0.3, 20, 20, 180))
        size = "{} {} {}".format(*rng.uniform(0.05, 0.4, 3))
        geoms += f'<geom type="box" size="{size}" pos="{x} {y} {z}" euler="{roll} {pitch} {yaw}"/>'
    assert_matches_rays(*posed(geoms))


def test_a_moved_block_is_seen_where_it_is():
    model, data = posed('<body name="block" mocap="true" pos="2 0 1"><geom type="box" size="0.3 0.2 0.4"/></body>')
    sensor = Lidar(model, LidarParameters(), QUIET, seed=0)
    before = sensor.capture(snapshot(data)).ranges
    data.mocap_pos[0], data.mocap_quat[0] = (1.0, -1.5, 1.2), (0.9, 0.1, -0.2, 0.3)
    mujoco.mj_forward(model, data)
    assert np.count_nonzero(before != sensor.capture(snapshot(data)).ranges) > 1000
    assert_matches_rays(model, data)


def test_only_what_sensors_see_is_met():
    hidden = (
        '<geom type="box" size="1 1 1" pos="3 0 1" group="3"/><geom type="sphere" size="1" pos="0 3 1" rgba="1 1 1 0"/>'
    )
    model, data = posed(hidden + '<geom type="sphere" size="0.5" pos="-3 0 1"/>')
    sensor = Lidar(model, LidarParameters(), QUIET, seed=0)
    assert sensor.shapes.geom_ids.tolist() == [2]
    assert sensor.capture(snapshot(data, Pose.identity())).ranges.max() < 4.0


def test_what_is_nearer_than_near_hides_what_is_behind():
    model, data = posed('<geom type="sphere" size="0.1" pos="0.2 0 0"/><geom type="box" size="1 5 5" pos="4 0 0"/>')
    ranges = Lidar(model, LidarParameters(rings=65), QUIET, seed=0).render(
        data.geom_xpos, data.geom_xmat.reshape(-1, 3, 3), Pose.identity()
    )
    assert ranges[32, 510:514].max() == 0.0
    assert ranges[32, 400] > 3.0


def test_shapes_that_cannot_be_met_are_named():
    asset = '<asset><mesh name="wedge" vertex="0 0 0  .5 0 0  0 .4 0  0 0 .3"/></asset>'
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco>{asset}<worldbody><geom name="ramp" type="mesh" mesh="wedge"/></worldbody></mujoco>'
    )
    with pytest.raises(ValueError, match=r'geom "ramp" \(0\): got mjGEOM_MESH, .*allowed: .*mjGEOM_BOX'):
        Lidar(model, LidarParameters(), QUIET, seed=0)


def test_an_empty_scene_is_empty():
    assert not Lidar(*posed("")[:1], LidarParameters(), QUIET, seed=0).capture(snapshot(posed("")[1])).ranges.any()


def test_the_lidar_is_an_os0():
    lidar = LidarParameters().lidar
    assert (lidar.rings, lidar.columns, lidar.near, lidar.far) == (128, 1024, 0.3, 50.0)
    assert lidar.elevation_max - lidar.elevation_min == pytest.approx(0.5 * np.pi)
    assert LidarParameters().rate == 10.0


def test_the_robot_believes_in_its_estimate_and_not_in_the_mount_error():
    model, data = posed('<geom type="box" size="5 5 5" pos="0 0 -5.01"/>')
    T_estimate_world = Pose.from_xyz_rpy((0.1, 0.2, 0.0), (0.0, 0.0, 0.2))
    crooked = Lidar(model, LidarParameters(), LIDAR_NOISE_PRESETS["hard"], seed=0)
    here = snapshot(data)
    scan = crooked.capture(
        Snapshot(1.5, 15, here.geom_positions, here.geom_rotations, VIEW, T_estimate_world=T_estimate_world)
    )
    assert (scan.time, scan.scan_id) == (1.5, 15)
    np.testing.assert_array_equal(scan.T_world_lidar.R, (T_estimate_world @ VIEW).R)
    seen = scan.ranges > 0
    points = directions(crooked.lidar, VIEW)[seen] * scan.ranges[seen][:, None] + VIEW.p
    tilt = np.linalg.lstsq(np.column_stack((points[:, :2], np.ones(len(points)))), points[:, 2], rcond=None)[0][:2]
    assert 0.1 < np.degrees(np.hypot(*tilt)) < 1.2
