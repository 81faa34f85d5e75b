"""Walks of a body that moves as it is commanded: the walker's promises, without a simulator."""

from collections.abc import Callable
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from perfect_body import PerfectBody, ground_of

from skills.footsteps.footstep import Footstep, Side, Stance
from skills.geometry.pose import Array, Pose
from skills.walking import BodyMeasurement, RobotModel, StepEventKind, WalkingPhase
from skills.walking.support_polygon import SupportPolygon, foothold_corners

MakeBody = Callable[..., PerfectBody]
MakeSteps = Callable[..., tuple[Footstep, ...]]
BRISK = (0.6, 0.2)
TILTS = np.random.default_rng(3).uniform(-0.26, 0.26, (6, 2))
COURSES = {
    "flat": {"length": 0.35},
    "up and down": {"height": lambda i: (0.0, 0.12, 0.2, 0.1, 0.0, 0.0)[i]},
    "tilted": {"tilt": lambda i: tuple(TILTS[i])},
    "turning": {"turn": 0.35, "length": 0.2},
}


def poses(stance: Stance, steps: tuple[Footstep, ...]) -> list[Pose]:
    return [stance.T_world_left, stance.T_world_right, *(step.T_world_sole for step in steps)]


def angle(a: Pose, b: Pose) -> float:
    return float(np.arccos(np.clip(0.5 * (np.trace(a.R.T @ b.R) - 1.0), -1.0, 1.0)))


@pytest.mark.parametrize("course", COURSES)
def test_a_walk_lands_where_it_was_told_and_ends_standing(
    make_body: MakeBody, make_steps: MakeSteps, stance: Stance, course: str
) -> None:
    steps = make_steps(6, timing=BRISK, **COURSES[course])
    body = make_body(ground_of(poses(stance, steps)))
    errors = []
    body.walk(*steps, each_tick=lambda: errors.append(body.walker.drain_log()[-1].dcm_error))
    status = body.walker.status()
    assert (status.phase, status.failure) == (WalkingPhase.STANDING, "")
    assert body.walker.qp_failures == 0
    assert [event.step.sequence_id for event in body.landings()] == list(range(6))
    for event in body.landings():
        np.testing.assert_allclose(event.T_world_sole.p, event.step.T_world_sole.p, atol=8e-3)
        assert angle(event.T_world_sole, event.step.T_world_sole) < 0.01
    assert max(errors) < 0.03
    np.testing.assert_allclose(body.dynamics.com[:2], status.imminent_stance.mid_feet[:2], atol=0.01)
    assert np.max(np.abs(body.v)) < 0.05


def test_events_come_in_the_order_of_the_steps_at_their_times(make_body: MakeBody, make_steps: MakeSteps) -> None:
    body = make_body()
    body.walk(*make_steps(3, timing=BRISK))
    assert [(event.kind, event.step.sequence_id) for event in body.events] == [
        (kind, i) for i in range(3) for kind in (StepEventKind.STARTED, StepEventKind.COMPLETED)
    ]
    times = [event.time for event in body.events]
    durations = [behind - before for before, behind in pairwise(times)]
    assert times[0] == pytest.approx(0.7, abs=0.03)
    np.testing.assert_allclose(durations, (0.6, 0.2, 0.6, 0.2, 0.6), atol=0.06)


def test_the_same_commands_give_the_same_bits(make_body: MakeBody, make_steps: MakeSteps) -> None:
    ends = []
    for _ in range(2):
        body = make_body()
        body.walk(*make_steps(2, timing=BRISK), rest=0.0)
        ends.append((body.q, body.v, [sample.cop_world for sample in body.walker.drain_log()]))
    for first, second in zip(*ends, strict=True):
        np.testing.assert_array_equal(first, second)


def test_a_plan_in_mid_swing_replaces_the_queue_and_lets_the_foot_in_the_air_land(
    make_body: MakeBody, make_steps: MakeSteps
) -> None:
    body = make_body()
    steps = make_steps(4, timing=BRISK)
    body.send(*steps)
    body.advance_until(lambda: body.phase is WalkingPhase.SWING)
    body.advance(0.3)
    new = make_steps(4, timing=BRISK, length=0.22, turn=0.1)
    body.send(*new)
    status = body.walker.status()
    assert status.current_step is steps[0]
    assert status.queue == new[1:]
    body.advance(4.0)
    assert [event.step for event in body.landings()] == [steps[0], *new[1:]]
    assert body.phase is WalkingPhase.STANDING
    np.testing.assert_allclose(body.dynamics.sole(new[-1].side).p, new[-1].T_world_sole.p, atol=8e-3)


