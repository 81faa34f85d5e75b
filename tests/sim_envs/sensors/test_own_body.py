"""Capsules contain what they cover, and little more."""

# pyright: reportAttributeAccessIssue=false
import mujoco
import numpy as np
import pytest

from sim_envs.sensors import Snapshot, own_body
from skills.geometry.pose import Pose

FOOT = (0.130, 0.069, 0.012)
SURFACES = {
    "sphere": ('type="sphere" size="0.1"', 0.0),
    "capsule": ('type="capsule" size="0.05 0.2"', 0.0),
    "ellipsoid": ('type="ellipsoid" size="0.3 0.2 0.18"', 0.03),
    "cylinder": ('type="cylinder" size="0.05 0.2"', 0.04),
    "disc": ('type="cylinder" size="0.1 0.02"', 0.09),
    "foot": (f'type="box" size="{FOOT[0]} {FOOT[1]} {FOOT[2]}"', 0.011),
    "upright plate": ('type="box" size="0.012 0.105 0.13"', 0.011),
    "wedge": ('type="mesh" mesh="wedge"', 0.3),
}


def body_of(geom: str):
    """The own body of a robot that is one geom, and a snapshot of it where it stands askew."""
    asset = '<asset><mesh name="wedge" vertex="0 0 0  .5 0 0  0 .4 0  .5 .4 0  0 0 .3  0 .4 .3"/></asset>'
    model = mujoco.MjModel.from_xml_string(
        f'<mujoco>{asset}<worldbody><geom type="plane" size="0 0 1"/><body pos="1 2 3" euler="20 30 40">'
        f'<freejoint/><geom {geom} mass="1"/></body></worldbody></mujoco>'
    )
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    rotations = data.geom_xmat.reshape(-1, 3, 3).copy()
    return own_body(model, 1), model, data, Snapshot(0.0, 0, data.geom_xpos.copy(), rotations, Pose.identity())


def everything(centers, radii):
    return np.full(len(radii), True)


def distances(points, capsules):
    """Of points (N, 3) from the nearest capsule's surface, negative inside, (N,)."""
    away = []
    for capsule in capsules:
        axis, p = capsule.end_world - capsule.start_world, points - capsule.start_world
        share = np.clip(p @ axis / max(axis @ axis, 1e-12), 0.0, 1.0)
        away.append(np.linalg.norm(p - share[:, None] * axis, axis=1) - capsule.radius)
    return np.min(away, axis=0)


def surface_points(model, data):
    """Where rays from all sides meet the geom."""
    rng = np.random.default_rng(0)
    geom, groups = np.zeros((1, 1), dtype=np.int32), np.array((1, 1, 1, 0, 0, 0), dtype=np.uint8)
    center, points = data.geom_xpos[1], []
    for inward, side in zip(rng.normal(size=(4000, 3)), rng.normal(size=(4000, 3)), strict=True):
        inward = inward / np.linalg.norm(inward)
        start = center - 2.0 * inward + 0.08 * np.cross(inward, side)
        reach = mujoco.mj_ray(model, data, start, inward, groups, 0, -1, geom, None)
        if reach >= 0.0:
            points.append(start + reach * inward)
    return np.array(points)


@pytest.mark.parametrize("shape", SURFACES)
def test_capsules_contain_a_shape_and_reach_little_beyond_it(shape):
    geom, most = SURFACES[shape]
    body, model, data, instant = body_of(geom)
    capsules = body.capsules(instant, 0.0, everything)
    points = surface_points(model, data)
    assert len(points) > 300
    assert distances(points, capsules).max() < 1e-6
    for direction in np.random.default_rng(1).normal(size=(300, 3)):
        d = direction / np.linalg.norm(direction)
        reach = max(max(c.start_world @ d, c.end_world @ d) + c.radius for c in capsules)
        assert reach - (points @ d).max() < most + 0.01  # the points lie up to 1 cm from the shape's utmost


def test_a_foot_blinds_less_than_two_centimetres_of_the_ground_around_it():
    body, _, data, instant = body_of(SURFACES["foot"][0])
    capsules = body.capsules(instant, 0.0, everything)
    x, y = np.meshgrid(np.linspace(-0.3, 0.3, 121), np.linspace(-0.2, 0.2, 81))
    beyond = (np.abs(x) > FOOT[0] + 0.011) | (np.abs(y) > FOOT[1] + 0.011)
    around = np.column_stack((x[beyond], y[beyond], np.full(beyond.sum(), -FOOT[2])))
    assert distances(around @ instant.geom_rotations[1].T + data.geom_xpos[1], capsules).min() > 0.0


def test_a_margin_thickens_all_capsules():
    body, _, _, instant = body_of(SURFACES["capsule"][0])
    assert [c.radius for c in body.capsules(instant, 0.02, everything)] == pytest.approx([0.07])


def test_capsules_follow_the_estimate_and_leave_out_what_is_not_in_view():
    body, _, _, instant = body_of(SURFACES["foot"][0])
    T = Pose.from_xyz_rpy((0.5, -0.2, 0.1), (0.0, 0.0, 0.4))
    believed = Snapshot(0.0, 0, instant.geom_positions, instant.geom_rotations, instant.T_world_sensor, T)
    for true, estimated in zip(
        body.capsules(instant, 0.0, everything), body.capsules(believed, 0.0, everything), strict=True
    ):
        np.testing.assert_allclose(estimated.start_world, T @ true.start_world, atol=1e-12)
        np.testing.assert_allclose(estimated.end_world, T @ true.end_world, atol=1e-12)
    assert body.capsules(instant, 0.0, lambda centers, radii: np.full(len(radii), False)) == ()


def test_the_ground_is_no_part_of_the_robot():
    body, _, _, _ = body_of(SURFACES["sphere"][0])
    assert body.geom_ids.tolist() == [1]
