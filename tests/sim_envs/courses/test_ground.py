from typing import Any

import mujoco as mujoco_module
import numpy as np
import pytest

from sim_envs.courses import Box, Ground, load_course
from skills.geometry.pose import Pose

mujoco: Any = mujoco_module  # Its binary module tells type checkers nothing.


def random_boxes(generator, count):
    return tuple(
        Box(
            f"box_{i}",
            tuple(generator.uniform(0.1, 0.6, 3)),
            Pose.from_xyz_rpy(generator.uniform(-0.6, 0.6, 3), generator.uniform(-np.pi, np.pi, 3)),
            "box",
        )
        for i in range(count)
    )


def multi_ray_down(boxes, points_xy, top=10.0):
    """Height and normal under points by MuJoCo, the independent reference."""
    geoms = "".join(
        f'<geom type="box" size="{b.size[0] / 2} {b.size[1] / 2} {b.size[2] / 2}" '
        f'pos="{" ".join(map(repr, map(float, b.T_world_box.p)))}" '
        f'quat="{" ".join(map(repr, map(float, b.T_world_box.quaternion_wxyz)))}"/>'
        for b in boxes
    )
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{geoms}</worldbody></mujoco>")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    heights = np.full(len(points_xy), -np.inf)
    normals = np.zeros((len(points_xy), 3))
    down, geom = np.array([0.0, 0.0, -1.0]), np.zeros(1, np.int32)
    for i, (x, y) in enumerate(points_xy):
        normal = np.zeros(3)
        distance = mujoco.mj_ray(model, data, np.array([x, y, top]), down, None, 1, -1, geom, normal)
        if distance >= 0:
            heights[i], normals[i] = top - distance, normal
    return heights, normals


def test_ground_is_what_a_ray_from_above_meets():
    generator = np.random.default_rng(0)
    for boxes in (random_boxes(generator, 12), load_course("rough", 3).boxes):
        xs = [box.T_world_box.p[0] for box in boxes]
        points: Any = np.column_stack((generator.uniform(min(xs), max(xs), 400), generator.uniform(-0.7, 0.7, 400)))
        expected_height, expected_normal = multi_ray_down(boxes, points)
        height, normal, box = Ground(boxes).surface(points)
        hit = np.isfinite(expected_height)
        assert 50 < np.count_nonzero(hit) < 400
        assert np.array_equal(hit, np.isfinite(height))
        np.testing.assert_allclose(height[hit], expected_height[hit], atol=1e-6)
        np.testing.assert_allclose(normal[hit], expected_normal[hit], atol=1e-5)
        assert np.array_equal(box >= 0, hit)
        assert np.all(normal[~hit] == 0.0)


def test_surface_point_lies_on_the_box_named():
    generator = np.random.default_rng(1)
    boxes = random_boxes(generator, 10)
    points = generator.uniform(-0.8, 0.8, (300, 2))
    height, _, index = Ground(boxes).surface(points)
    for (x, y), z, i in zip(points, height, index, strict=True):
        if i >= 0:
            local = boxes[i].T_world_box.inverse @ np.array([x, y, z])
            excess = np.abs(local) - np.array(boxes[i].size) / 2
            assert excess.max() == pytest.approx(0.0, abs=1e-7)


def test_penetration_is_the_way_to_the_nearest_face():
    box = Box("a", (2.0, 1.0, 0.5), Pose.from_xyz_rpy((1.0, 2.0, 3.0), (0.3, -0.2, 1.0)), "box")
    points_box = np.array([[0.0, 0.0, 0.24], [0.0, 0.49, 0.0], [0.0, 0.0, 0.30], [1.5, 0.0, 0.0], [0.0, 0.0, 0.0]])
    depth = Ground((box,)).penetration(box.T_world_box @ points_box)
    np.testing.assert_allclose(depth, [0.01, 0.01, -0.05, -0.5, 0.25], atol=1e-12)


def test_penetration_counts_the_deepest_box():
    boxes = (
        Box("a", (1.0, 1.0, 1.0), Pose.identity(), "box"),
        Box("b", (1.0, 1.0, 1.0), Pose.from_xyz_rpy((0.4, 0.0, 0.0)), "box"),
    )
    assert Ground(boxes).penetration(np.array([[0.45, 0.0, 0.0]]))[0] == pytest.approx(0.45)


def test_no_point_falls_between_boxes_that_touch():
    boxes = tuple(Box(f"b{i}", (0.37, 0.39, 0.3), Pose.from_xyz_rpy((0.37 * i, 0.0, 0.0)), "box") for i in range(30))
    seams: Any = np.column_stack(((np.arange(29) + 0.5) * 0.37, np.zeros(29)))
    np.testing.assert_allclose(Ground(boxes).ground_height(seams), 0.15, atol=1e-7)


def test_ground_follows_the_poses_given():
    box = Box("a", (1.0, 1.0, 1.0), Pose.identity(), "box")
    point = np.array([[0.0, 0.0]])
    assert Ground((box,)).ground_height(point)[0] == pytest.approx(0.5)
    assert Ground((box,), (Pose.from_xyz_rpy((0.0, 0.0, 2.0)),)).ground_height(point)[0] == pytest.approx(2.5)
    with pytest.raises(ValueError, match="got 0 poses, needs one for each of 1 boxes"):
        Ground((box,), ())


def test_no_boxes_are_all_pit():
    ground = Ground(())
    assert np.isneginf(ground.ground_height(np.zeros((3, 2)))).all()
    assert np.isneginf(ground.penetration(np.zeros((3, 3)))).all()
