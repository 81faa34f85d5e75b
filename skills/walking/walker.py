"""Walks over a queue of footsteps: from the measured state of the body to joint torques, once a control tick.

The gait says what the feet do, balance says how the CoM shall accelerate, a swing says how the foot in the air moves,
and the whole-body controller finds the torques that do all of it. A newer plan replaces the queued steps at any time.
The walker knows its body, not the world: what is measured comes in, torques and accelerations go out.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from skills.footsteps.footstep import Footstep, Side, Stance
from skills.geometry.pose import Array, wrap_angle
from skills.walking.balance import Balance, BalanceCommand
from skills.walking.body_dynamics import BodyDynamics
from skills.walking.contact import Contact
from skills.walking.contact_times import ContactTimes
from skills.walking.control_sample import ControlSample
from skills.walking.gait import Gait, toe_points
from skills.walking.motion_objectives import MotionObjectives
from skills.walking.posture import standing_configuration
from skills.walking.quadratic_program import MakeSolver, QpStatus
from skills.walking.robot_model import RobotModel
from skills.walking.step_adjustment import StepAdjustment, SwingState
from skills.walking.transitions import Transitions
from skills.walking.uniform_spline import minimum_jerk_at
from skills.walking.walker_parameters import WalkerParameters
from skills.walking.walking_state import (
    StepEvent,
    StepEventKind,
    WalkingPhase,
    WalkingStatus,
)
from skills.walking.whole_body_controller import BodyCommand, WholeBodyController

_ROUNDING = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class BodyMeasurement:
    """What the robot measures of itself in one control tick.

    Attributes:
        time: robot time [s].
        q, v: configuration (7 + n,) and velocity (6 + n,) in pinocchio's order, as estimated.
        loads: normal force under each sole [N].
        wrenches_sole: of the ground on each sole in its frame, force first, (6,) [N, N m]; empty where nothing
            measures them. They are logged and do not enter control.
    """

    time: float
    q: Array
    v: Array
    loads: Mapping[Side, float]
    wrenches_sole: Mapping[Side, Array] = field(default_factory=dict)


class Walker:
    """Walks a queue of footsteps.

    Args:
        model: the robot.
        stance: both soles at the start, where the robot stands.
        parameters: settings.
        make_solver: of the whole body's quadratic program; OSQP by default.

    Raises:
        ValueError: where the robot cannot stand like that.
    """

    def __init__(
        self, model: RobotModel, stance: Stance, parameters: WalkerParameters, make_solver: MakeSolver | None = None
    ) -> None:
        walking, whole_body = parameters.walking, parameters.whole_body
        self._model, self._parameters, self._body_parameters = model, walking, whole_body
        self.start_configuration = standing_configuration(model, stance, walking)
        self._body = BodyDynamics(model)
        self._contact_times = ContactTimes(walking.touchdown_load * model.mass * walking.gravity)
        self._whole_body = WholeBodyController(model, whole_body, make_solver)
        self._gait = Gait(stance, model.foothold_sole, walking, parameters.swing)
        self._objectives = MotionObjectives(self._gait, model, walking, whole_body)
        self._balance = Balance(self._gait, model, walking, whole_body)
        self._adjustment = StepAdjustment(self._balance.omega, parameters.step_adjustment)
        self._adjustment_parameters = parameters.step_adjustment
        self._transitions = Transitions(
            self._gait, self._balance, self._body, self._contact_times, walking, parameters.step_adjustment
        )
        self._contacts: dict[Side, Contact] = {}
        self._yaw = self._yaw_from = stance.yaw
        self._yaw_rate = 0.0
        self._paused, self._failure = False, ""
        self._events: list[StepEvent] = []
        self._log: list[ControlSample] = []
        self.qp_failures = 0
        self._time = 0.0
        self._body.update(self.start_configuration, np.zeros(model.pin_model.nv))
        self._replan()

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

    def control(self, measured: BodyMeasurement) -> BodyCommand:
        """The command of one control tick."""
        dt = measured.time - self._time
        self._time = measured.time
        if not (np.all(np.isfinite(measured.q)) and np.all(np.isfinite(measured.v))):
            self.fall("the measured state is not finite")
            return self._whole_body.brake(self._body)
        self._body.update(measured.q, measured.v)
        self._gait.advance(dt)
        self._contact_times.update(measured.loads, dt)
        self._change_phase(dt)
        self._turn(dt)
        balance = self._balance.control(self._body, dt)
        lost = self._balance.fall()
        if lost:
            self.fall(lost)
        heading = (self._yaw, self._yaw_rate)
        tasks = self._objectives.tasks(self._body, balance.com_acceleration, heading, self._contacts)
        command = self._whole_body.solve(self._body, tasks)
        self.qp_failures += command.status is QpStatus.FAILED
        self._log.append(self._sample(measured, balance, command))
        return command

    def status(self) -> WalkingStatus:
        """What the walker is doing."""
        gait = self._gait
        standing = gait.phase is WalkingPhase.STANDING
        return WalkingStatus(
            phase=self._phase,
            phase_elapsed=0.0 if standing else gait.elapsed,
            phase_duration=0.0 if standing else gait.duration,
            current_step=gait.step,
            queue=gait.queue,
            imminent_stance=gait.landed_stance(),
            last_side=gait.last_side if gait.step is None else gait.step.side,
            paused=self._paused,
            failure=self._failure,
            last_sequence_id=gait.last_sequence_id,
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
    def supports(self) -> tuple[Side, ...]:
        """The feet that stand on the ground."""
        swing = self._gait.swing
        return tuple(side for side in Side if swing is None or side is not swing.step.side)

    @property
    def omega(self) -> float:
        """Rate of the pendulum that balance plans with [1/s]."""
        return self._balance.omega

    @property
    def fallen(self) -> bool:
        """Whether walking has ended in a fall."""
        return bool(self._failure)

    @property
    def _phase(self) -> WalkingPhase:
        return WalkingPhase.FALLEN if self._failure else self._gait.phase

    def _change_phase(self, dt: float) -> None:
        gait = self._gait
        if gait.phase is WalkingPhase.SWING:
            self._adjust_landing(dt)
            if gait.swing is not None and self._transitions.has_landed():
                self._land(gait.swing.step.side)
        elif gait.phase is WalkingPhase.TRANSFER:
            if self._transitions.landed_on_nothing():
                gait.take_back_landing()
                self._replan()
            elif self._transitions.must_lift_off():
                self._end_transfer(dt)
            elif self._transitions.must_toe_off():
                gait.lift_heel()
                self._contacts = self._touch_ground()

    def _end_transfer(self, dt: float) -> None:
        gait = self._gait
        if gait.step is None:
            gait.stand()
        elif self._balance.must_hold():
            gait.hold(dt)
            return
        else:
            T_world_sole = self._body.sole(gait.step.side)
            self._yaw_from = self._yaw
            step = gait.lift_off(T_world_sole)
            self._events.append(StepEvent(StepEventKind.STARTED, self._time, step, T_world_sole))
        self._replan()

    def _adjust_landing(self, dt: float) -> None:
        """Let the foot in the air land where and when it saves the balance."""
        p, swing, gait = self._adjustment_parameters, self._gait.swing, self._gait
        if swing is None or swing.share > p.last_share:
            return
        landing = self._adjustment.landing(
            SwingState(
                step=swing.step,
                T_world_stance=gait.stance.sole(swing.step.side.opposite),
                support=gait.support(),
                dcm=self._balance.dcm,
                dcm_at_landing=self._dcm_at_landing,
                remaining=max(0.0, 1.0 - swing.share) * swing.step.swing_duration,
            )
        )
        wanted = landing.shift - swing.shift[:2]
        distance = float(np.hypot(wanted[0], wanted[1]))
        if distance == 0.0 and landing.pace == swing.pace:
            return
        share = min(1.0, p.shift_speed * dt / max(distance, _ROUNDING))
        swing.retarget(swing.shift[:2] + share * wanted, landing.pace, dt)
        self._balance.replan_dcm()

    def _land(self, side: Side) -> None:
        T_world_sole = self._body.sole(side)
        self._yaw_from = self._yaw
        again = self._gait.landed_before
        step = self._gait.land(T_world_sole)
        if not again:
            self._events.append(StepEvent(StepEventKind.COMPLETED, self._time, step, T_world_sole))
        self._replan()

    def _replan(self) -> None:
        gait = self._gait
        # A foot on its toe is pitched; where it will be counted from is where it lay flat.
        soles = {side: gait.stance.sole(side) if gait.stands_on_toe(side) else self._body.sole(side) for side in Side}
        gait.rest_on(Stance(soles[Side.LEFT], soles[Side.RIGHT]))
        self._contacts = self._touch_ground()
        self._balance.replan(self._body, self._yaw)
        self._dcm_at_landing = self._balance.dcm_at_landing - self._shift()

    def _touch_ground(self) -> dict[Side, Contact]:
        """Where the ground pushes the feet that stand on it."""
        gait, contacts = self._gait, {}
        for side in self.supports:
            points = gait.points(side)
            loaded = toe_points(points) if gait.stands_on_toe(side) else None
            contacts[side] = Contact.at(points, self._body_parameters.friction, loaded)
        return contacts

    def _shift(self) -> Array:
        """How far the foot in the air lands from its commanded foothold, (2,) in the world [m]."""
        swing = self._gait.swing
        return np.zeros(2) if swing is None else swing.shift[:2]

    def _turn(self, dt: float) -> None:
        """Turn the heading of the pelvis in the swing to the mean of the feet."""
        gait, before = self._gait, self._yaw
        if gait.swing is not None:
            share = minimum_jerk_at(gait.swing.share)
            self._yaw = wrap_angle(self._yaw_from + share * wrap_angle(gait.landed_stance().yaw - self._yaw_from))
        self._yaw_rate = wrap_angle(self._yaw - before) / dt if dt > 0.0 else 0.0

    def _sample(self, measured: BodyMeasurement, balance: BalanceCommand, command: BodyCommand) -> ControlSample:
        body, omega = self._body, self._balance.omega
        dcm = body.com + body.com_velocity / omega
        reference = self._balance.dcm_reference
        return ControlSample(
            time=self._time,
            phase=self._phase,
            com_world=body.com,
            dcm_world=dcm,
            dcm_reference_world=np.array((reference[0], reference[1], dcm[2])),
            cmp_world=np.array((*balance.cmp, self._gait.stance.mid_feet[2])),
            dcm_error=self._balance.dcm_error,
            angular_momentum_world=body.momentum[3:],
            stance=Stance(body.sole(Side.LEFT), body.sole(Side.RIGHT)),
            wrenches_sole=command.wrenches_sole,
            measured_wrenches_sole=measured.wrenches_sole,
            torque_shares=command.torques / self._model.effort_limits,
            support_world=self._gait.support().hull_world,
            qp_status=command.status,
            qp_iterations=command.iterations,
            qp_time=command.solver_time,
        )
