"""A body driven by torques: what it is told, how late its torques come, and that the controller walks it."""
# A stand-in drives the body, and mujoco keeps its types in binary modules without stubs.
# pyright: reportArgumentType=false, reportAttributeAccessIssue=false

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from small_worlds import slab, steps, world

from sim_envs.courses import Box
from sim_envs.robot import RobotDescription, configuration_from_qpos
from sim_envs.worlds import PhysicsBody, PhysicsParameters, WorldKind
from skills.footsteps.footstep import Side
from skills.geometry.pose import Pose
from skills.walking import WalkingPhase
from skills.walking.quadratic_program import QpStatus
from skills.walking.whole_body_controller import BodyCommand

FAST = PhysicsParameters(control_rate=250.0)


class Heard:
    """Stands where a walker does, keeps its measurements and commands torques that tell the tick."""

    def __init__(self, it):
        self.start_configuration = configuration_from_qpos(it.physics.data.ptr.qpos)
        self.measured = []

    def control(self, measured):
        self.measured.append(measured)
        joints = len(measured.q) - 7
        torques = np.full(joints, float(len(self.measured)))
        return BodyCommand(torques, np.zeros(joints + 6), {}, QpStatus.SOLVED, 0)


def _body(parameters, seed=0):
    it = world(kind=WorldKind.PHYSICS)
    heard = Heard(it)
    return it, heard, PhysicsBody(it.model, it.physics.data.ptr, heard, parameters, "atlas_class/", seed)


@pytest.mark.parametrize(("delay", "ticks"), ((0.0, 0), (0.004, 2), (0.01, 5)))
def test_torques_arrive_after_the_actuators_delay(delay, ticks):
    it, _, body = _body(PhysicsParameters(torque_delay=delay))
    arrived = []
    for _ in range(10):
        body.advance()
        arrived.append(it.physics.data.ptr.ctrl[0])
    # Until the first command arrives, it is that command which holds.
    assert arrived == [max(1, tick - ticks) for tick in range(1, 11)]


def test_what_is_measured_without_noise_is_the_truth():
    _, heard, body = _body(PhysicsParameters())
    for _ in range(3):
        q, v = body.true_configuration()
        body.advance()
        np.testing.assert_array_equal(heard.measured[-1].q, q)
        np.testing.assert_array_equal(heard.measured[-1].v, v)
    assert [measured.time for measured in heard.measured] == pytest.approx([0.002, 0.004, 0.006])


def test_noise_is_of_the_size_asked_for_in_its_place_and_repeats_with_its_seed():
    noise = PhysicsParameters(position_noise=0.005, velocity_noise=0.05, joint_noise=0.002, joint_rate_noise=0.1)

    def errors(seed):
        _, heard, body = _body(noise, seed)
        made = []
        for _ in range(200):
            q, v = body.true_configuration()
            body.advance()
            measured = heard.measured[-1]
            made.append(np.concatenate((measured.q - q, measured.v - v)))
        return np.array(made)

    first = errors(3)
    n = first.shape[1] // 2 - 6
    expected = np.concatenate(([0.005] * 3, [0.0] * 4, [0.002] * n, [0.05] * 6, [0.1] * n))
    np.testing.assert_allclose(first.std(axis=0), expected, rtol=0.25, atol=1e-12)
    np.testing.assert_array_equal(first, errors(3))
    assert np.any(first != errors(4))


def test_torque_noise_is_relative_to_the_limits_and_stays_within_them_in_the_joints():
    it, _, body = _body(PhysicsParameters(torque_noise=0.1))
    made = []
    for tick in range(1, 201):
        body.advance()
        made.append(it.physics.data.ptr.ctrl - tick)
    effort = it.model.jnt_actfrcrange[1:, 1]
    np.testing.assert_allclose(np.std(made, axis=0), 0.1 * effort, rtol=0.25)


def test_control_steps_come_at_the_rate_asked_for_and_physics_between_them():
    it = world(kind=WorldKind.PHYSICS, physics=FAST)
    it.advance(0.2)
    assert len(it.drain_log()) == 50
    assert it.physics.data.ptr.time == pytest.approx(0.2)


def test_loads_are_what_presses_the_soles():
    it, heard, body = _body(PhysicsParameters())
    body.advance()
    data = it.physics.data.ptr
    loads = heard.measured[0].loads
    assert set(loads) == set(Side)
    forces = np.zeros(6)
    pressed = {side: 0.0 for side in Side}
    mujoco.mj_forward(it.model, data)
    for index in range(data.ncon):
        mujoco.mj_contactForce(it.model, data, index, forces)
        for side in Side:
            if it.model.geom(f"atlas_class/{side.value}_foot_collision").id in data.contact[index].geom:
                pressed[side] += forces[0]
    body.advance()
    for side in Side:
        assert pressed[side] > 50.0
        assert heard.measured[1].loads[side] == pytest.approx(pressed[side], rel=1e-6)


COURSES = {
    "flat": ((slab(),), {}),
    "over a tilted block": (
        (
            slab(),
            Box("block", (0.36, 0.36, 0.1), Pose.from_xyz_rpy((0.33, 0.13, 0.03), (0.15, -0.2, 0.0)), "block"),
        ),
        {0},
    ),
}


def _on_course(walk, boxes, on_block):
    """Steps onto the block lie in its upper face."""
    if not on_block:
        return walk
    T_world_box = boxes[1].T_world_box
    T_box_top = Pose.from_xyz_rpy((0.0, 0.0, 0.5 * boxes[1].size[2]))
    return tuple(
        replace(step, T_world_sole=T_world_box @ T_box_top) if step.sequence_id in on_block else step for step in walk
    )


@pytest.mark.parametrize("course", COURSES)
def test_it_walks_under_physics(course):
    boxes, on_block = COURSES[course]
    it = world(*boxes, kind=WorldKind.PHYSICS, physics=FAST)
    walk = _on_course(steps(4, 0.33), boxes, on_block)
    it.send_footsteps(walk)
    it.advance(5.2)
    status = it.status()
    assert (status.phase, status.failure) == (WalkingPhase.STANDING, "")
    landed = {e.step.sequence_id: e for e in it.drain_events() if e.kind.value == "completed"}
    assert sorted(landed) == [0, 1, 2, 3]
    for step in walk:
        error = landed[step.sequence_id].T_world_sole.p - step.T_world_sole.p
        assert np.linalg.norm(error) < 0.01
    it.advance(0.3)
    assert np.max(np.abs(it.physics.data.ptr.qvel)) < 0.1


def test_a_push_while_it_stands_is_survived():
    it = world(kind=WorldKind.PHYSICS, physics=FAST)
    it.advance(0.3)
    pelvis = it.model.body("atlas_class/pelvis").id
    data = it.physics.data.ptr
    data.xfrc_applied[pelvis, :2] = 350.0, 350.0
    it.advance(0.1)
    data.xfrc_applied[pelvis] = 0.0
    moving = np.max(np.abs(data.qvel[:2]))
    it.advance(1.5)
    assert moving > 0.1
    assert it.status().failure == ""
    assert np.max(np.abs(data.qvel)) < 0.1


def test_the_soles_are_those_of_the_table():
    it = world(kind=WorldKind.PHYSICS)
    size = it.model.geom("atlas_class/left_foot_collision").size
    np.testing.assert_allclose(2.0 * size[:2], (RobotDescription().sole_length, RobotDescription().sole_width))
