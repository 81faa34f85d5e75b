"""What the feet do: the phases of support, the queue of steps, which foot is where, and what will come.

STANDING -> TRANSFER -> SWING -> TRANSFER ... -> STANDING. A gait knows nothing of balance: its owner tells it when time
passes, when a phase ends and whether it must be prolonged.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from skills.footsteps.footstep import Footstep, Side, Stance
from skills.geometry.pose import Array
from skills.walking.heel_lift import HeelLift
from skills.walking.preview import PlannedPhase, phases_of_steps, resting_phase, swing_phase, transfer_phase
from skills.walking.step_queue import accepted_steps
from skills.walking.support_polygon import SupportPolygon, foothold_corners
from skills.walking.swing_trajectory import SwingTrajectory
from skills.walking.uniform_spline import minimum_jerk_at
from skills.walking.walking_parameters import WalkingParameters
from skills.walking.walking_state import StepEvent, StepEventKind, WalkingPhase

_STANDING_PREVIEW = 1.0


class Gait:
    """The feet of a walking robot.

    Args:
        stance: both soles at the start, where the robot stands.
        foothold_sole: outline of a sole, (N, 2) [m].
        parameters: settings of walking.
    """

    def __init__(self, stance: Stance, foothold_sole: Array, parameters: WalkingParameters) -> None:
        self._parameters = parameters
        self._sole = foothold_sole
        self._footholds = dict.fromkeys(Side, foothold_sole)
        self.stance = stance
        self.phase = WalkingPhase.STANDING
        self.elapsed, self.duration, self.held = 0.0, np.inf, 0.0
        self.step: Footstep | None = None
        self.queue: tuple[Footstep, ...] = ()
        self.last_side: Side | None = None
        self._newest_id: int | None = None
        self._swing: SwingTrajectory | None = None
        self._heel: HeelLift | None = None
        self._update_support()

    @property
    def last_sequence_id(self) -> int:
        """Sequence id of the step under way or last made; -1 before the first."""
        if self.step is not None:
            return self.step.sequence_id
        return -1 if self._newest_id is None else self._newest_id

    def accept(self, steps: Sequence[Footstep]) -> None:
        """Replace the queue, and the step to come where its foot has not lifted and the plan begins with that foot.

        Raises:
            ValueError: where the steps cannot follow; nothing changes.
        """
        if self.step is None:
            self.queue = accepted_steps(steps, self._newest_id, None)
            if self.queue:
                self._start_transfer(self._parameters.first_transfer)
            return
        if self.phase is WalkingPhase.TRANSFER:
            kept = accepted_steps(steps, self._newest_id, None)
            if kept and kept[0].side is self.step.side and kept[0].sequence_id >= self.step.sequence_id:
                self.step, self.queue = kept[0], kept[1:]
                return
        self.queue = accepted_steps(steps, self.step.sequence_id, self.step.side)

    def end_phase(self, time: float) -> StepEvent | None:
        """Go on to the next phase; what happened to a step by that.

        Args:
            time: robot time [s].
        """
        if self.phase is WalkingPhase.SWING:
            return self._land(time)
        if self.step is not None:
            return self._lift_off(time, self.step)
        self._enter(WalkingPhase.STANDING, np.inf)
        return None

    def prolong(self, duration: float) -> None:
        """Hold the present double support for longer [s]."""
        self.duration += duration
        self.held += duration

    def soles(self) -> Stance:
        """Both soles as they are now, also in the air."""
        if self.step is None:
            return self.stance
        if self._swing is not None:
            return self.stance.with_sole(self.step.side, self._swing.pose(self.elapsed))
        if self._heel is not None and self._heel.lifted(self.elapsed):
            return self.stance.with_sole(self.step.side, self._heel.pose(self.elapsed))
        return self.stance

    def freedom_in_air(self) -> float:
        """How far the swinging sole may give up its orientation: 0 at lift-off and landing, 1 in between."""
        if self._swing is None:
            return 0.0
        share = self.elapsed / self.duration
        return minimum_jerk_at(min(share, 1.0 - share) / self._parameters.swing_strict)

    def support(self) -> SupportPolygon:
        """Where the CoP may be: flat feet, and the toe of a trailing foot whose heel has lifted."""
        lifted = self._heel is not None and self._heel.lifted(self.elapsed)
        return self._support_on_toe if lifted else self._support_flat

    def heel_lifts(self) -> tuple[HeelLift | None, ...]:
        """Toe-offs of the present transfer to choose from, flat first; only the present one once it is under way."""
        p = self._parameters
        step = self.step
        if self.phase is not WalkingPhase.TRANSFER or step is None:
            return (None,)
        start = max(self.elapsed, p.heel_lift_start * self.duration)
        duration = self.duration - start
        if duration < p.shortest_replan or (self._heel is not None and self._heel.lifted(self.elapsed)):
            return (self._heel,)
        flat, toe = self.stance.sole(step.side), float(self._footholds[step.side][:, 0].max())
        pitches = np.linspace(0.0, p.heel_lift, p.heel_lift_stages + 1)
        return tuple(HeelLift(flat, toe, float(pitch), start, duration) for pitch in pitches)

    def choose_heel_lift(self, heel: HeelLift | None) -> None:
        """Let the trailing foot make one of `heel_lifts` in this transfer."""
        self._heel = heel
        self._update_support()

    def preview(self, heel: HeelLift | None, horizon: float) -> list[PlannedPhase]:
        """The rest of the present phase with a toe-off, and the phases behind it until the robot rests.

        Args:
            heel: one of `heel_lifts`.
            horizon: phases that start later have no swing trajectory [s].
        """
        p, stance = self._parameters, self.stance
        toe = float(self._sole[:, 0].max())
        remaining = self.duration - self.elapsed
        if self.step is None:
            return [resting_phase(stance, self.last_side, min(remaining, _STANDING_PREVIEW), p)]
        if self._swing is not None:
            now = swing_phase(stance, self.step, self._swing, self.elapsed, p)
            landed = stance.with_sole(self.step.side, self.step.T_world_sole)
            return [now, *phases_of_steps(landed, None, self.queue, self.step.side, toe, horizon - remaining, p)]
        now = transfer_phase(stance, self.step, self.elapsed, remaining, heel, p)
        lift_off = now.sole(self.step.side, self.duration)
        steps = (self.step, *self.queue)
        return [now, *phases_of_steps(stance, lift_off, steps, None, toe, horizon - remaining, p)]

    def _start_transfer(self, shortest: float = 0.0) -> None:
        self.step, self.queue = self.queue[0], self.queue[1:]
        self._enter(WalkingPhase.TRANSFER, max(self.step.transfer_duration, shortest))

    def _lift_off(self, time: float, step: Footstep) -> StepEvent:
        lift_off = self.soles().sole(step.side)
        self._newest_id = step.sequence_id
        self._swing = SwingTrajectory(lift_off, step, self._parameters)
        self._enter(WalkingPhase.SWING, step.swing_duration)
        return StepEvent(StepEventKind.STARTED, time, step, lift_off)

    def _land(self, time: float) -> StepEvent:
        step = self.step
        assert step is not None
        self.stance = self.stance.with_sole(step.side, step.T_world_sole)
        self._footholds[step.side] = step.foothold_sole if len(step.foothold_sole) >= 3 else self._sole
        self.last_side, self.step, self._swing = step.side, None, None
        if self.queue:
            self._start_transfer()
        else:
            self._enter(WalkingPhase.TRANSFER, self._parameters.final_transfer)
        return StepEvent(StepEventKind.COMPLETED, time, step, step.T_world_sole)

    def _enter(self, phase: WalkingPhase, duration: float) -> None:
        self.phase, self.elapsed, self.duration, self.held = phase, 0.0, duration, 0.0
        self._heel = None
        self._update_support()

    def _update_support(self) -> None:
        margin = self._parameters.cop_margin
        corners = {side: foothold_corners(self.stance.sole(side), self._footholds[side], margin) for side in Side}
        if self.phase is WalkingPhase.SWING and self.step is not None:
            del corners[self.step.side]
        self._support_flat = self._support_on_toe = SupportPolygon(list(corners.values()))
        if self._heel is not None and self._heel.pitch > 0.0 and self.step is not None:
            foothold = self._footholds[self.step.side]
            toe = foothold[foothold[:, 0] > foothold[:, 0].max() - 1e-6]
            corners[self.step.side] = foothold_corners(self._heel.T_world_sole, toe, margin)
            self._support_on_toe = SupportPolygon(list(corners.values()))
