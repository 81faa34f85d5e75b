from collections.abc import Callable, Iterator

import numpy as np
import pytest

from skills.footsteps.footstep import Footstep, Side, Stance
from skills.geometry.pose import Pose
from skills.walking import (
    KinematicWalker,
    RobotModel,
    StepEventKind,
    WalkerOutput,
    WalkingParameters,
    WalkingPhase,
)

PARAMETERS = WalkingParameters()
FASTEST_JOINT = 12.0
Maker = Callable[..., tuple[Footstep, ...]]

COURSES: dict[str, dict[str, object]] = {
    "flat": {"length": 0.4},
    "up and down": {"height": lambda i: (0.1, 0.2, 0.2, 0.0)[i % 4]},
    "low steps": {"height": lambda i: (0.07, 0.15, 0.15, 0.0)[i % 4]},
    "tilted": {"tilt": lambda i: ((0.26, 0.0), (0.0, 0.26), (-0.26, 0.0), (0.0, -0.26))[i % 4]},
    "turning": {"turn": 0.15, "length": 0.2},
}


@pytest.fixture
def walker(model: RobotModel, stance: Stance) -> KinematicWalker:
    return KinematicWalker(model, PARAMETERS, stance)


def walk(walker: KinematicWalker, dt: float = 0.01, longest: float = 100.0) -> Iterator[WalkerOutput]:
    """Advance until the robot stands or has fallen."""
    while walker.time < longest:
        yield walker.advance(dt)
        if walker.status().phase in (WalkingPhase.STANDING, WalkingPhase.FALLEN):
            return


def walk_until(walker: KinematicWalker, phase: WalkingPhase, share: float = 0.0, dt: float = 0.01) -> None:
    for _ in range(2000):
        status = walker.status()
        if status.phase is phase and status.phase_elapsed >= share * status.phase_duration:
            return
        walker.advance(dt)
    raise AssertionError(f"never came to {phase}")


@pytest.mark.parametrize(("timing", "count"), (((1.2, 0.8), 5), ((0.8, 0.3), 8), ((0.6, 0.2), 12)))
@pytest.mark.parametrize("course", COURSES)
def test_it_walks_and_keeps_every_promise(
    walker: KinematicWalker,
    model: RobotModel,
    make_steps: Maker,
    course: str,
    timing: tuple[float, float],
    count: int,
) -> None:
    check_walk(walker, model, make_steps(count, timing=timing, **COURSES[course]), fastest_joint(course, timing))


@pytest.mark.sweep
@pytest.mark.parametrize("timing", ((1.2, 0.8), (0.8, 0.3), (0.6, 0.2)))
@pytest.mark.parametrize("course", COURSES)
def test_it_walks_24_steps(
    walker: KinematicWalker, model: RobotModel, make_steps: Maker, course: str, timing: tuple[float, float]
) -> None:
    check_walk(walker, model, make_steps(24, timing=timing, **COURSES[course]), fastest_joint(course, timing))


def fastest_joint(course: str, timing: tuple[float, float]) -> float:
    """Joint rates of Atlas-class legs; steps of 0.2 m in 0.6 s ask for a little more [rad/s]."""
    return 14.0 if course == "up and down" and timing[0] < 0.7 else FASTEST_JOINT


