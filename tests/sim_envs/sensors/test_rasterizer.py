# pyright: reportAttributeAccessIssue=false
import cv2
import mujoco
import numpy as np
import pytest

from sim_envs.sensors import DepthCameraParameters, geom_mesh, rasterize_depth, rasterize_faces
from skills.geometry.camera import PinholeCamera, looking
from skills.geometry.pose import Pose

CAMERA = DepthCameraParameters().camera
BOX_ERROR = 1e-4
SILHOUETTE_BAND = 2


def model_of(worldbody: str, asset: str = ""):
    return mujoco.MjModel.from_xml_string(f"<mujoco><asset>{asset}</asset><worldbody>{worldbody}</worldbody></mujoco>")


def box_field(seed: int, boxes: int = 100) -> str:
    rng = np.random.default_rng(seed)
    geoms = '<geom type="plane" size="0 0 1"/>'
    for _ in range(boxes):
        x, y, z = rng.uniform((-0.5, -2.0, -0.05), (4.0, 2.0, 0.25))
        roll, pitch, yaw = rng.uniform((-20, -20, -180), (20, 20, 180))
        sizes = rng.uniform(0.03, 0.25, 3)
        geoms += f'<geom type="box" size="{sizes[0]} {sizes[1]} {sizes[2]}" pos="{x} {y} {z}"'
        geoms += f' euler="{roll} {pitch} {yaw}"/>'
    return geoms


def posed(model, qpos=None):
    data = mujoco.MjData(model)
    if qpos is not None:
        data.qpos[:] = qpos
    mujoco.mj_forward(model, data)
    return data, data.geom_xpos.copy(), data.geom_xmat.reshape(-1, 3, 3).copy()


def ray_depth(model, data, camera: PinholeCamera, T_world_camera: Pose, pixels):
    """Depth and geom of each pixel (u, v) by MuJoCo's own rays; depth 0 and geom -1 out of range."""
    rays = np.column_stack(
        ((pixels[:, 0] - camera.cx) / camera.fx, (pixels[:, 1] - camera.cy) / camera.fy, np.ones(len(pixels)))
    )
    lengths = np.linalg.norm(rays, axis=1)
    directions = (rays / lengths[:, None]) @ T_world_camera.R.T
    geom = np.zeros((len(pixels), 1), dtype=np.int32)
    distance = np.zeros((len(pixels), 1))
    origin = T_world_camera.p.reshape(3, 1).copy()
    mujoco.mj_multiRay(
        model, data, origin, directions.reshape(-1, 1), None, 1, -1, geom, distance, None, len(pixels), 1e10
    )
    depth = distance[:, 0] / lengths
    seen = (distance[:, 0] >= 0) & (depth >= camera.near) & (depth <= camera.far)
    return np.where(seen, depth, 0.0), np.where(seen, geom[:, 0], -1)


def compare_with_rays(model, data, positions, rotations, camera, T_world_camera, seed=0, count=2000):
    """Errors of our depth against rays, and both geoms, on random pixels away from silhouettes."""
    mesh = geom_mesh(model)
    raster = rasterize_faces(mesh, positions, rotations, camera, T_world_camera)
    geom = np.where(raster.depth > 0, mesh.face_geom_ids[raster.face], -1).astype(np.float32)
    window = np.ones((2 * SILHOUETTE_BAND + 1,) * 2, np.uint8)
    inside = cv2.dilate(geom, window) == cv2.erode(geom, window)
    pixels = np.random.default_rng(seed).integers(0, (camera.width, camera.height), (count, 2))
    pixels = pixels[inside[pixels[:, 1], pixels[:, 0]]]
    depth, ray_geom = ray_depth(model, data, camera, T_world_camera, pixels)
    ours = raster.depth[pixels[:, 1], pixels[:, 0]]
    return np.abs(ours - depth), geom[pixels[:, 1], pixels[:, 0]], ray_geom


def assert_matches_rays(model, T_world_camera, *, camera=CAMERA, error=BOX_ERROR, least=500, seed=0):
    data, positions, rotations = posed(model)
    errors, ours, theirs = compare_with_rays(model, data, positions, rotations, camera, T_world_camera, seed)
    assert len(errors) >= least
    np.testing.assert_array_equal(ours, theirs)
    assert errors.max() <= error


