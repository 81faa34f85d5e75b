# pyright: reportAttributeAccessIssue=false
import mujoco
import numpy as np
import pytest

from sim_envs.picture import (
    LightParameters,
    Overlay,
    PictureStyle,
    beside_robot,
    line,
    orbit_view,
    outline,
    picture_camera,
    picture_of,
    planned_steps,
    region_outlines,
)
from sim_envs.picture.light import Casters, light_on, sky_directions, sun_directions
from sim_envs.picture.overlays import project
from sim_envs.picture.surfaces import linear, srgb, surfaces_of
from sim_envs.sensors import geom_mesh, rasterize_faces
from skills.footsteps.footstep import Footstep, Side
from skills.geometry.pose import Pose
from skills.regions.planar_region import PlanarRegion

CAMERA = picture_camera(160, 120)
VIEW = orbit_view((0, 0, 0), distance=4.0, azimuth=-0.8, elevation=0.5)
FAST = LightParameters(sun_lights=8, sky_lights=32, map_size=128)
PLAIN = PictureStyle(outline=0.0, gloss=0.0)
SQUARE = np.array([[-0.3, -0.3, 0.0], [0.3, -0.3, 0.0], [0.3, 0.3, 0.0], [-0.3, 0.3, 0.0]])
SLAB = '<geom type="box" size="1 1 0.1" pos="0 0 -0.1" rgba="0.6 0.6 0.6 1"/>'
RED = (1.0, 0.0, 0.0)


def scene(geoms: str):
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{geoms}</worldbody></mujoco>")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data.geom_xpos.copy(), data.geom_xmat.reshape(-1, 3, 3).copy()


def pixel_of(p_world, camera=CAMERA, view=VIEW):
    x, y, z = view.inverse @ np.asarray(p_world, dtype=np.float64)
    return round(camera.cy + camera.fy * y / z), round(camera.cx + camera.fx * x / z)


def casters_of(geoms: str) -> Casters:
    model, positions, rotations = scene(geoms)
    return Casters(geom_mesh(model), positions, rotations, np.zeros(3), 2.0)


def test_the_same_scene_gives_the_same_picture():
    snapshot = scene(SLAB + '<geom type="sphere" size="0.3" pos="0 0 0.3"/>')
    one, other = (picture_of(*snapshot, CAMERA, VIEW, light=FAST) for _ in range(2))
    assert (one.shape, one.dtype) == ((120, 160, 3), np.uint8)
    np.testing.assert_array_equal(one, other)


def test_an_empty_scene_is_the_backdrop():
    style = PictureStyle(backdrop_top=(0.5, 0.5, 0.5), backdrop_bottom=(1.0, 1.0, 1.0))
    picture = picture_of(*scene(""), CAMERA, VIEW, light=FAST, style=style)
    assert picture[0].mean() == pytest.approx(128, abs=1)
    assert picture[-1].mean() == pytest.approx(255, abs=1)
    assert np.ptp(picture, axis=1).max() == 0


def test_a_block_throws_its_shadow_away_from_the_sun():
    light = LightParameters(sun_azimuth_deg=90.0, sun_elevation_deg=45.0, sun_lights=4, sky_lights=8, map_size=256)
    block = '<geom type="box" size="0.1 0.1 0.2" pos="0 0 0.2"/>'
    picture = picture_of(*scene(SLAB + block), CAMERA, VIEW, light=light, style=PLAIN).astype(int).sum(axis=2)
    right = VIEW.R[:, 0] * (1, 1, 0)
    assert picture[pixel_of(0.3 * right)] < 0.8 * picture[pixel_of(-0.3 * right)]


def test_an_overlay_colours_the_surface_it_lies_on():
    snapshot = scene(SLAB)
    plain = picture_of(*snapshot, CAMERA, VIEW, light=FAST, style=PLAIN)
    painted = picture_of(*snapshot, CAMERA, VIEW, light=FAST, style=PLAIN, overlays=[Overlay((SQUARE,), RED, 1.0)])
    red, green, blue = painted[pixel_of((0, 0, 0))]
    assert red > 100 > 20 > max(green, blue)
    np.testing.assert_array_equal(plain[pixel_of((0.7, 0.7, 0))], painted[pixel_of((0.7, 0.7, 0))])


def test_an_overlay_behind_a_block_is_hidden_and_one_before_it_is_seen():
    snapshot = scene('<geom type="box" size="0.5 0.5 0.5" rgba="0.6 0.6 0.6 1"/>')
    behind, before = (Overlay((SQUARE @ VIEW.R.T + shift * VIEW.R[:, 2],), RED, 1.0) for shift in (1.5, -1.5))
    pictures = [
        picture_of(*snapshot, CAMERA, VIEW, light=FAST, style=PLAIN, overlays=overlays)
        for overlays in ((), (behind,), (before,))
    ]
    center = pixel_of((0, 0, 0))
    np.testing.assert_array_equal(pictures[0][center], pictures[1][center])
    np.testing.assert_array_equal(pictures[2][center], (255, 0, 0))


def test_an_overlay_that_passes_the_lens_is_cut_there():
    floor = np.array([[-50.0, -50.0, 0.0], [50.0, -50.0, 0.0], [50.0, 50.0, 0.0], [-50.0, 50.0, 0.0]])
    layer = project(Overlay((floor,), RED, 1.0), CAMERA, VIEW)
    v, u = np.divmod(layer.pixels, CAMERA.width)
    rays = np.column_stack(((u - CAMERA.cx) / CAMERA.fx, (v - CAMERA.cy) / CAMERA.fy, np.ones(len(u))))
    expected = -VIEW.p[2] / (rays @ VIEW.R[2])
    assert len(layer.pixels) > 0.9 * CAMERA.width * CAMERA.height
    np.testing.assert_allclose(layer.depth, expected, rtol=1e-4)


