"""A robot that walks over footsteps as if its joints tracked perfectly, by balance plan and inverse kinematics.

Footsteps become phases of support, the phases a plan of CoP and divergent component of motion (DCM), and the DCM moves
the CoM under a CoP that stays within the soles (Englsberger et al., 2015); inverse kinematics turns CoM and soles into
joint angles. Everything is planned anew from the present at every phase and every newer plan. It fails honestly: a DCM
that leaves the support, or a foothold out of reach, is a fall.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio as pin

from skills.footsteps.footstep import Footstep, Side, Stance
from skills.geometry.pose import Array, Pose, rotation_y, rotation_z
from skills.walking.com_height import ComState, nominal_height, plan_height, reach_cap
from skills.walking.dcm_plan import DcmPlan, advance_exactly, plan_from_present
from skills.walking.heel_lift import HeelLift
from skills.walking.inverse_kinematics import IkSolution, InverseKinematics
from skills.walking.preview import (
    PlannedPhase,
    phases_of_steps,
    resting_phase,
    swing_phase,
    transfer_phase,
    yaw_towards,
)
from skills.walking.robot_model import RobotModel
from skills.walking.step_queue import accepted_steps
from skills.walking.support_polygon import SupportPolygon, foothold_corners
from skills.walking.swing_trajectory import SwingTrajectory
from skills.walking.uniform_spline import UniformSpline, minimum_jerk
from skills.walking.walking_parameters import WalkingParameters
from skills.walking.walking_state import (
    ControlSample,
    RobotState,
    StepEvent,
    StepEventKind,
    WalkingPhase,
    WalkingStatus,
)

_FIRST_ITERATIONS = 100
_INSTANT = 1e-9
_STANDING_PREVIEW = 1.0


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
        self._model, self._parameters = model, parameters
        self._omega = float(np.sqrt(parameters.gravity / parameters.com_height))
        self._ik = InverseKinematics(model)
        self._time = time
        self._phase = WalkingPhase.STANDING
        self._elapsed, self._duration = 0.0, np.inf
        self._held = 0.0
        self._step: Footstep | None = None
        self._queue: tuple[Footstep, ...] = ()
        self._newest_id: int | None = None
        self._last_side: Side | None = None
        self._paused = False
        self._failure = ""
        self._stance = stance
        self._footholds = dict.fromkeys(Side, model.foothold_sole)
        self._swing: SwingTrajectory | None = None
        self._heel: HeelLift | None = None
        self._events: list[StepEvent] = []
        self._log: list[ControlSample] = []
        self._com = self._dcm = self._cop = stance.mid_feet[:2]
        self._yaw_from = self._yaw = stance.yaw
        q, height = self._standing_configuration(stance)
        self._height_motion = (height, 0.0, 0.0)
        self._remember(q, np.zeros(model.pin_model.nv))
        self._replan()
        self._output = self._make_output()

    # Commands.

    def send(self, steps: Sequence[Footstep]) -> None:
        """Replace the queue; the step whose foot is in the air goes on.

        Steps that were begun already are dropped by their sequence ids. In double support the step to come gives way
        to a first step of the same foot.

        Raises:
            ValueError: where the steps cannot follow the current one; the queue stays as it was.
        """
        if self._phase is WalkingPhase.FALLEN:
            return
        replaces = False
        if self._phase is WalkingPhase.TRANSFER and self._step is not None:
            fresh = accepted_steps(steps, self._newest_id, None)
            replaces = (
                bool(fresh) and fresh[0].side is self._step.side and fresh[0].sequence_id >= self._step.sequence_id
            )
        if replaces or self._step is None:
            kept = accepted_steps(steps, self._newest_id, None)
        else:
            kept = accepted_steps(steps, self._step.sequence_id, self._step.side)
        self._paused = False
        if replaces:
            self._step, self._queue = kept[0], kept[1:]
        else:
            self._queue = kept
        if self._step is None and self._queue:
            self._start_transfer(self._parameters.first_transfer)
        else:
            self._replan()

    def pause(self) -> None:
        """Drop the queue, finish the current step, then stand."""
        if self._phase is WalkingPhase.FALLEN:
            return
        self._queue, self._paused = (), True
        self._replan()

    def fall(self, reason: str) -> None:
        """End walking for a reason that the operator reads; the first one stays."""
        if self._phase is not WalkingPhase.FALLEN:
            self._phase, self._failure = WalkingPhase.FALLEN, reason
            self._queue, self._v = (), np.zeros_like(self._v)
            self._output = self._make_output()

    # Time.

    def advance(self, dt: float) -> WalkerOutput:
        """Walk on for a control step [s]; after a fall time passes and nothing moves."""
        left = dt
        while left > _INSTANT and self._phase is not WalkingPhase.FALLEN:
            part = min(left, self._duration - self._elapsed)
            if part > _INSTANT:
                self._balance(part)
                self._elapsed += part
                self._time += part
                left -= part
            if self._elapsed >= self._duration - _INSTANT:
                self._end_phase()
        if self._phase is WalkingPhase.FALLEN:
            self._time += left
        else:
            self._move_joints(dt)
        self._output = self._make_output()
        self._log.append(self._sample())
        return self._output

    # What it tells.

    @property
    def output(self) -> WalkerOutput:
        """The newest command."""
        return self._output

    @property
    def time(self) -> float:
        """Robot time [s]."""
        return self._time

    def status(self) -> WalkingStatus:
        """What the walker is doing."""
        standing = not np.isfinite(self._duration)
        imminent = self._stance
        if self._step is not None:
            imminent = imminent.with_sole(self._step.side, self._step.T_world_sole)
        return WalkingStatus(
            phase=self._phase,
            phase_elapsed=0.0 if standing else self._elapsed,
            phase_duration=0.0 if standing else self._duration,
            current_step=self._step,
            queue=self._queue,
            imminent_stance=imminent,
            last_side=self._last_side,
            paused=self._paused,
            failure=self._failure,
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

    # Phases.

    def _end_phase(self) -> None:
        if self._phase is WalkingPhase.SWING:
            self._land()
        elif self._step is None:
            self._stand()
        elif self._unbalanced():
            self._held += self._parameters.hold_extension
            self._duration += self._parameters.hold_extension
            self._replan()
        else:
            self._lift_off()

    def _unbalanced(self) -> bool:
        """Whether the DCM is too far off its plan to lift a foot, and waiting can still bring it back."""
        error = float(np.linalg.norm(self._dcm - self._plan.reference(self._elapsed - self._planned_at)[0]))
        may_wait = self._held < self._parameters.hold_limit and self._support().distance(self._dcm) < 0.0
        return error > self._parameters.hold_error and may_wait

    def _start_transfer(self, shortest: float = 0.0) -> None:
        self._step, self._queue = self._queue[0], self._queue[1:]
        self._enter(WalkingPhase.TRANSFER, max(self._step.transfer_duration, shortest))
        self._replan()

    def _lift_off(self) -> None:
        assert self._step is not None
        lift_off = self._phase_now(self._heel).sole(self._step.side, self._elapsed)
        self._swing = SwingTrajectory(lift_off, self._step, self._parameters)
        self._newest_id = self._step.sequence_id
        self._enter(WalkingPhase.SWING, self._step.swing_duration)
        self._events.append(StepEvent(StepEventKind.STARTED, self._time, self._step, lift_off))
        self._replan()

    def _land(self) -> None:
        assert self._step is not None
        step = self._step
        self._stance = self._stance.with_sole(step.side, step.T_world_sole)
        self._footholds[step.side] = step.foothold_sole if len(step.foothold_sole) >= 3 else self._model.foothold_sole
        self._last_side, self._step, self._swing = step.side, None, None
        self._events.append(StepEvent(StepEventKind.COMPLETED, self._time, step, step.T_world_sole))
        if self._queue:
            self._start_transfer()
        else:
            self._enter(WalkingPhase.TRANSFER, self._parameters.final_transfer)
            self._replan()

    def _stand(self) -> None:
        self._enter(WalkingPhase.STANDING, np.inf)
        self._replan()

    def _enter(self, phase: WalkingPhase, duration: float) -> None:
        self._phase, self._elapsed, self._duration, self._held = phase, 0.0, duration, 0.0
        self._yaw_from, self._heel = self._yaw, None

    # Plans.

    def _replan(self) -> None:
        """Plan support, DCM and CoM height from the present to where the queue ends."""
        self._set_support()
        heels: list[HeelLift | None] = [self._heel]
        if self._phase is WalkingPhase.TRANSFER and self._step is not None and self._heel is None:
            heels = list(self._heel_lifts(self._step))
        phases = self._preview(heels[0])
        self._plan_dcm(phases)
        if len(heels) > 1:
            for heel in heels:
                phases = self._preview(heel)
                if self._reaches(phases):
                    break
        self._heel = phases[0].heel
        self._set_support()
        self._height = plan_height(phases, self._plan, self._com_state(), self._model, self._parameters)

    def _heel_lifts(self, step: Footstep) -> Sequence[HeelLift]:
        """Toe-offs of the present transfer to choose from, flat first."""
        p = self._parameters
        start = max(self._elapsed, p.heel_lift_start * self._duration)
        duration = self._duration - start
        if duration < p.shortest_replan:
            return [self._heel_lift(step, 0.0, start, 1.0)]
        pitches = np.linspace(0.0, p.heel_lift, p.heel_lift_stages + 1)
        return [self._heel_lift(step, float(pitch), start, duration) for pitch in pitches]

    def _heel_lift(self, step: Footstep, pitch: float, start: float, duration: float) -> HeelLift:
        toe = float(self._footholds[step.side][:, 0].max())
        return HeelLift(self._stance.sole(step.side), toe, pitch, start, duration)

    def _reaches(self, phases: Sequence[PlannedPhase]) -> bool:
        """Whether the legs reach at the commanded CoM height until the next landing."""
        horizon = phases[0].remaining + phases[1].remaining
        times = np.arange(0.0, horizon, 0.5 * self._parameters.height_knot)
        cap = reach_cap(phases, self._plan, self._com_state(), self._model, self._parameters, times)
        nominal = nominal_height(phases, self._height_motion[0], self._parameters, times)
        return bool(np.all(cap >= nominal))

    def _plan_dcm(self, phases: Sequence[PlannedPhase]) -> None:
        self._planned_at = self._elapsed
        self._plan: DcmPlan = plan_from_present(
            self._omega,
            self._dcm,
            self._support().nearest(self._cop),
            [max(phase.remaining, 1e-6) for phase in phases],
            [phase.cop_end for phase in phases],
            self._support().nearest,
            self._parameters.shortest_replan,
        )

    def _preview(self, heel: HeelLift | None) -> list[PlannedPhase]:
        """The rest of the present phase and all that follow."""
        now = self._phase_now(heel)
        toe, p = 0.5 * self._model.sole_length, self._parameters
        if self._step is None:
            return [now]
        if self._phase is WalkingPhase.SWING:
            landed = self._stance.with_sole(self._step.side, self._step.T_world_sole)
            return [now, *phases_of_steps(landed, None, self._queue, self._step.side, toe, p)]
        lift_off = now.sole(self._step.side, self._duration)
        steps = (self._step, *self._queue)
        return [now, *phases_of_steps(self._stance, lift_off, steps, None, toe, p)]

    def _phase_now(self, heel: HeelLift | None) -> PlannedPhase:
        p, stance = self._parameters, self._stance
        if self._step is not None and self._phase is WalkingPhase.TRANSFER:
            return transfer_phase(stance, self._step, self._elapsed, self._duration - self._elapsed, heel, p)
        if self._step is not None and self._swing is not None:
            return swing_phase(stance, self._step, self._swing, self._elapsed, p)
        remaining = self._duration - self._elapsed
        return resting_phase(stance, self._last_side, min(remaining, _STANDING_PREVIEW), p)

    def _com_state(self) -> ComState:
        return ComState(
            com=np.append(self._com, self._height_motion[0]),
            velocity=self._height_motion[1],
            acceleration=self._height_motion[2],
            p_com_pelvis=self._p_com_pelvis,
            yaw=self._yaw,
        )

    def _set_support(self) -> None:
        """Find where the CoP may be: flat feet, and with the trailing foot on its toe once its heel lifts."""
        corners = {
            side: foothold_corners(self._stance.sole(side), self._footholds[side], self._parameters.cop_margin)
            for side in Side
        }
        if self._phase is WalkingPhase.SWING and self._step is not None:
            del corners[self._step.side]
        self._support_flat = self._support_on_toe = SupportPolygon(list(corners.values()))
        if self._heel is not None and self._step is not None:
            toe = self._footholds[self._step.side]
            toe = toe[toe[:, 0] > toe[:, 0].max() - 1e-6]
            corners[self._step.side] = toe @ self._heel.T_world_sole.R[:2, :2].T + self._heel.T_world_sole.p[:2]
            self._support_on_toe = SupportPolygon(list(corners.values()))

    def _support(self) -> SupportPolygon:
        lifted = self._heel is not None and self._heel.lifted(self._elapsed)
        return self._support_on_toe if lifted else self._support_flat

    # Motion.

    def _balance(self, duration: float) -> None:
        """Move DCM, CoM and CoM height on; the CoP follows the plan and the DCM error, within the support."""
        since_plan = self._elapsed - self._planned_at
        dcm_reference, _ = self._plan.reference(since_plan)
        _, cop_reference = self._plan.reference(since_plan + 0.5 * duration)
        gain = 1.0 + self._parameters.dcm_gain / self._omega
        self._cop = self._support().nearest(cop_reference + gain * (self._dcm - dcm_reference))
        self._com, self._dcm = advance_exactly(self._omega, self._com, self._dcm, self._cop, duration)
        height, velocity, acceleration = self._height.motion(since_plan + duration)
        self._height_motion = (float(height[0]), float(velocity[0]), float(acceleration[0]))
        self._check_balance(since_plan + duration)

    def _check_balance(self, since_plan: float) -> None:
        outside = self._support().distance(self._dcm)
        error = float(np.linalg.norm(self._dcm - self._plan.reference(since_plan)[0]))
        if outside > self._parameters.fall_distance and error > self._parameters.fall_distance:
            self.fall(f"the DCM is {100 * outside:.0f} cm outside the feet and {100 * error:.0f} cm off its plan")

    def _move_joints(self, dt: float) -> None:
        """Solve for the configuration that has the CoM and the soles where they should be now."""
        p = self._parameters
        self._yaw = self._yaw_now()
        com = np.append(self._com, self._height_motion[0])
        guess = np.asarray(pin.integrate(self._model.pin_model, self._q, self._v * dt))
        solution = self._ik.solve(
            guess, com, self._pelvis_rotation(), self._soles_now(), p.ik_iterations, p.ik_tolerance
        )
        failure = _out_of_reach(solution, p)
        if failure:
            self.fall(failure)
            return
        v = np.asarray(pin.difference(self._model.pin_model, self._q, solution.q)) / dt
        self._height_error = solution.height_error
        self._remember(solution.q, v)

    def _remember(self, q: Array, v: Array) -> None:
        self._q, self._v = q, v
        com = np.append(self._com, self._height_motion[0])
        self._p_com_pelvis = rotation_z(-self._yaw) @ (q[:3] - com)

    def _yaw_now(self) -> float:
        if self._phase is not WalkingPhase.SWING or self._step is None:
            return self._yaw_from
        landed = self._stance.with_sole(self._step.side, self._step.T_world_sole)
        share = float(minimum_jerk(np.float64(self._elapsed / self._duration)))
        return yaw_towards(self._yaw_from, landed.yaw, share)

    def _pelvis_rotation(self) -> Array:
        return rotation_z(self._yaw) @ rotation_y(self._parameters.pelvis_pitch)

    def _soles_now(self) -> Stance:
        if self._step is None:
            return self._stance
        sole: Pose = self._phase_now(self._heel).sole(self._step.side, self._elapsed)
        return self._stance.with_sole(self._step.side, sole)

    def _standing_configuration(self, stance: Stance) -> tuple[Array, float]:
        """A configuration on a stance, and its CoM height."""
        p, model = self._parameters, self._model
        phase = resting_phase(stance, None, _STANDING_PREVIEW, p)
        q = _posture(model, p)
        com_in_posture = model.com(q)
        height = phase.ground_end + p.com_height
        q[:3] = np.append(stance.mid_feet[:2], height) - com_in_posture
        q[3:7] = Pose(self._pelvis_rotation(), np.zeros(3)).quaternion_xyzw
        self._height_error = 0.0
        self._height_motion = (height, 0.0, 0.0)
        self._remember(q, np.zeros(model.pin_model.nv))
        com = np.append(stance.mid_feet[:2], height)
        solution = self._ik.solve(q, com, self._pelvis_rotation(), stance, _FIRST_ITERATIONS, p.ik_tolerance)
        failure = _out_of_reach(solution, p)
        if failure:
            raise ValueError(
                f"the robot cannot stand on the soles at {stance.T_world_left.p}, {stance.T_world_right.p}: {failure}"
            )
        return solution.q, height + solution.height_error

    # Output.

    def _make_output(self) -> WalkerOutput:
        height, velocity = self._height_motion[0] + self._height_error, self._height_motion[1]
        ground = self._stance.mid_feet[2]
        reference, _ = self._plan.reference(self._elapsed - self._planned_at)
        dcm_height = height + velocity / self._omega
        return WalkerOutput(
            time=self._time,
            phase=self._phase,
            q=self._q,
            v=self._v,
            stance=self._soles_now(),
            com_world=np.append(self._com, height),
            dcm_world=np.append(self._dcm, dcm_height),
            dcm_reference_world=np.append(reference, dcm_height),
            cop_world=np.append(self._cop, ground),
        )

    def _sample(self) -> ControlSample:
        output = self._output
        return ControlSample(
            time=output.time,
            phase=output.phase,
            com_world=output.com_world,
            dcm_world=output.dcm_world,
            dcm_reference_world=output.dcm_reference_world,
            cop_world=output.cop_world,
            dcm_error=float(np.linalg.norm(output.dcm_world[:2] - output.dcm_reference_world[:2])),
        )


def _posture(model: RobotModel, parameters: WalkingParameters) -> Array:
    """Bent knees, arms at the sides, (7 + n,) with the pelvis at the origin."""
    q = model.neutral_configuration()
    for side in Side:
        for name, angle, mirrored in (
            ("shoulder_yaw", parameters.shoulder_yaw, True),
            ("shoulder_roll", parameters.shoulder_roll, True),
            ("elbow_pitch", parameters.elbow_pitch, False),
            ("elbow_roll", parameters.elbow_roll, True),
        ):
            joint = f"{side.value}_{name}"
            if joint in model.joint_names:
                q[7 + model.joint_names.index(joint)] = angle * (side.sign if mirrored else 1.0)
        for place, angle in zip(model.legs[side].joints[2:5], (-0.5, 1.0, -0.5), strict=True):
            q[7 + place] = angle
    return np.concatenate((q[:7], np.clip(q[7:], model.lower_limits, model.upper_limits)))


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
