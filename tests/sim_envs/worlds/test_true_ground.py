"""The true ground is what a ray from above meets."""

# mujoco keeps its types in binary modules without stubs.
# pyright: reportAttributeAccessIssue=false

import mujoco
import numpy as np

from sim_envs.worlds.true_ground import PIT, TrueGround
from skills.geometry.pose import Pose


def _random_boxes(rng, count):
    sizes = rng.uniform(0.1, 0.5, (count, 3))
    poses = tuple(Pose.from_xyz_rpy(rng.uniform(-1, 1, 3), rng.uniform(-1, 1, 3)) for _ in range(count))
    return sizes, poses


def _ray_heights(sizes, poses, points):
    spec = mujoco.MjSpec()
    for size, pose in zip(sizes, poses, strict=True):
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_BOX, size=0.5 * size, pos=pose.p, quat=pose.quaternion_wxyz)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    top, down, geom = 10.0, np.array([0.0, 0.0, -1.0]), np.zeros(1, np.int32)
    distances = np.array(
        [mujoco.mj_ray(model, data, np.array([x, y, top]), down, None, 1, -1, geom) for x, y in points]
    )
    return np.where(distances < 0, PIT, top - distances)


def test_heights_are_where_rays_from_above_end():
    rng = np.random.default_rng(3)
    sizes, poses = _random_boxes(rng, 30)
    points = rng.uniform(-1.5, 1.5, (500, 2))
    expected = _ray_heights(sizes, poses, points)
    heights = TrueGround(sizes, poses).heights(points)
    np.testing.assert_array_equal(np.isfinite(heights), np.isfinite(expected))
    assert np.isfinite(heights).mean() > 0.3
    np.testing.assert_allclose(heights[np.isfinite(heights)], expected[np.isfinite(heights)], atol=1e-9)


def test_a_moved_box_takes_its_ground_along():
    sizes, poses = np.array([[0.4, 0.4, 0.2]]), (Pose.identity(),)
    ground = TrueGround(sizes, poses)
    points = np.array([[0.0, 0.0], [1.0, 0.0]])
    np.testing.assert_allclose(ground.heights(points), (0.1, PIT))
    ground.move(0, Pose.from_xyz_rpy((1.0, 0.0, 0.3)))
    np.testing.assert_allclose(ground.heights(points), (PIT, 0.4))
