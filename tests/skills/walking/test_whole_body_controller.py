"""Torques, forces and accelerations of the whole-body program, checked without the code that made it."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import pairwise

import daqp
import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports]
import pytest
from perfect_body import PerfectBody

from skills.footsteps.footstep import Footstep, Side, Stance
from skills.geometry.pose import Array, Mask, Pose, rotation_y
from skills.walking import RobotModel, WalkingParameters, WholeBodyParameters
from skills.walking.body_dynamics import BodyDynamics
from skills.walking.contact import Contact, contact_points
from skills.walking.posture import standing_configuration
from skills.walking.quadratic_program import OsqpSolver, QpSolution, QpSolver, QpStatus
from skills.walking.whole_body_controller import BodyCommand, BodyTasks, SoleTask, WholeBodyController

GRAVITY = 9.81
PARAMETERS = WholeBodyParameters()
Problem = tuple[Array, Array, Array, Array, Array]


class ExactSolver:
    """DAQP (Arnström et al., 2022), an active-set solver: exact, and by another method than OSQP."""

    def __init__(self, P_pattern: Mask, A_pattern: Mask) -> None:
        pass

    def solve(self, P: Array, q: Array, A: Array, lower: Array, upper: Array) -> QpSolution:
        sense = np.where(lower == upper, 5, 0).astype(np.int32)
        bounds = np.clip(upper, -1e30, 1e30), np.clip(lower, -1e30, 1e30)
        x, _, flag, info = daqp.solve(P, q, A, *bounds, sense)
        return QpSolution(np.array(x), QpStatus.SOLVED if flag == 1 else QpStatus.FAILED, info["iterations"])


@dataclass
class Logged:
    """OSQP that keeps a copy of what it was asked and what it answered."""

    solver: QpSolver
    problems: list[tuple[Problem, QpSolution]]

    def solve(self, P: Array, q: Array, A: Array, lower: Array, upper: Array) -> QpSolution:
        solution = self.solver.solve(P, q, A, lower, upper)
        self.problems.append(((P.copy(), q.copy(), A.copy(), lower.copy(), upper.copy()), solution))
        return solution


@dataclass
class Broken:
    """A solver that answers with no numbers, or says that it failed, from some call on."""

    solver: QpSolver
    answer: QpSolution
    healthy_calls: int

    def solve(self, P: Array, q: Array, A: Array, lower: Array, upper: Array) -> QpSolution:
        self.healthy_calls -= 1
        return self.answer if self.healthy_calls < 0 else self.solver.solve(P, q, A, lower, upper)


def osqp(P_pattern: Mask, A_pattern: Mask) -> OsqpSolver:
    p = PARAMETERS
    return OsqpSolver(P_pattern, A_pattern, p.qp_tolerance, p.qp_iterations, p.qp_check)


@pytest.fixture
def standing(model: RobotModel, stance: Stance) -> BodyDynamics:
    body = BodyDynamics(model)
    body.update(standing_configuration(model, stance, WalkingParameters()), np.zeros(model.pin_model.nv))
    return body


def tasks(body: BodyDynamics, *, on: tuple[Side, ...] = tuple(Side), loaded: Mask | None = None) -> BodyTasks:
    """Rest, standing on some of the feet."""
    contact = Contact.at(contact_points(body.model.foothold_sole), PARAMETERS.friction, loaded)
    joints = len(body.model.joint_names)
    soles = {}
    for side in Side:
        weight = PARAMETERS.stance_weight if side in on else PARAMETERS.swing_weight
        soles[side] = SoleTask(np.zeros(6), np.full(6, weight), np.zeros(3), contact if side in on else None)
    return BodyTasks(
        com_acceleration=np.zeros(3),
        momentum_rate=np.zeros(3),
        pelvis_acceleration=np.zeros(3),
        torso_acceleration=np.zeros(3),
        posture_acceleration=np.zeros(joints),
        posture_weights=np.full(joints, 0.01),
        soles=soles,
    )


def joint_forces(body: BodyDynamics, command: BodyCommand) -> Array:
    """Generalized forces that the commanded motion needs besides those of the ground, by inverse dynamics (6 + n,)."""
    model = body.model.pin_model
    data = model.createData()
    pin.framesForwardKinematics(model, data, body.q)
    external = pin.StdVec_Force()
    external.extend(pin.Force.Zero() for _ in range(model.njoints))
    for side, wrench in command.wrenches_sole.items():
        frame = model.frames[body.model.sole_frames[side]]
        external[frame.parentJoint] = frame.placement.act(pin.Force(wrench))
    return pin.rnea(model, data, body.q, body.v, command.acceleration, external) + model.damping * body.v


def random_tasks(body: BodyDynamics, seed: int) -> BodyTasks:
    rng = np.random.default_rng(seed)
    on = (tuple(Side), (Side.LEFT,), (Side.RIGHT,))[seed % 3]
    return replace(
        tasks(body, on=on),
        com_acceleration=rng.normal(scale=(0.8, 0.8, 1.0)),
        momentum_rate=rng.normal(scale=20.0, size=3),
        posture_acceleration=rng.normal(scale=3.0, size=len(body.model.joint_names)),
    )


@pytest.mark.parametrize("seed", range(6))
def test_torques_forces_and_accelerations_obey_inverse_dynamics(standing: BodyDynamics, seed: int) -> None:
    body, rng = standing, np.random.default_rng(seed)
    body.update(body.q, rng.normal(scale=0.2, size=len(body.v)))
    command = WholeBodyController(body.model, PARAMETERS, ExactSolver).solve(body, random_tasks(body, seed))
    assert command.status is QpStatus.SOLVED
    forces = joint_forces(body, command)
    np.testing.assert_allclose(forces[:6], 0.0, atol=1e-5)
    np.testing.assert_allclose(forces[6:], command.torques, atol=1e-5)


@pytest.mark.parametrize("seed", range(6))
def test_osqp_obeys_inverse_dynamics_within_a_hundredth_of_the_weight(standing: BodyDynamics, seed: int) -> None:
    body, rng = standing, np.random.default_rng(seed)
    body.update(body.q, rng.normal(scale=0.2, size=len(body.v)))
    command = WholeBodyController(body.model, PARAMETERS).solve(body, random_tasks(body, seed))
    forces = joint_forces(body, command)
    np.testing.assert_allclose(forces[:6], 0.0, atol=1e-2 * body.model.mass * GRAVITY)
    np.testing.assert_allclose(forces[6:], command.torques, atol=1e-6)


@pytest.mark.parametrize("seed", range(6))
def test_forces_push_within_the_friction_cone_and_only_where_something_touches(
    standing: BodyDynamics, seed: int
) -> None:
    wanted = random_tasks(standing, seed)
    # More than friction allows.
    wanted = replace(wanted, com_acceleration=wanted.com_acceleration + np.array((9.0, 0.0, 0.0)))
    command = WholeBodyController(standing.model, PARAMETERS).solve(standing, wanted)
    for side, wrench in command.wrenches_sole.items():
        if wanted.soles[side].contact is None:
            np.testing.assert_array_equal(wrench, 0.0)
            continue
        assert wrench[2] >= 0.0
        assert abs(wrench[0]) + abs(wrench[1]) <= PARAMETERS.friction * wrench[2] + 1e-9
        half = standing.model.foothold_sole.max(axis=0)
        assert abs(wrench[4]) <= half[0] * wrench[2] + 1e-9
        assert abs(wrench[3]) <= half[1] * wrench[2] + 1e-9


def test_points_that_are_not_loaded_carry_nothing(standing: BodyDynamics) -> None:
    toes = np.array((True, False, False, True))
    wanted = tasks(standing, loaded=toes)
    command = WholeBodyController(standing.model, PARAMETERS, ExactSolver).solve(standing, wanted)
    toe = standing.model.foothold_sole[:, 0].max()
    for wrench in command.wrenches_sole.values():
        assert -wrench[4] == pytest.approx(toe * wrench[2], abs=1e-6)


def test_at_rest_the_forces_carry_the_weight_and_nothing_moves(standing: BodyDynamics) -> None:
    command = WholeBodyController(standing.model, PARAMETERS).solve(standing, tasks(standing))
    weight = standing.model.mass * GRAVITY
    total = sum(command.wrenches_sole.values(), np.zeros(6))
    np.testing.assert_allclose(total[:3], (0.0, 0.0, weight), atol=2e-3 * weight)
    np.testing.assert_allclose(command.acceleration, 0.0, atol=0.02)
    shares = [wrench[2] / weight for wrench in command.wrenches_sole.values()]
    np.testing.assert_allclose(shares, 0.5, atol=0.02)


@pytest.mark.parametrize("make_solver", (None, ExactSolver))
def test_torques_stay_within_their_limits_where_the_tasks_ask_for_more(
    standing: BodyDynamics, make_solver: Callable[[Mask, Mask], QpSolver] | None
) -> None:
    wanted = replace(tasks(standing, on=(Side.LEFT,)), posture_acceleration=np.full(23, 500.0))
    wanted = replace(wanted, posture_weights=np.full(23, 100.0))
    command = WholeBodyController(standing.model, PARAMETERS, make_solver).solve(standing, wanted)
    used = np.abs(command.torques) / standing.model.effort_limits
    assert np.max(used) <= 1.0
    assert np.max(used) > 0.99
    np.testing.assert_allclose(joint_forces(standing, command)[6:], command.torques, rtol=1e-2, atol=2.0)


def test_joints_that_are_driven_against_their_limits_slow_down_and_stay_inside(standing: BodyDynamics) -> None:
    model, dt = standing.model, 0.002
    controller = WholeBodyController(model, PARAMETERS, ExactSolver)
    elbow = model.joint_names.index("left_elbow_pitch")
    wanted = tasks(standing)
    wanted.posture_acceleration[elbow], wanted.posture_weights[elbow] = 60.0, 10.0
    rates, angles = [], []
    for _ in range(400):
        command = controller.solve(standing, wanted)
        v = standing.v + dt * command.acceleration
        standing.update(pin.integrate(model.pin_model, standing.q, dt * v), v)
        rates.append(v[6 + elbow])
        angles.append(standing.q[7 + elbow])
    limit = model.upper_limits[elbow]
    assert max(angles) <= limit + 1e-9
    assert limit - angles[-1] < 0.01
    fastest = int(np.argmax(rates))
    assert limit - angles[fastest] > 0.1
    assert all(behind <= before for before, behind in pairwise(rates[fastest:]))


def test_a_joint_beyond_its_limit_is_brought_back(standing: BodyDynamics, model: RobotModel) -> None:
    q = standing.q.copy()
    elbow = model.joint_names.index("left_elbow_pitch")
    q[7 + elbow] = model.upper_limits[elbow] + 0.05
    standing.update(q, standing.v)
    command = WholeBodyController(model, PARAMETERS, ExactSolver).solve(standing, tasks(standing))
    assert command.status is QpStatus.SOLVED
    assert command.acceleration[6 + elbow] < -1.0


def test_a_tilted_contact_carries_the_weight_along_its_own_normal_and_friction(
    model: RobotModel, stance: Stance
) -> None:
    R = rotation_y(0.26)
    tilted = Stance(*(Pose(R, stance.sole(side).p) for side in Side))
    body = BodyDynamics(model)
    body.update(standing_configuration(model, tilted, WalkingParameters()), np.zeros(model.pin_model.nv))
    command = WholeBodyController(model, PARAMETERS, ExactSolver).solve(body, tasks(body))
    total = sum((R @ wrench[:3] for wrench in command.wrenches_sole.values()), np.zeros(3))
    np.testing.assert_allclose(total, (0.0, 0.0, model.mass * GRAVITY), atol=1.0)
    for wrench in command.wrenches_sole.values():
        assert abs(wrench[0]) / wrench[2] == pytest.approx(np.tan(0.26), abs=0.02)


def block_under_the_left_foot(points: Array) -> Array:
    return np.where((points[:, 0] > 0.15) & (points[:, 1] > 0.0), 0.1, 0.0)


def test_osqp_finds_what_an_exact_solver_finds_on_the_programs_of_a_walk(
    make_body: Callable[..., PerfectBody], make_steps: Callable[..., tuple[Footstep, ...]]
) -> None:
    logs: list[Logged] = []

    def make_solver(P_pattern: Mask, A_pattern: Mask) -> QpSolver:
        logs.append(Logged(osqp(P_pattern, A_pattern), []))
        return logs[0]

    body = make_body(block_under_the_left_foot, make_solver)
    body.walk(*make_steps(3, timing=(0.6, 0.2), height=lambda i: 0.1 * (i != 1)), rest=0.0)
    assert len(body.landings()) == 3
    exact, nv = ExactSolver(np.empty(0, dtype=bool), np.empty(0, dtype=bool)), len(body.v)
    weight = body.model.mass * GRAVITY
    costs, wrenches = [], []
    for (P, q, A, lower, upper), found in logs[0].problems[::7]:
        best = exact.solve(P, q, A, lower, upper)
        assert (found.status, best.status) == (QpStatus.SOLVED, QpStatus.SOLVED)
        worth = [0.5 * x @ P @ x + q @ x for x in (found.x, best.x)]
        costs.append(abs(worth[0] - worth[1]) / (1.0 + abs(worth[1])))
        wrenches.append(np.linalg.norm(A[:3, nv:] @ (found.x - best.x)[nv:]) / weight)
    assert len(costs) > 30
    assert np.median(costs) < 1e-3, costs
    assert np.max(costs) < 5e-2, costs
    assert np.median(wrenches) < 1e-3, wrenches
    assert np.max(wrenches) < 2e-2, wrenches


@pytest.mark.parametrize(
    "answer",
    (
        QpSolution(np.full(61, np.nan), QpStatus.FAILED, 0),
        QpSolution(np.full(61, np.nan), QpStatus.SOLVED, 0),
        QpSolution(np.full(61, 1e300), QpStatus.FAILED, 0),
    ),
    ids=("failed", "not numbers", "failed with numbers"),
)
def test_a_solver_that_fails_leaves_finite_torques_and_is_counted(
    make_body: Callable[..., PerfectBody], answer: QpSolution
) -> None:
    body = make_body(make_solver=lambda P, A: Broken(osqp(P, A), answer, healthy_calls=20))
    body.advance(0.2)
    assert body.walker.qp_failures == 0
    for failures in range(1, 11):
        body.advance(0.01)
        command = body.command
        assert command is not None
        assert command.status is QpStatus.FAILED
        assert np.all(np.isfinite(command.torques))
        assert np.all(np.isfinite(command.acceleration))
        assert np.all(np.abs(command.torques) <= body.model.effort_limits)
        assert body.walker.qp_failures == failures
    # The torques of the last good tick still carry the robot.
    assert np.max(np.abs(body.v)) < 0.05