def check_walk(walker: KinematicWalker, model: RobotModel, steps: tuple[Footstep, ...], fastest: float) -> None:
    """Make the steps; feet on the ground keep still, joints keep their limits, everything is where it says."""
    walker.send(steps)
    landed = {side: walker.status().imminent_stance.sole(side) for side in Side}
    if walker.status().current_step is not None:
        landed[steps[0].side] = walker.output.stance.sole(steps[0].side)
    completed: list[Footstep] = []
    told, found, slips = [], [], [0.0]
    for output in walk(walker):
        status = walker.status()
        for event in walker.drain_events():
            if event.kind is StepEventKind.COMPLETED:
                completed.append(event.step)
                landed[event.step.side] = event.step.T_world_sole
        soles = {side: model.sole_pose(output.q, side) for side in Side}
        told.append(np.concatenate([output.stance.sole(side).p for side in Side] + [output.com_world]))
        found.append(np.concatenate([soles[side].p for side in Side] + [model.com(output.q)]))
        for side, sole in soles.items():
            if status.current_step is None or status.current_step.side is not side:
                slips += [np.abs(sole.p - landed[side].p).max(), np.abs(sole.R - landed[side].R).max()]
        assert np.all(output.q[7:] >= model.lower_limits)
        assert np.all(output.q[7:] <= model.upper_limits)
        assert np.abs(output.v[6:]).max() < fastest
    assert walker.status().failure == ""
    assert completed == list(steps)
    assert max(slips) < 1e-6
    np.testing.assert_allclose(np.array(told)[:, :6], np.array(found)[:, :6], atol=1e-6)
    # At a joint limit the CoM gives way a little to the soles.
    np.testing.assert_allclose(np.array(told)[:, 6:], np.array(found)[:, 6:], atol=1e-4)
    assert max(sample.dcm_error for sample in walker.drain_log()) < PARAMETERS.hold_error


def test_a_foot_lands_where_its_step_says(walker: KinematicWalker, model: RobotModel, make_steps: Maker) -> None:
    steps = make_steps(4, timing=(0.601, 0.203), tilt=lambda i: (0.2, -0.1), height=lambda i: 0.05 * i)
    walker.send(steps)
    for output in walk(walker, dt=0.002):
        for event in walker.drain_events():
            if event.kind is StepEventKind.COMPLETED:
                sole = model.sole_pose(output.q, event.step.side)
                np.testing.assert_allclose(sole.p, event.step.T_world_sole.p, atol=1e-6)
                np.testing.assert_allclose(sole.R, event.step.T_world_sole.R, atol=1e-6)
                np.testing.assert_allclose(event.T_world_sole.p, event.step.T_world_sole.p, atol=1e-4)


def test_events_come_in_order_and_at_the_commanded_times(walker: KinematicWalker, make_steps: Maker) -> None:
    walker.send(make_steps(3, timing=(0.83, 0.31)))
    for _ in walk(walker):
        pass
    events = walker.drain_events()
    assert [event.step.sequence_id for event in events] == [0, 0, 1, 1, 2, 2]
    assert [event.kind for event in events] == [StepEventKind.STARTED, StepEventKind.COMPLETED] * 3
    first = PARAMETERS.first_transfer
    expected = np.cumsum((first, 0.83, 0.31, 0.83, 0.31, 0.83))
    np.testing.assert_allclose([event.time for event in events], expected, atol=1e-9)
    assert walker.drain_events() == ()