@pytest.mark.parametrize("seed", range(4))
def test_box_fields_match_rays(seed):
    rng = np.random.default_rng(seed)
    view = looking(rng.uniform((-0.3, -1, 0.9), (1, 1, 1.4)), pitch=rng.uniform(0.3, 1.2), yaw=rng.uniform(-0.6, 0.6))
    assert_matches_rays(model_of(box_field(seed)), view, seed=seed)


def test_rolled_camera_matches_rays():
    view = Pose(
        Pose.from_xyz_rpy((0, 0, 0), (0.7, 0.4, -0.3)).R @ looking((0, 0, 0), pitch=0.8).R, np.array((0, 0, 1.2))
    )
    assert_matches_rays(model_of(box_field(5)), view)


@pytest.mark.parametrize("resolution", [0.25, 0.1])
def test_small_images_match_rays(resolution):
    camera = CAMERA.scaled(resolution)
    assert_matches_rays(model_of(box_field(2, 30)), looking((0, 0, 1.1), pitch=0.8), camera=camera, least=100)


def test_faces_that_pass_the_lens_are_not_lost():
    floor_and_wall = (
        '<geom type="box" size="50 50 0.1" pos="0 0 -0.2"/>'
        '<geom type="box" size="8 0.05 1" pos="1 0.3 0"/>'
        '<geom type="box" size="3 0.2 0.05" pos="0 -0.3 -0.1" euler="3 5 8"/>'
    )
    camera = PinholeCamera(640, 480, 300.0, 310.0, 319.5, 239.5, near=0.05, far=60.0)
    for yaw in (0.0, 0.4, -0.7):
        for pitch in (0.0, 0.3, 1.2):
            assert_matches_rays(model_of(floor_and_wall), looking((0, 0, 0.1), pitch=pitch, yaw=yaw), camera=camera)


def test_what_is_nearer_than_near_hides_what_is_behind():
    model = model_of('<geom type="plane" size="0 0 1"/><geom type="box" size="1 1 0.01" pos="0 0 0.95"/>')
    _, positions, rotations = posed(model)
    depth = rasterize_depth(geom_mesh(model), positions, rotations, CAMERA, looking((0, 0, 1.0), pitch=np.pi / 2))
    assert not depth.any()


def test_a_moved_block_is_seen_where_it_is():
    model = model_of(
        '<geom type="plane" size="0 0 1"/><body name="block" pos="1 0 0.1"><freejoint/>'
        '<geom type="box" size="0.2 0.1 0.1" mass="1"/></body>'
    )
    view = looking((0, 0, 1.1), pitch=0.8)
    before = posed(model)
    after = posed(model, (1.3, 0.25, 0.2, 0.9, 0.1, 0.2, 0.3))
    mesh = geom_mesh(model)
    images = [rasterize_depth(mesh, positions, rotations, CAMERA, view) for _, positions, rotations in (before, after)]
    assert np.count_nonzero(np.abs(images[0] - images[1]) > 0.01) > 1000
    errors, ours, theirs = compare_with_rays(model, *after, CAMERA, view)
    np.testing.assert_array_equal(ours, theirs)
    assert errors.max() <= BOX_ERROR


@pytest.mark.parametrize(
    ("geom", "error"),
    [
        ('type="sphere" size="0.3"', 0.02),
        ('type="ellipsoid" size="0.3 0.2 0.1"', 0.02),
        ('type="capsule" size="0.1 0.3" euler="70 20 10"', 0.02),
        ('type="cylinder" size="0.15 0.3" euler="60 30 0"', 0.02),
        ('type="mesh" mesh="wedge"', 1e-4),
    ],
)
def test_round_and_meshed_shapes_are_within_millimetres_of_rays(geom, error):
    wedge = '<mesh name="wedge" vertex="0 0 0  .5 0 0  0 .4 0  .5 .4 0  0 0 .3  0 .4 .3"/>'
    model = model_of(f'<geom pos="1 0 0.4" {geom}/><geom type="plane" size="0 0 1"/>', wedge)
    data, positions, rotations = posed(model)
    view = looking((0, 0, 1.0), pitch=0.6)
    errors, ours, theirs = compare_with_rays(model, data, positions, rotations, CAMERA, view, count=6000)
    np.testing.assert_array_equal(ours, theirs)
    assert np.count_nonzero(theirs == 0) > 100
    assert np.quantile(errors, 0.95) <= min(error, 3e-3)
    assert errors.max() <= error


