"""A line of the control-rate log tells where the ground pushes, in whatever frame it is seen."""

import numpy as np
import pytest

from skills.footsteps.footstep import Side, Stance
from skills.geometry.pose import Pose
from skills.walking import ControlSample, WalkingPhase
from skills.walking.quadratic_program import QpStatus

STANCE = Stance(Pose.from_xyz_rpy((0.3, 0.12, 0.1), (0.1, -0.2, 0.3)), Pose.from_xyz_rpy((0.0, -0.12, 0.0)))


def _pressed_at(point_sole, force):
    """The wrench of a force along the sole's normal at a point of it."""
    arm, along = np.array((*point_sole, 0.0)), np.array((0.0, 0.0, force))
    return np.concatenate((along, np.cross(arm, along)))


def _sample(commanded, measured):
    points = {name: np.zeros(3) for name in ("com_world", "dcm_world", "dcm_reference_world", "cmp_world")}
    return ControlSample(
        time=1.0,
        phase=WalkingPhase.TRANSFER,
        **points,
        dcm_error=0.0,
        angular_momentum_world=np.array((1.0, 2.0, 3.0)),
        stance=STANCE,
        wrenches_sole=commanded,
        measured_wrenches_sole=measured,
        torque_shares=np.zeros(23),
        support_world=np.array(((0.0, 0.0), (1.0, 0.0), (0.0, 1.0))),
        qp_status=QpStatus.SOLVED,
        qp_iterations=10,
        qp_time=1e-4,
    )


def test_the_cop_lies_between_the_soles_where_their_forces_balance():
    left, right = (0.05, -0.03), (-0.02, 0.01)
    wrenches = {Side.LEFT: _pressed_at(left, 300.0), Side.RIGHT: _pressed_at(right, 900.0)}
    points = [STANCE.sole(side) @ np.array((*p, 0.0)) for side, p in ((Side.LEFT, left), (Side.RIGHT, right))]
    sample = _sample(wrenches, {})
    np.testing.assert_allclose(sample.cop_world, 0.25 * points[0] + 0.75 * points[1])
    assert np.all(np.isnan(sample.cop_measured_world)) and np.isnan(sample.load(Side.LEFT))


def test_a_sole_that_is_pressed_beside_where_it_was_commanded_shows_as_an_error():
    commanded = {Side.LEFT: _pressed_at((0.04, 0.0), 1700.0), Side.RIGHT: np.zeros(6)}
    measured = {Side.LEFT: _pressed_at((-0.03, 0.0), 1700.0), Side.RIGHT: np.zeros(6)}
    sample = _sample(commanded, measured)
    assert sample.cop_error == pytest.approx(0.07)
    assert sample.stands_on(Side.LEFT) and not sample.stands_on(Side.RIGHT)
    assert sample.load(Side.LEFT) == 1700.0


def test_points_and_momentum_move_together_with_the_frame():
    wrenches = {side: _pressed_at((0.02, 0.03), 800.0) for side in Side}
    sample, T = _sample(wrenches, wrenches), Pose.from_xyz_rpy((1.0, -2.0, 0.0), (0.0, 0.0, 0.7))
    moved = sample.moved(T)
    np.testing.assert_allclose(moved.cop_world, T @ sample.cop_world)
    np.testing.assert_allclose(moved.angular_momentum_world, T.R @ sample.angular_momentum_world)
    np.testing.assert_allclose(moved.support_world, (T @ np.column_stack((sample.support_world, np.zeros(3))))[:, :2])
    assert moved.cop_error == pytest.approx(sample.cop_error, abs=1e-12)
