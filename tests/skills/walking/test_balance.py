"""Where balance wants the CoM to accelerate, in postures and motions given by hand."""

from collections.abc import Callable

import numpy as np
import pytest

from skills.footsteps.footstep import Footstep, Stance
from skills.geometry.pose import Array
from skills.walking import RobotModel, SwingParameters, WalkingParameters, WholeBodyParameters
from skills.walking.balance import Balance
from skills.walking.body_dynamics import BodyDynamics
from skills.walking.gait import Gait
from skills.walking.posture import standing_configuration

GRAVITY = 9.81
PARAMETERS, BODY_PARAMETERS = WalkingParameters(), WholeBodyParameters()
DT = 0.002


class Standing:
    """A robot at rest in balance; `moving` lets its whole body move at a velocity."""

    def __init__(self, model: RobotModel, stance: Stance) -> None:
        self.gait = Gait(stance, model.foothold_sole, PARAMETERS, SwingParameters())
        self.body = BodyDynamics(model)
        self.q = standing_configuration(model, stance, PARAMETERS)
        self.balance = Balance(self.gait, model, PARAMETERS, BODY_PARAMETERS)
        self.moving(np.zeros(3))
        self.balance.replan(self.body, 0.0)

    def moving(self, velocity_world: Array) -> None:
        v = np.zeros(self.body.model.pin_model.nv)
        v[:3] = self.body.model.pelvis_pose(self.q).R.T @ velocity_world
        self.body.update(self.q, v)


@pytest.fixture
def standing(model: RobotModel, stance: Stance) -> Standing:
    return Standing(model, stance)


def test_at_rest_it_asks_for_rest(standing: Standing) -> None:
    command = standing.balance.control(standing.body, DT)
    np.testing.assert_allclose(command.com_acceleration, 0.0, atol=1e-3)
    np.testing.assert_allclose(command.cmp, standing.gait.stance.mid_feet[:2], atol=1e-3)
    assert command.clipped == 0.0
    assert standing.balance.omega == pytest.approx(np.sqrt(GRAVITY / PARAMETERS.com_height))


@pytest.mark.parametrize("direction", ((1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.6, -0.8)))
def test_a_dcm_that_leaves_its_plan_is_pushed_back_from_beyond_it(
    standing: Standing, direction: tuple[float, float]
) -> None:
    along = np.array(direction)
    standing.moving(np.append(0.05 * along, 0.0))
    command = standing.balance.control(standing.body, DT)
    balance = standing.balance
    error = balance.dcm - balance.dcm_reference
    np.testing.assert_allclose(error, 0.05 * along / balance.omega, atol=1e-3)
    assert balance.dcm_error == pytest.approx(np.linalg.norm(error))
    # The DCM runs away from the CMP: it comes back where the CMP is farther out than it is.
    assert along @ (command.cmp - balance.dcm) > 0.0
    assert along @ command.com_acceleration[:2] < 0.0
    rate = balance.omega * (balance.dcm - command.cmp)
    np.testing.assert_allclose(rate, -PARAMETERS.dcm_gain * error, atol=5e-3)


def test_the_cmp_leaves_the_soles_by_no_more_than_it_may(standing: Standing) -> None:
    standing.moving(np.array((1.0, 0.3, 0.0)))
    command = standing.balance.control(standing.body, DT)
    assert standing.gait.support().distance(command.cmp) == pytest.approx(PARAMETERS.cmp_excess, abs=1e-9)
    assert command.clipped > 0.1


@pytest.mark.parametrize(("speed", "limit"), ((3.0, -0.4), (-3.0, 0.6)))
def test_the_com_height_accelerates_within_its_limits(standing: Standing, speed: float, limit: float) -> None:
    standing.moving(np.array((0.0, 0.0, speed)))
    command = standing.balance.control(standing.body, DT)
    assert command.com_acceleration[2] == pytest.approx(limit * GRAVITY)


def test_a_dcm_far_out_and_off_its_plan_is_a_fall_and_nearer_ones_are_none(standing: Standing) -> None:
    edge = standing.gait.catching_support().hull_world[:, 0].max()
    for beyond, lost in ((-0.02, False), (0.04, False), (0.07, True)):
        speed = standing.balance.omega * (edge + beyond - standing.body.com[0])
        standing.moving(np.array((speed, 0.0, 0.0)))
        standing.balance.control(standing.body, DT)
        told = standing.balance.fall()
        assert bool(told) == lost
    assert told.startswith("balance is lost: the DCM is 7 cm outside the feet, ")


def test_double_support_is_held_while_it_can_bring_the_dcm_back(
    standing: Standing, make_steps: Callable[..., tuple[Footstep, ...]]
) -> None:
    balance, gait = standing.balance, standing.gait
    gait.accept(make_steps(2))
    balance.replan(standing.body, 0.0)
    for error, hold in ((0.0, False), (0.02, False), (0.05, True), (0.4, False)):
        standing.moving(np.array((balance.omega * error, 0.0, 0.0)))
        balance.control(standing.body, DT)
        assert balance.must_hold() == hold, error
    standing.moving(np.array((balance.omega * 0.05, 0.0, 0.0)))
    gait.hold(PARAMETERS.hold_limit)
    balance.control(standing.body, DT)
    assert not balance.must_hold()


def test_the_plan_ends_its_phase_where_the_next_support_can_take_over(
    standing: Standing, make_steps: Callable[..., tuple[Footstep, ...]]
) -> None:
    standing.gait.accept(make_steps(3))
    standing.balance.replan(standing.body, 0.0)
    at_lift_off = standing.balance.dcm_at_landing
    # The left foot goes first: the weight is over the right one, and on its way back to the left.
    assert -0.12 < at_lift_off[1] < -0.05
    assert at_lift_off[0] > 0.0
