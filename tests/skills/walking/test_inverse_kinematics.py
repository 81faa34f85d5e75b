import numpy as np
import pytest

from skills.footsteps.footstep import Side, Stance
from skills.geometry.pose import Pose, rotation_y, rotation_z
from skills.walking import RobotModel, WalkingParameters
from skills.walking.inverse_kinematics import InverseKinematics
from skills.walking.posture import standing_configuration


def random_stance(seed: int) -> Stance:
    rng = np.random.default_rng(seed)
    poses = []
    for side in Side:
        x, y, z = rng.uniform((-0.2, 0.08, -0.08), (0.2, 0.18, 0.08))
        poses.append(Pose.from_xyz_rpy((x, side.sign * y, z), rng.uniform(-0.15, 0.15, 3)))
    return Stance(*poses)


@pytest.mark.parametrize("seed", range(20))
def test_com_pelvis_and_soles_are_where_they_should_be(model: RobotModel, stance: Stance, seed: int) -> None:
    q = standing_configuration(model, stance, WalkingParameters())
    target, R = random_stance(seed), rotation_z(0.1) @ rotation_y(0.05)
    com = np.array((*target.mid_feet[:2], 1.05))
    solution = InverseKinematics(model).solve(q, com, R, target, 50, 1e-10)
    np.testing.assert_allclose(model.com(solution.q), com, atol=1e-8)
    np.testing.assert_allclose(model.pelvis_pose(solution.q).R, R, atol=1e-7)
    for side in Side:
        np.testing.assert_allclose(model.sole_pose(solution.q, side).p, target.sole(side).p, atol=1e-8)
        np.testing.assert_allclose(model.sole_pose(solution.q, side).R, target.sole(side).R, atol=1e-7)
    assert np.all(solution.q[7:] >= model.lower_limits)
    assert np.all(solution.q[7:] <= model.upper_limits)
    np.testing.assert_array_equal(solution.q[19:], q[19:])


def test_a_com_too_high_gives_way_to_the_soles(model: RobotModel, stance: Stance) -> None:
    q = standing_configuration(model, stance, WalkingParameters())
    solution = InverseKinematics(model).solve(q, np.array((0.0, 0.0, 1.4)), np.eye(3), stance, 200, 1e-10)
    assert solution.height_error < -0.1
    assert max(solution.left_error, solution.right_error) < 0.1 * abs(solution.height_error)
    assert solution.com_error < 0.01


def test_a_foothold_out_of_reach_leaves_an_honest_residual(model: RobotModel, stance: Stance) -> None:
    q = standing_configuration(model, stance, WalkingParameters())
    far = stance.with_sole(Side.LEFT, Pose.from_xyz_rpy((1.8, 0.12, 0.0)))
    solution = InverseKinematics(model).solve(q, np.array((0.0, 0.0, 1.1)), np.eye(3), far, 200, 1e-10)
    reached = model.sole_pose(solution.q, Side.LEFT).p
    assert solution.left_error == pytest.approx(np.linalg.norm(reached - far.T_world_left.p))
    assert solution.left_error > 0.1
    assert np.all(solution.q[7:] >= model.lower_limits)
    assert np.all(solution.q[7:] <= model.upper_limits)
