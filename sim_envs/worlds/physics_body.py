"""The robot's body under physics: its walking controller measures it, and torques move it.

Each control step the controller sees the state, with noise where the configuration says so, and commands torques, which
reach the joints after the actuators' delay. MuJoCo integrates between control steps (Todorov et al., 2012).
"""

# mujoco keeps its types in binary modules without stubs.
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections import deque

import mujoco
import numpy as np
from numpy.typing import NDArray

from sim_envs.robot import configuration_from_qpos, qpos_from_configuration, velocity_from_qvel
from skills.footsteps.footstep import Side
from skills.geometry.pose import Array
from skills.parameters import parameter, parameters
from skills.walking import BodyMeasurement, Walker

_STREAM = 7  # Tells the noise of the state from other random numbers of the same seed.


@parameters
class PhysicsParameters:
    """Rates and errors of a body under physics."""

    control_rate: float = parameter(
        500.0, unit="Hz", minimum=50.0, maximum=2000.0, meaning="control steps a second of robot time"
    )
    time_step: float = parameter(0.001, unit="s", minimum=1e-4, maximum=0.005, meaning="integration step")
    torque_delay: float = parameter(
        0.0, unit="s", minimum=0.0, maximum=0.05, meaning="time from a command to its torque"
    )
    torque_noise: float = parameter(
        0.0, unit="1", minimum=0.0, maximum=0.5, meaning="standard deviation of torques, relative to their limits"
    )
    position_noise: float = parameter(
        0.0, unit="m", minimum=0.0, maximum=0.1, meaning="standard deviation of the pelvis position"
    )
    velocity_noise: float = parameter(
        0.0, unit="m/s", minimum=0.0, maximum=1.0, meaning="standard deviation of the pelvis velocity, also in rad/s"
    )
    joint_noise: float = parameter(
        0.0, unit="rad", minimum=0.0, maximum=0.1, meaning="standard deviation of joint angles"
    )
    joint_rate_noise: float = parameter(
        0.0, unit="rad/s", minimum=0.0, maximum=2.0, meaning="standard deviation of joint rates"
    )
    friction: float = parameter(0.8, unit="1", minimum=0.1, maximum=2.0, meaning="coefficient of friction of the soles")
    torso_mass_error: float = parameter(
        0.0, unit="1", minimum=-0.5, maximum=1.0, meaning="share by which the torso is heavier than the robot believes"
    )


class PhysicsBody:
    """A robot that is driven by torques.

    Args:
        model, data: compiled world with the robot as its only free body.
        walker: its walking controller.
        parameters: rates and errors.
        prefix: of the robot's names in the model.
        seed: of the noise.
        torso: name of the body whose mass may be off.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        walker: Walker,
        parameters: PhysicsParameters,
        prefix: str,
        seed: int,
        torso: str = "torso",
    ) -> None:
        self._model, self._data, self._walker, self._parameters = model, data, walker, parameters
        _make_true(model, parameters, prefix, torso)
        self._rng = np.random.default_rng((seed, _STREAM))
        self._substeps = max(1, round(1.0 / (parameters.control_rate * model.opt.timestep)))
        self._delayed: deque[Array] = deque()
        self._delay = round(parameters.torque_delay * parameters.control_rate)
        self._touch = {side: model.sensor(f"{prefix}{side.value}_touch").adr[0] for side in Side}
        self._wrench = {side: _wrench_rows(model, f"{prefix}{side.value}") for side in Side}
        self._effort = model.jnt_actfrcrange[1:, 1]
        self._control_steps = 0
        data.qpos[:] = qpos_from_configuration(walker.start_configuration)
        data.qvel[:] = 0.0
        mujoco.mj_forward(model, data)

    @property
    def time(self) -> float:
        """Robot time [s]."""
        return self._control_steps / self._parameters.control_rate

    @property
    def next_time(self) -> float:
        """Robot time after the next control step [s]."""
        return (self._control_steps + 1) / self._parameters.control_rate

    def true_configuration(self) -> tuple[Array, Array]:
        """Configuration and velocity in pinocchio's order without noise."""
        q = configuration_from_qpos(self._data.qpos)
        return q, velocity_from_qvel(q, self._data.qvel)

    def advance(self) -> None:
        """One control step: measure, command, integrate."""
        self._control_steps += 1
        command = self._walker.control(self._measure())
        self._data.ctrl[:] = self._actuated(command.torques)
        mujoco.mj_step(self._model, self._data, self._substeps)

    def _measure(self) -> BodyMeasurement:
        q, v = self.true_configuration()
        loads = {side: float(self._data.sensordata[address]) for side, address in self._touch.items()}
        p, rng = self._parameters, self._rng
        if p.position_noise:
            q[:3] += p.position_noise * rng.standard_normal(3)
        if p.joint_noise:
            q[7:] += p.joint_noise * rng.standard_normal(len(q) - 7)
        if p.velocity_noise:
            v[:6] += p.velocity_noise * rng.standard_normal(6)
        if p.joint_rate_noise:
            v[6:] += p.joint_rate_noise * rng.standard_normal(len(v) - 6)
        # The cells tell what the leg does to the foot; the ground does the opposite, but for the foot's own weight.
        wrenches = {side: -self._data.sensordata[rows] for side, rows in self._wrench.items()}
        return BodyMeasurement(self.time, q, v, loads, wrenches)

    def _actuated(self, torques: Array) -> Array:
        if self._parameters.torque_noise:
            noise = self._rng.standard_normal(len(torques))
            torques = torques + self._parameters.torque_noise * self._effort * noise
        self._delayed.append(torques)
        return self._delayed.popleft() if len(self._delayed) > self._delay else self._delayed[0]


def _wrench_rows(model: mujoco.MjModel, foot: str) -> NDArray[np.intp]:
    """Where the sensors of the force and the torque between a foot and its ankle have their values, (6,)."""
    first = [int(model.sensor(f"{foot}_{kind}").adr[0]) for kind in ("force", "torque")]
    return np.concatenate([np.arange(address, address + 3) for address in first])


def _make_true(model: mujoco.MjModel, parameters: PhysicsParameters, prefix: str, torso: str) -> None:
    """Give a compiled model what physics has and the robot does not know."""
    model.opt.timestep = parameters.time_step
    for side in Side:
        model.geom(f"{prefix}{side.value}_foot_collision").friction[0] = parameters.friction
    body = model.body(f"{prefix}{torso}")
    body.mass[:] *= 1.0 + parameters.torso_mass_error
    body.inertia[:] *= 1.0 + parameters.torso_mass_error