@pytest.mark.parametrize("seed", range(4))
def test_no_queue_override_makes_anything_jump(
    walker: KinematicWalker, model: RobotModel, make_steps: Maker, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    timing = ((1.2, 0.8), (0.8, 0.3), (0.6, 0.2))[seed % 3]
    dt, next_id, next_send = 0.01, 0, 0.0
    omega_squared = PARAMETERS.gravity / PARAMETERS.com_height
    before = walker.output
    velocity = np.zeros(3)
    while walker.time < 12.0:
        if walker.time >= next_send:
            status = walker.status()
            first = status.last_side.opposite if status.last_side else Side.LEFT
            middle = status.imminent_stance.mid_feet
            steps = make_steps(
                int(rng.integers(1, 5)),
                length=float(rng.uniform(0.0, 0.4)),
                turn=float(rng.uniform(-0.1, 0.1)),
                timing=timing,
                first=first,
                first_id=next_id,
                start=(middle[0], middle[1], status.imminent_stance.yaw),
            )
            next_id += 10
            if rng.uniform() < 0.15:
                walker.pause()
            else:
                walker.send(steps)
            next_send = walker.time + float(rng.uniform(0.1, 1.5))
        output = walker.advance(dt)
        assert output.phase is not WalkingPhase.FALLEN, walker.status().failure
        gap = 0.5 * float(np.linalg.norm(output.com_world[:2] - output.cop_world[:2])) + 0.2
        new_velocity = (output.com_world - before.com_world) / dt
        assert np.linalg.norm(new_velocity - velocity) < 2.0 * omega_squared * gap * dt
        omega = float(np.sqrt(omega_squared))
        np.testing.assert_allclose(
            new_velocity[:2], omega * (before.dcm_world - before.com_world)[:2], atol=omega_squared * gap * dt
        )
        np.testing.assert_allclose(output.dcm_world[:2], before.dcm_world[:2], atol=omega * gap * 4.0 * dt)
        assert np.abs(output.v[6:]).max() < FASTEST_JOINT
        before, velocity = output, new_velocity
    assert max(sample.dcm_error for sample in walker.drain_log()) < 0.1


def test_a_step_in_the_air_goes_on_and_newer_steps_follow_it(walker: KinematicWalker, make_steps: Maker) -> None:
    walker.send(make_steps(4))
    walk_until(walker, WalkingPhase.SWING, 0.5)
    current = walker.status().current_step
    assert current is not None
    newer = make_steps(5, length=0.25)
    walker.send(newer)
    assert walker.status().current_step is current
    assert walker.status().queue == newer[1:]
    assert walker.status().imminent_stance.T_world_left is current.T_world_sole
    with pytest.raises(ValueError, match="the feet must take turns"):
        walker.send(make_steps(2, first_id=7))
    assert walker.status().queue == newer[1:]
    for _ in walk(walker):
        pass
    completed = [event.step for event in walker.drain_events() if event.kind is StepEventKind.COMPLETED]
    assert completed == [current, *newer[1:]]


def test_a_step_whose_foot_has_not_lifted_gives_way(walker: KinematicWalker, make_steps: Maker) -> None:
    walker.send(make_steps(3))
    walk_until(walker, WalkingPhase.TRANSFER, 0.5)
    newer = make_steps(3, length=0.2, first_id=10)
    walker.send(newer)
    assert walker.status().current_step is newer[0]
    following = make_steps(2, first=Side.RIGHT, first_id=20)
    walker.send(following)
    assert walker.status().current_step is newer[0]
    assert walker.status().queue == following


def test_steps_of_an_old_plan_are_not_made_again(walker: KinematicWalker, make_steps: Maker) -> None:
    steps = make_steps(2)
    walker.send(steps)
    for _ in walk(walker):
        pass
    walker.send(steps)
    walker.advance(0.01)
    assert walker.status().phase is WalkingPhase.STANDING


def test_a_pause_finishes_the_step_and_a_new_plan_resumes(walker: KinematicWalker, make_steps: Maker) -> None:
    walker.send(make_steps(6))
    walk_until(walker, WalkingPhase.SWING, 0.3)
    walker.pause()
    assert walker.status().paused
    assert walker.status().queue == ()
    for _ in walk(walker):
        pass
    assert walker.status().phase is WalkingPhase.STANDING
    assert [event.kind for event in walker.drain_events()] == [StepEventKind.STARTED, StepEventKind.COMPLETED]
    output = walker.advance(1.0)
    np.testing.assert_allclose(output.com_world[:2], output.stance.mid_feet[:2], atol=2e-3)
    walker.send(make_steps(2, first=Side.RIGHT, first_id=6))
    assert not walker.status().paused
    assert walker.status().phase is WalkingPhase.TRANSFER


def test_standing_it_is_still(walker: KinematicWalker) -> None:
    first = walker.output
    output = walker.advance(0.5)
    np.testing.assert_allclose(output.q, first.q, atol=1e-9)
    status = walker.status()
    assert (status.phase, status.phase_duration, status.current_step) == (WalkingPhase.STANDING, 0.0, None)
    state = walker.state()
    assert state.time == pytest.approx(0.5)
    np.testing.assert_allclose(state.com_world[:2], state.stance.mid_feet[:2], atol=1e-6)


def test_the_control_rate_does_not_change_the_walk(model: RobotModel, stance: Stance, make_steps: Maker) -> None:
    ends = []
    for dt in (0.01, 0.002):
        walker = KinematicWalker(model, PARAMETERS, stance)
        walker.send(make_steps(3, timing=(0.6, 0.2)))
        ends.append([walker.advance(dt) for _ in range(round(2.0 / dt))][-1])
    np.testing.assert_allclose(ends[0].q, ends[1].q, atol=2e-3)
    np.testing.assert_allclose(ends[0].dcm_world, ends[1].dcm_world, atol=1e-3)


def test_the_same_commands_give_the_same_bits(model: RobotModel, stance: Stance, make_steps: Maker) -> None:
    runs = []
    for _ in range(2):
        walker = KinematicWalker(model, PARAMETERS, stance)
        walker.send(make_steps(3))
        runs.append(np.array([np.append(output.q, output.dcm_world) for output in walk(walker)]))
    np.testing.assert_array_equal(runs[0], runs[1])


def test_a_foothold_out_of_reach_is_a_fall(walker: KinematicWalker, make_step: Callable[..., Footstep]) -> None:
    walker.send((make_step(0, Side.LEFT, Pose.from_xyz_rpy((1.6, 0.12, 0.0))),))
    output = list(walk(walker))[-1]
    status = walker.status()
    assert status.phase is WalkingPhase.FALLEN
    assert "inverse kinematics cannot reach the commanded motion (residual" in status.failure
    after = walker.advance(0.5)
    np.testing.assert_array_equal(after.q, output.q)
    assert after.time == pytest.approx(output.time + 0.5)
    walker.send((make_step(1, Side.RIGHT, Pose.from_xyz_rpy((0.2, -0.12, 0.0))),))
    walker.pause()
    assert walker.status().phase is WalkingPhase.FALLEN


def test_a_dcm_that_leaves_the_feet_is_a_fall(walker: KinematicWalker, make_steps: Maker) -> None:
    walker.send(make_steps(3))
    walk_until(walker, WalkingPhase.TRANSFER, 0.5)
    balance = walker._balance
    balance.dcm = balance.dcm + np.array((0.5, 0.0))
    walker.advance(0.01)
    assert walker.status().phase is WalkingPhase.FALLEN
    assert "balance is lost: the DCM is" in walker.status().failure


def test_the_world_may_end_the_walk(walker: KinematicWalker) -> None:
    walker.fall("a block hit the shin")
    walker.fall("later")
    assert walker.status().failure == "a block hit the shin"
    assert walker.output.phase is WalkingPhase.FALLEN


def test_a_disturbed_robot_holds_double_support(walker: KinematicWalker, make_steps: Maker) -> None:
    walker.send(make_steps(3))
    walk_until(walker, WalkingPhase.TRANSFER, 0.95)
    walker._balance.dcm = walker._balance.dcm - np.array((0.0, 0.06))
    for _ in walk(walker):
        pass
    started = [event.time for event in walker.drain_events() if event.kind is StepEventKind.STARTED]
    assert started[0] > PARAMETERS.first_transfer + 0.05
    assert walker.status().phase is WalkingPhase.STANDING


def test_it_refuses_to_stand_where_it_cannot(model: RobotModel, stance: Stance) -> None:
    apart = stance.with_sole(Side.LEFT, Pose.from_xyz_rpy((2.0, 0.12, 0.0)))
    with pytest.raises(ValueError, match="cannot stand on soles"):
        KinematicWalker(model, PARAMETERS, apart)
