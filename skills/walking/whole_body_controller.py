"""Momentum-based whole-body control: from desired motions to joint torques by one quadratic program a tick.

After Koolen et al., "Design of a momentum-based control framework and application to the humanoid robot Atlas" (2016):
the unknowns are the acceleration of every joint and of the pelvis, and the weights of the rays that span the friction
pyramids at the contact points,

    minimize    sum over tasks of  w |J a + drift - desired|^2  +  w_f |rho|^2
    subject to  M_b a + h_b = (J' W rho)_b                     the pelvis is not driven
                -tau_max <= M_j a + h_j - (J' W rho)_j <= tau_max
                joint accelerations that stop in front of the joints' limits
                0 <= rho, and rho = 0 where nothing touches

Stance feet are tasks of great weight, not constraints, so that the program stays feasible when legs are at their
limits.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from skills.footsteps.footstep import Side
from skills.geometry.pose import Array, Mask, cross
from skills.walking.body_dynamics import BodyDynamics
from skills.walking.contact import CONTACT_POINTS, RAYS, Contact
from skills.walking.quadratic_program import MakeSolver, OsqpSolver, QpSolver, QpStatus
from skills.walking.robot_model import RobotModel
from skills.walking.whole_body_parameters import WholeBodyParameters

_GRAVITY = 9.81
_WEIGHT_OF_RAYS = 17.0  # Weights of rays are in this part of the robot's weight, so that all unknowns are of one size.
_CORNERS = RAYS // CONTACT_POINTS
_ROWS = 21  # CoM 3, angular momentum 3, torso 3, soles 6 each; pelvis and posture are single columns.
_SAMPLES = 8


@dataclass(frozen=True, slots=True, eq=False)
class SoleTask:
    """What one sole shall do.

    Attributes:
        acceleration: spatial acceleration in the sole frame, linear first, (6,).
        weights: of its rows, (6,).
        reference_sole: the point of the sole whose linear acceleration is meant, (3,) [m].
        contact: where the ground may push; None in the air.
    """

    acceleration: Array
    weights: Array
    reference_sole: Array
    contact: Contact | None


@dataclass(frozen=True, slots=True, eq=False)
class BodyTasks:
    """What the whole body shall do in one tick.

    Attributes:
        com_acceleration: in the world, (3,) [m/s^2].
        momentum_rate: rate of the angular momentum about the CoM, (3,) [N m].
        pelvis_acceleration, torso_acceleration: angular, each in its own frame, (3,) [rad/s^2].
        posture_acceleration: of the joints, (n,) [rad/s^2].
        posture_weights: (n,).
        soles: of both feet.
    """

    com_acceleration: Array
    momentum_rate: Array
    pelvis_acceleration: Array
    torso_acceleration: Array
    posture_acceleration: Array
    posture_weights: Array
    soles: Mapping[Side, SoleTask]


@dataclass(frozen=True, slots=True, eq=False)
class BodyCommand:
    """What the joints shall do.

    Attributes:
        torques: within the joints' limits, (n,) [N m].
        acceleration: of pelvis and joints in pinocchio's order, (6 + n,).
        wrenches_sole: of the ground on each sole in its own frame, force first, (6,) [N, N m].
        status: how the quadratic program ended.
        iterations: of its solver.
        solver_time: by the solver's own clock [s].
    """

    torques: Array
    acceleration: Array
    wrenches_sole: Mapping[Side, Array]
    status: QpStatus
    iterations: int
    solver_time: float = 0.0


class WholeBodyController:
    """Turns tasks into torques for one robot; not for use by two threads at once.

    Where the program fails, the robot brakes.

    Args:
        model: the robot.
        parameters: weights, gains and limits.
        make_solver: of a program with the given patterns of P and A; OSQP by default.
    """

    def __init__(
        self,
        model: RobotModel,
        parameters: WholeBodyParameters,
        make_solver: MakeSolver | None = None,
    ) -> None:
        self._model, self._parameters = model, parameters
        self._force_unit = model.mass * _GRAVITY / _WEIGHT_OF_RAYS
        n = self._joints = len(model.joint_names)
        nv = self._nv = n + 6
        size, rows = nv + 2 * RAYS, nv + n + 2 * RAYS
        self._P, self._q = np.zeros((size, size)), np.zeros(size)
        forces = slice(nv, size)
        self._P[forces, forces] = np.diag(np.full(2 * RAYS, 2.0 * parameters.force_weight))
        self._A, self._lower, self._upper = np.zeros((rows, size)), np.zeros(rows), np.zeros(rows)
        self._A[nv:rows, 6:size] = np.eye(n + 2 * RAYS)
        self._task_rows, self._targets, self._weights = np.zeros((_ROWS, nv)), np.zeros(_ROWS), np.zeros(_ROWS)
        self._effort = model.effort_limits
        self._damping = np.array(model.pin_model.damping[6:])
        self._solver = (make_solver or self._osqp)(*self._patterns())
        self._torques = np.zeros(n)

    def solve(self, body: BodyDynamics, tasks: BodyTasks) -> BodyCommand:
        """The torques that serve the tasks best in the present state."""
        self._write_objective(body, tasks)
        self._write_constraints(body, tasks)
        solution = self._solver.solve(self._P, self._q, self._A, self._lower, self._upper)
        if solution.status is QpStatus.FAILED or not np.all(np.isfinite(solution.x)):
            return self.brake(body)
        acceleration = solution.x[: self._nv]
        rho = np.maximum(solution.x[self._nv :], 0.0)
        rows = slice(6, self._nv)
        torques = self._A[rows] @ np.concatenate((acceleration, rho)) + body.bias[6:]
        self._torques = np.clip(torques, -self._effort, self._effort)
        wrenches = {
            side: np.zeros(6) if task.contact is None else task.contact.rays_wrench @ (part * self._force_unit)
            for (side, task), part in zip(_in_order(tasks), np.split(rho, 2), strict=True)
        }
        return BodyCommand(self._torques, acceleration, wrenches, solution.status, solution.iterations, solution.time)

    def brake(self, body: BodyDynamics) -> BodyCommand:
        """The torques of the tick before, less what brakes the joints: for a tick without a solution."""
        torques = np.clip(self._torques - self._damping * body.v[6:], -self._effort, self._effort)
        still = -self._parameters.stance_damping * body.v
        return BodyCommand(torques, still, {side: np.zeros(6) for side in Side}, QpStatus.FAILED, 0)

    def _write_objective(self, body: BodyDynamics, tasks: BodyTasks) -> None:
        p, nv = self._parameters, self._nv
        J, target, weight = self._task_rows, self._targets, self._weights
        J[0:3] = body.momentum_matrix[:3] / self._model.mass
        target[0:3] = tasks.com_acceleration - body.momentum_drift[:3] / self._model.mass
        weight[0:2], weight[2] = p.com_weight, p.height_weight
        J[3:6] = body.momentum_matrix[3:]
        target[3:6], weight[3:6] = tasks.momentum_rate - body.momentum_drift[3:], p.momentum_weight
        J[6:9], target[6:9], weight[6:9] = (
            body.torso_jacobian,
            tasks.torso_acceleration - body.torso_drift,
            p.torso_weight,
        )
        for row, (side, task) in zip((9, 15), _in_order(tasks), strict=True):
            rows = slice(row, row + 6)
            J[rows], target[rows] = body.sole_jacobians[side], task.acceleration - body.sole_drifts[side]
            if task.reference_sole.any():
                _move_reference(J[rows], target[rows], task.reference_sole)
            weight[rows] = task.weights
        weighted = 2.0 * weight[:, None] * J
        H, q = self._P[:nv, :nv], self._q
        np.matmul(J.T, weighted, out=H)
        q[:nv] = -(target @ weighted)
        diagonal = H.reshape(-1)[:: nv + 1] if H.flags.c_contiguous else np.einsum("ii->i", H)
        diagonal[3:6] += 2.0 * p.pelvis_weight
        q[3:6] -= 2.0 * p.pelvis_weight * tasks.pelvis_acceleration
        diagonal[6:] += 2.0 * tasks.posture_weights
        q[6:nv] -= 2.0 * tasks.posture_weights * tasks.posture_acceleration

    def _write_constraints(self, body: BodyDynamics, tasks: BodyTasks) -> None:
        nv, n = self._nv, self._joints
        A, lower, upper = self._A, self._lower, self._upper
        A[:nv, :nv] = body.mass_matrix
        lower[:6] = upper[:6] = -body.bias[:6]
        lower[6:nv] = -self._effort - body.bias[6:]
        upper[6:nv] = self._effort - body.bias[6:]
        lower[nv : nv + n], upper[nv : nv + n] = self._acceleration_limits(body)
        for start, (side, task) in zip((nv, nv + RAYS), _in_order(tasks), strict=True):
            columns, bounds = slice(start, start + RAYS), slice(start + n, start + n + RAYS)
            if task.contact is None:
                A[:nv, columns], upper[bounds] = 0.0, 0.0
            else:
                A[:nv, columns] = body.sole_jacobians[side].T @ (-self._force_unit * task.contact.rays_wrench)
                upper[bounds] = np.where(np.repeat(task.contact.loaded, _CORNERS), np.inf, 0.0)

    def _acceleration_limits(self, body: BodyDynamics) -> tuple[Array, Array]:
        """Bounds that let joints near their limits as a critically damped spring would, (n,) each [rad/s^2]."""
        k = self._parameters.joint_limit_rate
        angles, rates = body.q[7:], body.v[6:]
        lower = k * k * (self._model.lower_limits - angles) - 2.0 * k * rates
        upper = k * k * (self._model.upper_limits - angles) - 2.0 * k * rates
        # A joint beyond its limit, or fast, may ask for more than others can give: keep zero to either side of a gap.
        return np.minimum(lower, upper), np.maximum(lower, upper)

    def _osqp(self, P_pattern: Mask, A_pattern: Mask) -> QpSolver:
        p = self._parameters
        return OsqpSolver(P_pattern, A_pattern, p.qp_tolerance, p.qp_iterations, p.qp_check)

    def _patterns(self) -> tuple[Mask, Mask]:
        """Where P and A can have values, from states in which nothing is zero by chance."""
        nv = self._nv
        P, A = self._P != 0.0, self._A != 0.0
        P[:nv, :nv] = True
        body, rng = BodyDynamics(self._model), np.random.default_rng(0)
        for _ in range(_SAMPLES):
            q = self._model.neutral_configuration()
            q[7:] = rng.uniform(self._model.lower_limits, self._model.upper_limits)
            body.update(q, rng.standard_normal(nv))
            A[:nv, :nv] |= body.mass_matrix != 0.0
            for start, side in zip((nv, nv + RAYS), Side, strict=True):
                A[:nv, start : start + RAYS] |= np.any(body.sole_jacobians[side] != 0.0, axis=0)[:, None]
        return P, A


def _in_order(tasks: BodyTasks) -> tuple[tuple[Side, SoleTask], ...]:
    return tuple((side, tasks.soles[side]) for side in Side)


def _move_reference(J: Array, target: Array, r: Array) -> None:
    """Let a spatial task (6 rows) mean the linear acceleration at a point r of the same body."""
    J[:3] += cross(J[3:], r)
    target[:3] += cross(target[3:], r)