def test_a_height_field_matches_rays():
    rng = np.random.default_rng(0)
    field = '<hfield name="hills" nrow="21" ncol="31" size="2 1.5 0.3 0.1"/>'
    model = model_of('<geom type="hfield" hfield="hills" pos="1.5 0 0"/>', field)
    model.hfield_data[:] = rng.uniform(0, 1, 21 * 31)
    data, positions, rotations = posed(model)
    view = looking((0.5, 0, 1.5), pitch=1.0)
    mesh = geom_mesh(model)
    depth = rasterize_depth(mesh, positions, rotations, CAMERA, view)
    pixels = rng.integers(0, (CAMERA.width, CAMERA.height), (2000, 2))
    reference, _ = ray_depth(model, data, CAMERA, view, pixels)
    errors = np.abs(depth[pixels[:, 1], pixels[:, 0]] - reference)
    # Ridges hide valleys: a few pixels fall on either side of such an edge.
    assert np.quantile(errors, 0.99) <= BOX_ERROR


def test_pixels_tell_their_geom():
    model = model_of('<geom type="plane" size="0 0 1"/><geom type="box" size="0.1 0.1 0.1" pos="1 0 0.1"/>')
    _, positions, rotations = posed(model)
    mesh = geom_mesh(model)
    raster = rasterize_faces(mesh, positions, rotations, CAMERA, looking((0, 0, 1.1), pitch=np.arctan(1.0)))
    geoms = mesh.face_geom_ids[raster.face]
    assert geoms[384, 512] == 1
    assert geoms[760, 512] == 0
    np.testing.assert_array_equal(raster.face >= 0, raster.depth > 0)


def test_invisible_and_hidden_groups_are_not_seen():
    model = model_of(
        '<geom type="box" size="1 1 1" rgba="1 0 0 0"/><geom type="box" size="1 1 1" group="3"/>'
        '<geom type="box" size="1 1 1" pos="5 0 0"/>'
    )
    assert geom_mesh(model).geom_ids.tolist() == [2]
    assert geom_mesh(model, groups=(3,)).geom_ids.tolist() == [1]


def test_back_faces_of_closed_shapes_and_of_planes_are_left_out_but_not_those_of_open_meshes():
    tent = '<mesh name="tent" inertia="shell" vertex="0 0 0 1 0 0 1 1 0 0 1 0 .5 .5 1" face="0 1 4 1 2 4 2 3 4 3 0 4"/>'
    model = model_of(
        '<geom type="plane" size="0 0 1"/><geom type="box" size="1 2 3"/><geom type="sphere" size="1"/>'
        '<geom type="capsule" size="1 2"/><geom type="cylinder" size="1 2"/><geom type="ellipsoid" size="1 2 3"/>'
        '<geom type="mesh" mesh="tent"/>',
        tent,
    )
    assert geom_mesh(model).one_sided.tolist() == [True] * 6 + [False]


def test_an_empty_scene_is_empty():
    model = mujoco.MjModel.from_xml_string("<mujoco/>")
    _, positions, rotations = posed(model)
    assert not rasterize_depth(geom_mesh(model), positions, rotations, CAMERA, Pose.identity()).any()


def test_touching_tiles_leave_no_gap():
    tiles = "".join(
        f'<geom type="box" size="0.05 0.05 0.05" pos="{0.1 * i} {0.1 * j} 0"/>'
        for i in range(-8, 9)
        for j in range(-8, 9)
    )
    model = model_of(tiles)
    _, positions, rotations = posed(model)
    depth = rasterize_depth(geom_mesh(model), positions, rotations, CAMERA, looking((0, 0, 0.9), pitch=1.5, yaw=0.3))
    assert depth.min() > 0
