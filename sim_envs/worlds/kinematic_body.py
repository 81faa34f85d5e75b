"""The robot's body without dynamics: the accelerations that its walking controller commands come true.

Each control step integrates them, so that a minute of walking takes seconds. A foot is loaded when the controller
presses it down and it is on the ground; at touchdown the velocity is projected onto what the feet on the ground allow,
as an impact without bounce would do (Featherstone, "Rigid Body Dynamics Algorithms", 2008, ch. 11).
"""

# mujoco keeps its types in binary modules without stubs.
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Callable

import mujoco
import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports]

from sim_envs.courses import Ground
from sim_envs.robot import RobotDescription, qpos_from_configuration
from skills.footsteps.footstep import Side
from skills.geometry.pose import Array
from skills.parameters import parameter, parameters
from skills.walking import BodyMeasurement, RobotModel, Walker
from skills.walking.body_dynamics import BodyDynamics

_GRAVITY = 9.81


@parameters
class KinematicParameters:
    """Rate and contact of a body without dynamics."""

    control_rate: float = parameter(
        100.0, unit="Hz", minimum=10.0, maximum=1000.0, meaning="control steps a second of robot time"
    )
    stance_stiffness: float = parameter(
        100.0,
        unit="1/s^2",
        minimum=0.0,
        maximum=1000.0,
        meaning="pull back to where a foot landed, which long steps in time would let slip",
    )


class KinematicBody:
    """A robot that moves as its walking controller commands.

    Args:
        data: of the compiled world, whose robot is put where the body is.
        walker: its walking controller.
        model: the robot.
        parameters: rates.
        robot: size of the soles.
        ground: the true ground as it is now.
    """

    def __init__(
        self,
        data: mujoco.MjData,
        walker: Walker,
        model: RobotModel,
        parameters: KinematicParameters,
        robot: RobotDescription,
        ground: Callable[[], Ground],
    ) -> None:
        self._data, self._walker, self._model, self._parameters = data, walker, model, parameters
        self._ground = ground
        self._corners_sole = np.column_stack((robot.sole_corners_sole, np.zeros(4)))
        self._dynamics = BodyDynamics(model)
        self._q = walker.start_configuration
        self._v = np.zeros(model.pin_model.nv)
        self._weight = model.mass * _GRAVITY
        self._supports = walker.supports
        self._gaps = dict.fromkeys(Side, 0.0)
        self._control_steps = 0
        self._place()

    @property
    def time(self) -> float:
        """Robot time [s]."""
        return self._control_steps / self._parameters.control_rate

    @property
    def next_time(self) -> float:
        """Robot time after the next control step [s]."""
        return (self._control_steps + 1) / self._parameters.control_rate

    def true_configuration(self) -> tuple[Array, Array]:
        """Configuration and velocity in pinocchio's order."""
        return self._q.copy(), self._v.copy()

    def advance(self) -> None:
        """One control step: measure, command, integrate."""
        self._control_steps += 1
        dt = 1.0 / self._parameters.control_rate
        command = self._walker.control(BodyMeasurement(self.time, self._q, self._v, self._loads()))
        v = self._v + command.acceleration * dt
        if self._walker.fallen:
            v = np.zeros_like(v)
        elif self._walker.supports != self._supports:
            v = self._without_impact(v)
        self._supports = self._walker.supports
        self._q, self._v = pin.integrate(self._model.pin_model, self._q, v * dt), v
        self._place()

    def _loads(self) -> dict[Side, float]:
        """The weight under every foot that the controller stands on, and under one in the air that touches."""
        loads = {}
        for side in Side:
            touches = side in self._supports or self._touches_ground(side)
            loads[side] = self._weight if touches else 0.0
        return loads

    def _touches_ground(self, side: Side) -> bool:
        """Whether a corner of the sole is nearer to the ground than it sinks in half a control step."""
        corners = self._model.sole_pose(self._q, side) @ self._corners_sole
        gap = float(np.min(corners[:, 2] - self._ground().ground_height(corners[:, :2])))
        sinking = self._gaps[side] - gap
        self._gaps[side] = gap
        return gap <= max(0.0, 0.5 * sinking)

    def _without_impact(self, v: Array) -> Array:
        """The velocity after an impact that brings all feet on the ground to rest, (6 + n,)."""
        body = self._dynamics
        body.update(self._q, v)
        J = np.vstack([body.sole_jacobians[side] for side in self._walker.supports])
        M_inverse_Jt = np.linalg.solve(body.mass_matrix, J.T)
        return v - M_inverse_Jt @ np.linalg.solve(J @ M_inverse_Jt, J @ v)

    def _place(self) -> None:
        self._data.qpos[:] = qpos_from_configuration(self._q)
