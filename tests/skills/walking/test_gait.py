"""What the feet do, without a body: phases, queue and support."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from skills.footsteps.footstep import Footstep, Side, Stance
from skills.geometry.pose import Pose
from skills.walking import RobotModel, SwingParameters, WalkingParameters, WalkingPhase
from skills.walking.gait import Gait, toe_points

MakeSteps = Callable[..., tuple[Footstep, ...]]


@pytest.fixture
def gait(model: RobotModel, stance: Stance) -> Gait:
    return Gait(stance, model.foothold_sole, WalkingParameters(cop_margin=0.0), SwingParameters())


def lift(gait: Gait) -> None:
    assert gait.step is not None
    gait.lift_off(gait.stance.sole(gait.step.side))


def test_a_step_is_a_transfer_and_a_swing_and_the_last_one_ends_standing(gait: Gait, make_steps: MakeSteps) -> None:
    first, second = make_steps(2)
    assert (gait.phase, gait.last_sequence_id) == (WalkingPhase.STANDING, -1)
    gait.accept((first, second))
    # From standing the weight shifts no faster than is safe.
    assert (gait.phase, gait.duration) == (WalkingPhase.TRANSFER, 0.7)
    lift(gait)
    assert (gait.phase, gait.duration, gait.step, gait.queue) == (WalkingPhase.SWING, 0.8, first, (second,))
    gait.land(first.T_world_sole)
    assert (gait.phase, gait.duration, gait.step, gait.queue) == (WalkingPhase.TRANSFER, 0.3, second, ())
    lift(gait)
    gait.land(second.T_world_sole)
    assert (gait.phase, gait.duration, gait.step) == (WalkingPhase.TRANSFER, 0.8, None)
    gait.stand()
    assert (gait.phase, gait.last_side, gait.last_sequence_id) == (WalkingPhase.STANDING, Side.RIGHT, 1)


def test_time_passes_in_a_phase_and_a_hold_prolongs_it(gait: Gait, make_steps: MakeSteps) -> None:
    gait.accept(make_steps(2))
    gait.advance(0.5)
    assert (gait.elapsed, gait.remaining) == (0.5, pytest.approx(0.2))
    gait.hold(0.1)
    assert (gait.held, gait.remaining) == (0.1, pytest.approx(0.3))
    lift(gait)
    assert (gait.elapsed, gait.held, gait.remaining) == (0.0, 0.0, pytest.approx(0.8))


def test_the_support_is_what_stands_on_the_ground(gait: Gait, make_steps: MakeSteps) -> None:
    between, left, ahead = np.zeros(2), np.array((0.0, 0.12)), np.array((0.3, 0.12))
    assert gait.support().distance(between) < 0.0
    gait.accept(make_steps(2, length=0.3))
    lift(gait)
    assert gait.support().distance(left) > 0.1
    assert gait.support().distance(ahead) > 0.1
    # A foothold that is about to be there can catch a fall.
    assert gait.catching_support().distance(ahead) < 0.0
    step = gait.step
    assert step is not None
    gait.land(step.T_world_sole)
    assert gait.support().distance(ahead) < 0.0
    assert gait.support().distance(left) > 0.0


def test_a_trailing_foot_on_its_toe_supports_there_only(gait: Gait, make_steps: MakeSteps) -> None:
    gait.accept(make_steps(2))
    heel, toe = np.array((-0.12, 0.12)), np.array((0.129, 0.12))
    assert gait.support().distance(heel) < 0.0
    toes = gait.toe_support()
    gait.lift_heel()
    for support in (toes, gait.support()):
        assert support.distance(heel) > 0.05
        assert support.distance(toe) < 0.01
    lift(gait)
    assert not gait.on_toe


def test_a_foothold_is_the_support_once_its_foot_has_landed(gait: Gait, make_steps: MakeSteps) -> None:
    half = np.array([[0.02, 0.069], [-0.13, 0.069], [-0.13, -0.069], [0.02, -0.069]])
    step = replace(make_steps(2)[0], foothold_sole=half)
    gait.accept((step,))
    lift(gait)
    gait.land(step.T_world_sole)
    np.testing.assert_array_equal(gait.points(Side.LEFT), half)
    centre = step.T_world_sole.p[:2]
    assert gait.support().distance(centre) < 0.0
    assert gait.support().distance(centre + np.array((0.1, 0.0))) > 0.05


def test_a_landing_off_its_foothold_is_where_the_next_support_is(gait: Gait, make_steps: MakeSteps) -> None:
    step = make_steps(2)[0]
    gait.accept((step,))
    lift(gait)
    landed = Pose.from_xyz_rpy((0.27, 0.15, 0.02), (0.05, 0.0, 0.1))
    np.testing.assert_array_equal(gait.landed_stance().T_world_left.p, step.T_world_sole.p)
    gait.land(landed)
    np.testing.assert_array_equal(gait.stance.T_world_left.p, landed.p)


def test_the_preview_alternates_transfers_and_swings_and_ends_at_rest(gait: Gait, make_steps: MakeSteps) -> None:
    gait.accept(make_steps(3))
    for swinging in (False, True):
        if swinging:
            lift(gait)
        phases = gait.preview(1.0)
        assert [phase.swing is not None or phase.heel is None for phase in phases[:-1]] == [
            bool((i + swinging) % 2) for i in range(len(phases) - 1)
        ]
        assert len(phases) == 7 - swinging
        rest = phases[-1]
        np.testing.assert_allclose(rest.cop_end, rest.stance.mid_feet[:2])
        assert sum(phase.remaining for phase in phases) == pytest.approx(
            (0.0 if swinging else 0.7) + 3 * 0.8 + 2 * 0.3 + 0.8
        )


def test_the_two_foremost_points_are_the_toe() -> None:
    points = np.array([[0.1, 0.0], [-0.1, 0.05], [0.12, -0.05], [-0.1, -0.05]])
    np.testing.assert_array_equal(toe_points(points), (True, False, True, False))