def test_a_plan_in_transfer_replaces_the_step_to_come_where_it_begins_with_the_same_foot(
    make_body: MakeBody, make_steps: MakeSteps
) -> None:
    body = make_body()
    steps = make_steps(2, timing=BRISK)
    body.send(*steps)
    body.advance(0.3)
    assert body.phase is WalkingPhase.TRANSFER
    longer = make_steps(2, timing=BRISK, length=0.35)
    body.send(*longer)
    assert body.walker.status().current_step is longer[0]
    with pytest.raises(ValueError, match="the feet must take turns"):
        body.send(longer[0], replace(longer[0], sequence_id=1))
    assert body.walker.status().current_step is longer[0]
    assert body.walker.status().queue == longer[1:]
    body.advance(3.5)
    assert [event.step for event in body.landings()] == list(longer)
    assert body.phase is WalkingPhase.STANDING


def test_a_pause_finishes_the_step_and_stands_until_the_next_plan(make_body: MakeBody, make_steps: MakeSteps) -> None:
    body = make_body()
    steps = make_steps(4, timing=BRISK)
    body.send(*steps)
    body.advance_until(lambda: body.phase is WalkingPhase.SWING)
    body.walker.pause()
    assert body.walker.status().paused
    body.advance(2.5)
    assert body.phase is WalkingPhase.STANDING
    assert [event.step.sequence_id for event in body.landings()] == [0]
    assert body.walker.status().last_sequence_id == 0
    # Steps begun already are dropped by their ids.
    body.send(*steps[:3])
    assert not body.walker.status().paused
    body.advance(3.5)
    assert [event.step.sequence_id for event in body.landings()] == [0, 1, 2]
    assert (body.phase, body.walker.status().failure) == (WalkingPhase.STANDING, "")


@pytest.mark.parametrize(("lower", "sooner"), ((-0.03, True), (0.03, False)), ids=("early", "late"))
def test_ground_higher_or_lower_than_the_foothold_is_landed_on_and_walked_over(
    make_body: MakeBody, make_steps: MakeSteps, stance: Stance, lower: float, sooner: bool
) -> None:
    steps = make_steps(3, timing=BRISK)
    level, off = poses(stance, ()), [steps[0].T_world_sole]
    planes, lowered = ground_of([*level, *off]), ground_of([*level, *off], lower)

    def ground(points: Array) -> Array:
        under_foothold = (points[:, 0] > 0.15) & (points[:, 1] > 0.0)
        return np.where(under_foothold, lowered(points), planes(points))

    body = make_body(ground)
    body.walk(*steps)
    started, landed = body.events[0], body.events[1]
    assert landed.T_world_sole.p[2] == pytest.approx(-lower, abs=8e-3)
    assert (landed.time - started.time < 0.6) == sooner
    assert (body.phase, body.walker.status().failure) == (WalkingPhase.STANDING, "")
    assert len(body.landings()) == 3


def test_an_early_contact_off_the_foothold_is_no_landing(make_body: MakeBody, make_steps: MakeSteps) -> None:
    body = make_body()
    step = make_steps(2, length=0.4)[0]
    body.send(step)
    body.advance_until(lambda: body.phase is WalkingPhase.SWING)
    body.advance(0.3)
    body.pressed = (Side.LEFT,)
    body.advance(0.1)
    assert body.phase is WalkingPhase.SWING
    body.pressed = ()
    body.advance(1.5)
    np.testing.assert_allclose(body.landings()[0].T_world_sole.p, step.T_world_sole.p, atol=8e-3)


def test_a_foot_that_finds_no_ground_at_all_counts_as_landed_in_the_end(
    make_body: MakeBody, make_steps: MakeSteps
) -> None:
    body = make_body(lambda points: np.where(points[:, 0] > 0.15, -2.0, 0.0))
    body.send(make_steps(2, timing=BRISK)[0])
    body.advance_until(lambda: bool(body.landings()))
    started, landed = body.events
    assert landed.time - started.time == pytest.approx(1.8 * 0.6, abs=0.03)
    assert landed.T_world_sole.p[2] < -0.05


def test_a_transfer_is_prolonged_while_the_dcm_is_off_its_plan(make_body: MakeBody, make_steps: MakeSteps) -> None:
    durations = []
    for kick in (0.0, 0.25):
        body = make_body()
        body.send(*make_steps(2, timing=BRISK))
        body.advance(0.6)
        body.v[0] += kick
        body.advance_until(lambda body=body: body.phase is WalkingPhase.SWING)
        durations.append(body.events[0].time)
        body.advance(2.5)
        assert (body.phase, body.walker.status().failure) == (WalkingPhase.STANDING, "")
    undisturbed, held = durations
    assert undisturbed == pytest.approx(0.7, abs=0.02)
    # It is not the limit of 1 s that ends it: the DCM comes back.
    assert undisturbed + 0.05 < held < undisturbed + 0.8