def test_an_open_sky_and_a_high_sun_light_a_level_plane_fully():
    level, up = np.zeros((8, 3), np.float32), np.tile(np.array((0, 0, 1), dtype=np.float32), (8, 1))
    share = np.arange(8) % 4
    parameters = LightParameters(sun_elevation_deg=90.0)
    nothing = casters_of("")
    sky = light_on(level, up, share, 4, nothing, sky_directions(parameters), 64)
    np.testing.assert_allclose(sky, 0.5, atol=0.01)
    sun = light_on(level, up, share, 4, nothing, sun_directions(parameters, 0.3), 64)
    np.testing.assert_allclose(sun, 1.0, atol=0.01)


def test_no_light_falls_under_a_roof_and_half_of_the_sky_beside_a_wall():
    up = np.array([[0, 0, 1]], dtype=np.float32)
    origin, share = np.zeros((1, 3), np.float32), np.zeros(1, np.int64)
    sky = sky_directions(LightParameters())
    roof = casters_of('<geom type="box" size="20 20 0.1" pos="0 0 0.6"/>')
    assert light_on(origin, up, share, 1, roof, sky, 256).item() < 0.02
    wall = casters_of('<geom type="box" size="0.1 40 40" pos="0.11 0 0"/>')
    assert light_on(origin, up, share, 1, wall, sky, 256).item() == pytest.approx(0.25, abs=0.03)


@pytest.mark.parametrize("geom", ['type="sphere" size="0.5"', 'type="capsule" size="0.3 0.3"'])
def test_round_shapes_are_shaded_round(geom):
    model, positions, rotations = scene(f"<geom {geom}/>")
    mesh = geom_mesh(model)
    raster = rasterize_faces(mesh, positions, rotations, CAMERA, VIEW)
    surfaces = surfaces_of(model, mesh, raster, positions, rotations, CAMERA, VIEW)
    axis_point = surfaces.points_world.copy()
    axis_point[:, :2] = 0
    axis_point[:, 2] = np.clip(axis_point[:, 2], -0.3, 0.3) if "capsule" in geom else 0
    outward = surfaces.points_world - axis_point
    outward /= np.linalg.norm(outward, axis=1, keepdims=True)
    np.testing.assert_allclose(surfaces.normals_world, outward, atol=1e-4)


def test_boxes_are_flat_but_for_their_worn_edges():
    model, positions, rotations = scene('<geom type="box" size="0.5 0.5 0.5"/>')
    mesh = geom_mesh(model)
    raster = rasterize_faces(mesh, positions, rotations, CAMERA, VIEW)
    surfaces = surfaces_of(model, mesh, raster, positions, rotations, CAMERA, VIEW)
    flat = np.isclose(np.abs(surfaces.normals_world).max(axis=1), 1, atol=1e-5)
    inside = (np.abs(surfaces.points_world) < 0.5 - 0.007).sum(axis=1) == 2
    assert flat[inside].all()
    assert not flat.all()
    np.testing.assert_allclose(np.linalg.norm(surfaces.normals_world, axis=1), 1, atol=1e-5)


def test_colour_conversions_are_inverse():
    values = np.linspace(0, 1, 101)
    np.testing.assert_allclose(srgb(linear(values).astype(np.float32)), values, atol=1e-5)


def test_an_outline_stays_inside_its_polygon():
    rim = outline(SQUARE, RED, width=0.05)
    points = np.concatenate(rim.polygons_world)
    assert np.abs(points[:, :2]).max() <= 0.3 + 1e-12
    assert np.abs(points[:, :2]).max(axis=1).min() >= 0.25 - 1e-12


def test_a_line_faces_its_viewer_with_its_width():
    (ribbon,) = line([(0, 0, 0), (1, 0, 0)], RED, width=0.1, seen_from=(0.5, 0, 5)).polygons_world
    assert np.linalg.norm(ribbon[0] - ribbon[3]) == pytest.approx(0.1)
    np.testing.assert_allclose(ribbon[:, 2], 0, atol=0.01)


def test_plans_and_regions_become_overlays_in_their_planes():
    sole = np.array([[0.13, 0.07], [-0.13, 0.07], [-0.13, -0.07], [0.13, -0.07]])
    T = Pose.from_xyz_rpy((0.4, 0.1, 0.2), (0.0, 0.1, 0.3))
    step = Footstep(0, Side.LEFT, T, sole, 0.9, 0.3, 0.1, np.zeros((0, 3)))
    region = PlanarRegion(T, 2 * sole, (2 * sole,), 0.14, 0.0)
    for overlay in (*planned_steps([step]), *region_outlines([region], [RED])):
        points = np.concatenate(overlay.polygons_world)
        np.testing.assert_allclose((points - T.p) @ T.R[:, 2], 0, atol=1e-12)


def test_the_view_beside_a_robot_turns_with_it():
    ahead, turned = (beside_robot(Pose.from_xyz_rpy((1, 2, 0.9), (0, 0, yaw))) for yaw in (0.0, 1.0))
    np.testing.assert_allclose(turned.p - (1, 2, 0), Pose.from_xyz_rpy((0, 0, 0), (0, 0, 1.0)) @ (ahead.p - (1, 2, 0)))
