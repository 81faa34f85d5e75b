"""Steps are changed only where the CoP cannot save the balance, and then as well as limits and ground allow."""

from math import exp

import numpy as np
import pytest

from skills.footsteps.footstep import Footstep, Side
from skills.geometry.pose import Array, Pose
from skills.walking import StepAdjustmentParameters
from skills.walking.step_adjustment import AS_COMMANDED, StepAdjustment, SwingState
from skills.walking.support_polygon import SupportPolygon, foothold_corners

OMEGA = 2.96
PARAMETERS = StepAdjustmentParameters()
SOLE = 0.5 * np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]]) * (0.26, 0.138)
SQUARE = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
STANCE = Pose.from_xyz_rpy((0.0, -0.12, 0.0))


def swing(dcm_off: tuple[float, float], region: Array = 0.5 * SQUARE, remaining: float = 0.4) -> SwingState:
    """A left step 0.35 m ahead, with the DCM off where it would have to be for its plan."""
    step = Footstep(0, Side.LEFT, Pose.from_xyz_rpy((0.35, 0.12, 0.0)), SOLE, 0.8, 0.3, 0.1, np.zeros((0, 3)), region)
    cop, at_landing = np.array((0.01, -0.115)), np.array((0.27, 0.02))
    dcm = cop + (at_landing - cop) * exp(-OMEGA * remaining)
    support = SupportPolygon([foothold_corners(STANCE, SOLE, 0.01)])
    return SwingState(step, STANCE, support, dcm + np.array(dcm_off), at_landing, remaining)


@pytest.fixture
def adjustment() -> StepAdjustment:
    return StepAdjustment(OMEGA, PARAMETERS)


def test_a_dcm_on_its_plan_changes_nothing(adjustment: StepAdjustment) -> None:
    assert adjustment.landing(swing((0.0, 0.0))) is AS_COMMANDED


def test_an_error_that_the_cop_can_hold_changes_nothing(adjustment: StepAdjustment) -> None:
    assert adjustment.landing(swing((0.03, 0.01))) is AS_COMMANDED


def test_a_step_without_other_ground_lands_as_commanded(adjustment: StepAdjustment) -> None:
    assert adjustment.landing(swing((0.3, 0.2), np.zeros((0, 2)))) is AS_COMMANDED


def test_a_foot_about_to_land_lands_as_commanded(adjustment: StepAdjustment) -> None:
    assert adjustment.landing(swing((0.3, 0.2), remaining=0.0)) is AS_COMMANDED


@pytest.mark.parametrize("off", ((0.15, 0.0), (0.0, 0.15), (-0.2, 0.05), (0.1, -0.15), (0.25, 0.2)))
def test_the_landing_is_the_best_of_a_fine_grid(adjustment: StepAdjustment, off: tuple[float, float]) -> None:
    it, p = swing(off, 0.15 * SQUARE), PARAMETERS
    landing = adjustment.landing(it)
    planned = exp(OMEGA * it.remaining)
    cop = it.support.nearest((it.dcm_at_landing - planned * it.dcm) / (1.0 - planned))
    nominal = it.step.T_world_sole.p[:2]

    def cost(u: Array, tau: Array) -> Array:
        b = cop + (it.dcm - cop) * tau[..., None] - u
        off_plan = np.sum((b - (it.dcm_at_landing - nominal)) ** 2, axis=-1)
        moved = np.sum((u - nominal) ** 2, axis=-1)
        return moved + p.time_weight * (tau - planned) ** 2 + p.offset_weight * off_plan

    # Within the good ground, within reach of the stance foot at y = -0.12, and the pace of the swing.
    x = np.linspace(max(0.2, -p.backward), min(0.5, p.forward), 61)
    y = np.linspace(max(-0.03, -0.12 + p.narrowest), min(0.27, -0.12 + p.widest), 61)
    taus = np.exp(OMEGA * it.remaining / np.linspace(p.slowest, p.fastest, 81))
    grid_u = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)[..., None, :]
    best = float(np.min(cost(grid_u, taus[None, None, :])))
    u, tau = nominal + landing.shift, np.array(exp(OMEGA * it.remaining / landing.pace))
    assert float(cost(u, tau)) <= best * (1.0 + 1e-3) + 1e-6
    assert np.all(np.abs(landing.shift) <= 0.15 + 1e-4)
    assert p.slowest - 1e-6 <= landing.pace <= p.fastest + 1e-6


def test_the_foot_does_not_cross_the_standing_leg(adjustment: StepAdjustment) -> None:
    landing = adjustment.landing(swing((0.0, -0.4)))
    y = 0.12 + landing.shift[1]
    assert y - STANCE.p[1] >= PARAMETERS.narrowest - 1e-4


def test_a_dcm_pushed_to_where_the_foot_goes_is_met_there_and_sooner(adjustment: StepAdjustment) -> None:
    landing = adjustment.landing(swing((0.2, 0.2)))
    assert landing.shift[0] > 0.02 and landing.shift[1] > 0.02
    assert landing.pace > 1.0