@pytest.mark.parametrize("moment", (WalkingPhase.STANDING, WalkingPhase.SWING))
def test_balance_that_is_lost_is_a_fall_with_its_reason_and_ends_the_walk(
    make_body: MakeBody, make_steps: MakeSteps, moment: WalkingPhase
) -> None:
    body = make_body()
    if moment is WalkingPhase.SWING:
        body.send(*make_steps(4, timing=BRISK))
        body.advance_until(lambda: body.phase is moment)
    body.v[1] -= 3.0
    body.advance(0.1)
    status = body.walker.status()
    assert status.phase is WalkingPhase.FALLEN
    assert status.failure.startswith("balance is lost: the DCM is ")
    started = [event for event in body.events if event.kind is StepEventKind.STARTED]
    body.walker.fall("another reason")
    body.send(*make_steps(4, timing=BRISK, first_id=10))
    body.walker.pause()
    body.advance(0.5)
    after = body.walker.status()
    assert (after.phase, after.failure, after.queue) == (WalkingPhase.FALLEN, status.failure, ())
    assert [event for event in body.events if event.kind is StepEventKind.STARTED] == started


@pytest.mark.parametrize("field", ("q", "v"))
def test_a_measurement_that_is_no_number_is_a_fall_and_reaches_no_joint(make_body: MakeBody, field: str) -> None:
    body = make_body()
    body.advance(0.1)
    measured = BodyMeasurement(body.time + 0.01, body.q.copy(), body.v.copy(), dict.fromkeys(Side, 800.0))
    getattr(measured, field)[9] = np.nan
    command = body.walker.control(measured)
    assert body.walker.status().failure == "the measured state is not finite"
    assert np.all(np.isfinite(command.torques))
    assert np.all(np.isfinite(command.acceleration))


@pytest.mark.parametrize("part", ("heel", "toe", "inner edge"))
def test_a_foothold_of_60_percent_of_the_sole_keeps_the_cop_inside_it(
    make_body: MakeBody, make_steps: MakeSteps, model: RobotModel, part: str
) -> None:
    half, width = model.foothold_sole.max(axis=0)
    x = {"heel": (-half, 0.2 * half), "toe": (-0.2 * half, half), "inner edge": (-half, half)}[part]
    y = (-width, 0.2 * width) if part == "inner edge" else (-width, width)
    foothold = np.array([(x[1], y[1]), (x[0], y[1]), (x[0], y[0]), (x[1], y[0])])
    steps = make_steps(4, timing=(0.8, 0.3))
    steps = tuple(replace(step, foothold_sole=foothold) if step.side is Side.LEFT else step for step in steps)
    body = make_body()
    allowed = SupportPolygon([foothold_corners(Pose.identity(), foothold, 0.0)])
    outside = []

    def look() -> None:
        assert body.command is not None
        wrench = body.command.wrenches_sole[Side.LEFT]
        if body.landings() and wrench[2] > 100.0:
            outside.append(allowed.distance(np.array((-wrench[4], wrench[3])) / wrench[2]))

    body.walk(*steps, each_tick=look)
    assert (body.phase, body.walker.status().failure) == (WalkingPhase.STANDING, "")
    assert len(outside) > 150
    assert max(outside) < 1e-6


def test_status_tells_the_phase_its_time_and_the_stance_to_come(make_body: MakeBody, make_steps: MakeSteps) -> None:
    body = make_body()
    steps = make_steps(2, timing=BRISK)
    assert (body.walker.status().phase_elapsed, body.walker.status().phase_duration) == (0.0, 0.0)
    body.send(*steps)
    seen = []

    def look() -> None:
        status = body.walker.status()
        assert 0.0 <= status.phase_elapsed <= status.phase_duration * 1.8 + 1e-9
        if status.current_step is not None:
            step = status.current_step
            np.testing.assert_array_equal(status.imminent_stance.sole(step.side).p, step.T_world_sole.p)
        if not seen or seen[-1] is not status.phase:
            seen.append(status.phase)

    body.advance(3.8, look)
    transfer, swing = WalkingPhase.TRANSFER, WalkingPhase.SWING
    assert seen == [transfer, swing, transfer, swing, transfer, WalkingPhase.STANDING]
    assert body.walker.status().last_side is Side.RIGHT


def test_a_foot_that_landed_on_nothing_goes_on_sinking_and_lands_once(
    make_body: MakeBody, make_steps: MakeSteps, stance: Stance
) -> None:
    steps = make_steps(2, timing=BRISK)
    body = make_body(ground_of(poses(stance, steps), lower=0.04))
    body.send(*steps)
    body.advance_until(lambda: body.phase is WalkingPhase.SWING)
    body.advance(0.62)
    # For a moment something touches the foot above the ground that is 4 cm too low.
    body.pressed = (Side.LEFT,)
    body.advance_until(lambda: body.phase is WalkingPhase.TRANSFER, at_most=0.1)
    height = body.dynamics.sole(Side.LEFT).p[2]
    body.pressed, body.unfelt = (), (Side.LEFT,)
    body.advance_until(lambda: body.phase is WalkingPhase.SWING, at_most=0.1)
    body.unfelt = ()
    body.advance_until(lambda: body.phase is WalkingPhase.TRANSFER, at_most=1.0)
    assert body.dynamics.sole(Side.LEFT).p[2] < height - 0.01
    assert [event.step.sequence_id for event in body.landings()] == [0]
    assert body.walker.status().failure == ""
