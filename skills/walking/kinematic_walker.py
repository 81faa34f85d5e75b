"""A robot that walks over footsteps as if its joints tracked perfectly, by balance plan and inverse kinematics.

The gait says what the feet do, balance moves the CoM above them, and inverse kinematics turns CoM and soles into joint
angles. A newer plan replaces the queued steps at any time. It fails honestly: a DCM that leaves the support, or a
foothold out of reach, is a fall.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import ceil

import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports]

from skills.footsteps.footstep import Footstep, Side, Stance
from skills.geometry.pose import Array, Pose, rotation_y, rotation_z, wrap_angle
from skills.walking.balance import Balance
from skills.walking.gait import Gait
from skills.walking.inverse_kinematics import IkSolution, InverseKinematics
from skills.walking.preview import resting_phase
from skills.walking.robot_model import RobotModel
from skills.walking.uniform_spline import minimum_jerk_at
from skills.walking.walking_parameters import WalkingParameters
from skills.walking.walking_state import (
    ControlSample,
    RobotState,
    StepEvent,
    WalkingPhase,
    WalkingStatus,
)

_FIRST_ITERATIONS = 100
_INSTANT = 1e-9
_LEVEL = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class WalkerOutput:
    """What one control step of the walker commands.

    Attributes:
        time: robot time [s].
        phase: what the legs are doing.
        q: configuration in pinocchio's order, (7 + n,).
        v: velocity in pinocchio's order, (6 + n,).
        stance: both soles as they are now, also in the air.
        com_world, dcm_world, dcm_reference_world, cop_world: (3,) [m].
        dcm_error: distance of the DCM from its reference in the plane [m].
    """

    time: float
    phase: WalkingPhase
    q: Array
    v: Array
    stance: Stance
    com_world: Array
    dcm_world: Array
    dcm_reference_world: Array
    cop_world: Array
    dcm_error: float


class KinematicWalker:
    """Walks a queue of footsteps.

    Args:
        model: the robot.
        parameters: settings of walking.
        stance: both soles at the start, where the robot stands.
        time: robot time at the start [s].

    Raises:
        ValueError: where the robot cannot stand like that.
    """

    def __init__(self, model: RobotModel, parameters: WalkingParameters, stance: Stance, time: float = 0.0) -> None:
        self._model, self._parameters, self._time = model, parameters, time
        self._ik = InverseKinematics(model)
        self._gait = Gait(stance, model.foothold_sole, parameters)
        self._yaw = self._yaw_from = stance.yaw
        self._paused, self._failure = False, ""
        self._events: list[StepEvent] = []
        self._log: list[ControlSample] = []
        self._q, height = self._standing_configuration(stance)
        self._v = self._v_before = np.zeros(model.pin_model.nv)
        self._height_error = 0.0
        self._balance = Balance(self._gait, height, model, parameters)
        self._replan()
        self._output = self._make_output(stance)

    @property
    def output(self) -> WalkerOutput:
        """The newest command."""
        return self._output

    @property
    def time(self) -> float:
        """Robot time [s]."""
        return self._time

    def send(self, steps: Sequence[Footstep]) -> None:
        """Replace the queue; the step whose foot is in the air goes on.

        Steps that began already are dropped by their sequence ids. In double support the step to come gives way to a
        plan that begins with the same foot. After a fall nothing happens.

        Raises:
            ValueError: where the steps cannot follow the current one; the queue stays as it was.
        """
        if not self._failure:
            self._gait.accept(steps)
            self._paused = False
            self._replan()

    def pause(self) -> None:
        """Drop the queue, finish the current step, then stand."""
        if not self._failure:
            self._gait.queue, self._paused = (), True
            self._replan()

    def fall(self, reason: str) -> None:
        """End walking for a reason that the operator reads; the first one stays."""
        if not self._failure:
            self._failure, self._gait.queue = reason, ()
            self._v = np.zeros_like(self._v)
            self._output = self._make_output(self._output.stance)

    def advance(self, dt: float) -> WalkerOutput:
        """Walk on, in control steps no longer than the control period [s]; after a fall nothing moves."""
        count = max(1, ceil(dt / self._parameters.control_period - _INSTANT))
        for _ in range(count):
            self._control(dt / count)
        return self._output

    def status(self) -> WalkingStatus:
        """What the walker is doing."""
        gait = self._gait
        standing = gait.phase is WalkingPhase.STANDING
        imminent = gait.stance
        if gait.step is not None:
            imminent = imminent.with_sole(gait.step.side, gait.step.T_world_sole)
        return WalkingStatus(
            phase=self._phase,
            phase_elapsed=0.0 if standing else gait.elapsed,
            phase_duration=0.0 if standing else gait.duration,
            current_step=gait.step,
            queue=gait.queue,
            imminent_stance=imminent,
            last_side=gait.last_side if gait.step is None else gait.step.side,
            paused=self._paused,
            failure=self._failure,
            last_sequence_id=gait.last_sequence_id,
        )

    def state(self) -> RobotState:
        """The robot as it is now."""
        output = self._output
        return RobotState(
            time=output.time,
            T_world_pelvis=self._model.pelvis_pose(output.q),
            joint_positions=output.q[7:],
            joint_velocities=output.v[6:],
            stance=output.stance,
            com_world=output.com_world,
            dcm_world=output.dcm_world,
        )

    def drain_events(self) -> tuple[StepEvent, ...]:
        """Step events since the last call, oldest first."""
        events, self._events = tuple(self._events), []
        return events

    def drain_log(self) -> tuple[ControlSample, ...]:
        """Control samples since the last call, oldest first."""
        log, self._log = tuple(self._log), []
        return log

    @property
    def _phase(self) -> WalkingPhase:
        return WalkingPhase.FALLEN if self._failure else self._gait.phase

    def _control(self, dt: float) -> None:
        """One control step [s]."""
        left = dt
        while left > _INSTANT and not self._failure:
            left -= self._advance_within_phase(left)
        self._time += left
        soles = self._output.stance
        if not self._failure:
            soles = self._move_joints(self._gait.soles(), dt)
        self._output = self._make_output(soles)
        self._log.append(_sample(self._output))

    def _advance_within_phase(self, longest: float) -> float:
        """Let time pass to the end of the phase at most, and end it there; the time that passed [s]."""
        gait = self._gait
        duration = max(0.0, min(longest, gait.duration - gait.elapsed))
        if duration > 0.0:
            self._balance.advance(duration)
            gait.elapsed += duration
            self._time += duration
        if gait.elapsed >= gait.duration - _INSTANT:
            self._end_phase()
        lost = self._balance.fall()
        if lost:
            self.fall(lost)
        return duration

    def _end_phase(self) -> None:
        gait = self._gait
        if gait.phase is WalkingPhase.TRANSFER and gait.step is not None and self._balance.must_hold():
            gait.prolong(self._parameters.hold_extension)
        else:
            self._yaw = self._yaw_from = self._heading()
            event = gait.end_phase(self._time)
            if event is not None:
                self._events.append(event)
        self._replan()

    def _replan(self) -> None:
        self._balance.replan(self._q[:3], self._yaw)

    def _move_joints(self, soles: Stance, dt: float) -> Stance:
        """Solve for the configuration that has the CoM and the soles where they should be now; where the soles are."""
        p, pin_model, gait = self._parameters, self._model.pin_model, self._gait
        swinging = gait.step.side if gait.step is not None and gait.phase is WalkingPhase.SWING else None
        self._ik.free_orientation(swinging, gait.freedom_in_air())
        self._yaw = self._heading()
        # From the motion continued with its present acceleration, one Newton step is enough nearly always.
        guess = pin.integrate(pin_model, self._q, (2.0 * self._v - self._v_before) * dt)
        solution = self._ik.solve(
            guess, self._balance.com_world, self._pelvis_rotation(), soles, p.ik_iterations, p.ik_tolerance
        )
        failure = _out_of_reach(solution, p)
        if failure:
            self.fall(failure)
            return self._output.stance
        self._v_before, self._v = self._v, pin.difference(pin_model, self._q, solution.q) / dt
        self._q, self._height_error = solution.q, solution.height_error
        if swinging is not None and solution.tilt_error > _LEVEL:
            soles = soles.with_sole(swinging, self._model.sole_pose(self._q, swinging))
        return soles

    def _heading(self) -> float:
        """Heading of the pelvis now: turns in the swing to the mean of the feet [rad]."""
        gait = self._gait
        if gait.phase is not WalkingPhase.SWING or gait.step is None:
            return self._yaw_from
        landed = gait.stance.with_sole(gait.step.side, gait.step.T_world_sole)
        share = minimum_jerk_at(gait.elapsed / gait.duration)
        return wrap_angle(self._yaw_from + share * wrap_angle(landed.yaw - self._yaw_from))

    def _pelvis_rotation(self) -> Array:
        return rotation_z(self._yaw) @ rotation_y(self._parameters.pelvis_pitch)

    def _standing_configuration(self, stance: Stance) -> tuple[Array, float]:
        """A configuration on a stance, and its CoM height."""
        p, model = self._parameters, self._model
        height = resting_phase(stance, None, 1.0, p).ground_end + p.com_height
        com = np.array((*stance.mid_feet[:2], height))
        q = _posture(model, p)
        q[:3] = com - model.com(q)
        q[3:7] = Pose(self._pelvis_rotation(), np.zeros(3)).quaternion_xyzw
        solution = self._ik.solve(q, com, self._pelvis_rotation(), stance, _FIRST_ITERATIONS, p.ik_tolerance)
        failure = _out_of_reach(solution, p)
        if failure:
            raise ValueError(
                f"the robot cannot stand on soles at {stance.T_world_left.p}, {stance.T_world_right.p}: {failure}"
            )
        return solution.q, height + solution.height_error

    def _make_output(self, soles: Stance) -> WalkerOutput:
        balance = self._balance
        height = balance.height + self._height_error
        dcm_height = height + balance.height_velocity / balance.omega
        return WalkerOutput(
            time=self._time,
            phase=self._phase,
            q=self._q,
            v=self._v,
            stance=soles,
            com_world=np.array((*balance.com, height)),
            dcm_world=np.array((*balance.dcm, dcm_height)),
            dcm_reference_world=np.array((*balance.dcm_reference, dcm_height)),
            cop_world=np.array((*balance.cop, self._gait.stance.mid_feet[2])),
            dcm_error=balance.dcm_error,
        )


def _sample(output: WalkerOutput) -> ControlSample:
    return ControlSample(
        time=output.time,
        phase=output.phase,
        com_world=output.com_world,
        dcm_world=output.dcm_world,
        dcm_reference_world=output.dcm_reference_world,
        cop_world=output.cop_world,
        dcm_error=output.dcm_error,
    )


def _posture(model: RobotModel, parameters: WalkingParameters) -> Array:
    """Bent knees, arms at the sides, (7 + n,) with the pelvis at the origin."""
    q = model.neutral_configuration()
    for side in Side:
        for name, angle in (
            ("shoulder_yaw", parameters.shoulder_yaw * side.sign),
            ("shoulder_roll", parameters.shoulder_roll * side.sign),
            ("elbow_pitch", parameters.elbow_pitch),
            ("elbow_roll", parameters.elbow_roll * side.sign),
        ):
            joint = f"{side.value}_{name}"
            if joint in model.joint_names:
                q[7 + model.joint_names.index(joint)] = angle
        hip, knee, ankle = model.legs[side].joints[2:5]
        bend = parameters.knee_bend
        q[[7 + hip, 7 + knee, 7 + ankle]] = -0.5 * bend, bend, -0.5 * bend
    q[7:] = np.clip(q[7:], model.lower_limits, model.upper_limits)
    return q


def _out_of_reach(solution: IkSolution, parameters: WalkingParameters) -> str:
    """One sentence where inverse kinematics missed its targets; empty where it did not."""
    errors = (
        (solution.left_error, parameters.sole_residual, "the left sole"),
        (solution.right_error, parameters.sole_residual, "the right sole"),
        (solution.com_error, parameters.com_residual, "the CoM"),
    )
    for error, limit, name in errors:
        if error > limit:
            return f"inverse kinematics cannot reach the commanded motion (residual {1000 * error:.0f} mm at {name})"
    return ""
