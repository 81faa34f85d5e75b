"""A body whose accelerations come true: what the promises of the kinematic world rest on."""

from dataclasses import replace

import numpy as np
import pytest
from small_worlds import steps, world

from sim_envs.worlds import KinematicParameters
from skills.footsteps.footstep import Side
from skills.walking import StepEventKind, WalkingPhase


@pytest.mark.parametrize(("length", "timing"), ((0.3, (0.8, 0.3)), (0.4, (0.6, 0.2))))
def test_a_stance_foot_slips_less_than_a_millimetre_a_step(length, timing):
    it = world()
    walk = [replace(step, swing_duration=timing[0], transfer_duration=timing[1]) for step in steps(4, length)]
    it.send_footsteps(tuple(walk))
    landed, slips, made = {}, [], []
    for _ in range(round(1.5 + sum(timing) * 4.2) * 100):
        it.advance(0.01)
        for event in it.drain_events():
            if event.kind is StepEventKind.COMPLETED:
                landed[event.step.side] = event.T_world_sole.p
                made.append(event.step.sequence_id)
                # Behind the swing of the other foot its heel may lift.
                landed.pop(event.step.side.opposite, None)
        stance = it.true_state().stance
        slips += [np.linalg.norm(stance.sole(side).p - p) for side, p in landed.items()]
    assert made == [0, 1, 2, 3]
    assert max(slips) < 1e-3


def test_at_touchdown_the_feet_on_the_ground_are_at_rest_at_once():
    it = world()
    it.send_footsteps(steps(3))
    while it.status().phase is not WalkingPhase.SWING:
        it.advance(0.01)
    while it.status().phase is WalkingPhase.SWING:
        it.advance(0.01)
    before = it.true_state().stance
    it.advance(0.01)
    for side in Side:
        moved = it.true_state().stance.sole(side).p - before.sole(side).p
        assert np.linalg.norm(moved) < 1e-3


def test_control_steps_come_at_the_rate_asked_for():
    it = world(kinematic=KinematicParameters(control_rate=50.0))
    it.advance(1.0)
    assert len(it.drain_log()) == 50


def test_a_body_that_has_fallen_moves_no_more():
    it = world()
    it.send_footsteps(steps(3, length=1.6))
    it.advance(4.0)
    assert it.status().phase is WalkingPhase.FALLEN
    before = it.physics.data.ptr.qpos.copy()
    it.advance(0.5)
    np.testing.assert_array_equal(it.physics.data.ptr.qpos, before)
