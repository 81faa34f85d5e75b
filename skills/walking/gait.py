"""What the feet do: the phases of support, the queue of steps, which foot is where, and what will come.

STANDING -> TRANSFER -> SWING -> TRANSFER ... -> STANDING. A gait knows nothing of balance or of forces: its owner tells
it when time passes, when a foot lifts off or has landed, and whether double support must be prolonged.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from skills.footsteps.footstep import Footstep, Side, Stance
from skills.geometry.pose import Array, Mask, Pose
from skills.walking.contact import contact_points
from skills.walking.preview import PlannedPhase, phases_of_steps, resting_phase, swing_phase, transfer_phase
from skills.walking.step_queue import accepted_steps
from skills.walking.support_polygon import SupportPolygon, foothold_corners
from skills.walking.swing import Swing
from skills.walking.swing_parameters import SwingParameters
from skills.walking.walking_parameters import WalkingParameters
from skills.walking.walking_state import WalkingPhase

_STANDING_PREVIEW = 1.0


class Gait:
    """The feet of a walking robot.

    Args:
        stance: both soles at the start, where the robot stands.
        foothold_sole: outline of a sole, (N, 2) [m].
        parameters: settings of walking.
        swing_parameters: settings of swings.

    Attributes:
        stance: soles on the ground, each where it landed; a swinging foot's is where it lifted off.
        phase: what the legs are doing.
        elapsed, duration: time in the phase, and its nominal duration [s].
        held: how much of the phase is a hold for balance [s].
        step: the step whose transfer or swing is under way.
        swing: the foot in the air.
        queue: the steps after it.
        last_side: the foot that landed last.
        on_toe: whether the trailing foot's heel has lifted.
    """

    def __init__(
        self, stance: Stance, foothold_sole: Array, parameters: WalkingParameters, swing_parameters: SwingParameters
    ) -> None:
        self._parameters, self._swing_parameters = parameters, swing_parameters
        self._sole = foothold_sole
        self._points = dict.fromkeys(Side, contact_points(foothold_sole))
        self.stance = stance
        self.phase = WalkingPhase.STANDING
        self.elapsed, self.duration, self.held = 0.0, np.inf, 0.0
        self.step: Footstep | None = None
        self.swing: Swing | None = None
        self.queue: tuple[Footstep, ...] = ()
        self.last_side: Side | None = None
        self.on_toe = False
        self._newest_id: int | None = None
        self._landed: Swing | None = None
        self._update_support()

    @property
    def last_sequence_id(self) -> int:
        """Sequence id of the step under way or last made; -1 before the first."""
        if self.step is not None:
            return self.step.sequence_id
        return -1 if self._newest_id is None else self._newest_id

    @property
    def may_take_back(self) -> bool:
        """Whether the last landing could still turn out to have been none."""
        return self._landed is not None

    @property
    def landed_before(self) -> bool:
        """Whether the foot in the air has landed already, on nothing."""
        return self.swing is not None and self.swing.taken_back

    @property
    def remaining(self) -> float:
        """Nominal time to the end of the phase [s]."""
        return self.swing.remaining if self.swing is not None else max(0.0, self.duration - self.elapsed)

    def stands_on_toe(self, side: Side) -> bool:
        """Whether a foot is on the ground with its toe alone."""
        return self.on_toe and self.step is not None and self.step.side is side

    def points(self, side: Side) -> Array:
        """Contact points of one foot's foothold, (4, 2) in the sole's plane [m]."""
        return self._points[side]

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

    def advance(self, dt: float) -> None:
        """Let time pass [s]."""
        self.elapsed += dt
        if self.swing is not None:
            self.swing.advance(dt)

    def hold(self, dt: float) -> None:
        """Prolong the present double support for the sake of balance [s]."""
        self.duration += dt
        self.held += dt

    def lift_heel(self) -> None:
        """Let the trailing foot stand on its toe for the rest of the transfer."""
        self.on_toe = True
        self._update_support()

    def lift_off(self, T_world_sole: Pose) -> Footstep:
        """Begin the swing of the present step from where its sole is."""
        step = self.step
        assert step is not None, "only a step lifts a foot"
        self._newest_id = step.sequence_id
        self.stance = self.stance.with_sole(step.side, T_world_sole)
        self.swing, self._landed = Swing(T_world_sole, step, self._swing_parameters), None
        self._enter(WalkingPhase.SWING, step.swing_duration)
        return step

    def land(self, T_world_sole: Pose) -> Footstep:
        """End the swing of the present step where its sole is."""
        step = self.step
        assert step is not None, "only a step lands a foot"
        self.stance = self.stance.with_sole(step.side, T_world_sole)
        foothold = step.foothold_sole if len(step.foothold_sole) >= 3 else self._sole
        self._points[step.side] = contact_points(foothold)
        self._landed = self.swing
        self.last_side, self.step, self.swing = step.side, None, None
        if self.queue:
            self._start_transfer()
        else:
            self._enter(WalkingPhase.TRANSFER, self._parameters.final_transfer)
        return step

    def take_back_landing(self) -> None:
        """Go on with the swing that ended last: its foot sinks until the ground comes."""
        swing = self._landed
        assert swing is not None, "no foot has landed"
        if self.step is not None:
            self.queue = (self.step, *self.queue)
        self.step, self.swing, self._landed = swing.step, swing, None
        swing.share, swing.taken_back = max(swing.share, 1.0), True
        self._enter(WalkingPhase.SWING, swing.step.swing_duration)
        self.elapsed = self.duration

    def stand(self) -> None:
        """End the last transfer."""
        self._enter(WalkingPhase.STANDING, np.inf)

    def rest_on(self, stance: Stance) -> None:
        """Take the soles to be where they are now, as far as they are on the ground."""
        swinging = self.step.side if self.swing is not None and self.step is not None else None
        for side in Side:
            if side is not swinging:
                self.stance = self.stance.with_sole(side, stance.sole(side))
        self._update_support()

    def support(self) -> SupportPolygon:
        """Where the CoP may be: flat feet, and the toe of a trailing foot whose heel has lifted."""
        return self._support

    def toe_support(self) -> SupportPolygon:
        """The support if the trailing foot stood on its toe."""
        return SupportPolygon(self._corners(on_toe=True))

    def catching_support(self) -> SupportPolygon:
        """What can catch a fall: the support, and the foothold of the step under way."""
        if self.step is None:
            return self._support
        landing = foothold_corners(self.landed_stance().sole(self.step.side), self._sole, 0.0)
        return SupportPolygon([self._support.hull_world, landing])

    def landed_stance(self) -> Stance:
        """The stance once the present step has landed."""
        if self.step is None:
            return self.stance
        target = self.step.T_world_sole if self.swing is None else self.swing.T_world_target
        return self.stance.with_sole(self.step.side, target)

    def preview(self, horizon: float) -> list[PlannedPhase]:
        """The rest of the present phase, and the phases behind it until the robot rests.

        Args:
            horizon: phases that start later have no swing trajectory [s].
        """
        p, stance = self._parameters, self.stance
        toe = float(self._sole[:, 0].max())
        remaining = self.remaining
        if self.step is None:
            return [resting_phase(stance, self.last_side, min(remaining, _STANDING_PREVIEW), p)]
        if self.swing is not None:
            now = swing_phase(stance, self.step, self.swing.trajectory, self.elapsed, remaining, p)
            rest = phases_of_steps(
                self.landed_stance(), self.queue, self.step.side, toe, horizon - remaining, p, self._swing_parameters
            )
            return [now, *rest]
        steps = (self.step, *self.queue)
        rest = phases_of_steps(stance, steps, None, toe, horizon - remaining, p, self._swing_parameters)
        now = transfer_phase(stance, self.step, self.elapsed, remaining, self.duration, toe, p)
        return [now, *rest[1:]]

    def _start_transfer(self, shortest: float = 0.0) -> None:
        self.step, self.queue = self.queue[0], self.queue[1:]
        self._enter(WalkingPhase.TRANSFER, max(self.step.transfer_duration, shortest))

    def _enter(self, phase: WalkingPhase, duration: float) -> None:
        self.phase, self.elapsed, self.duration, self.held = phase, 0.0, duration, 0.0
        self.on_toe = False
        self._update_support()

    def _update_support(self) -> None:
        self._support = SupportPolygon(self._corners(self.on_toe))

    def _corners(self, on_toe: bool) -> list[Array]:
        """Corners of the footholds on the ground from above, each (N, 2) in the world [m]."""
        corners = []
        for side in Side:
            trailing = self.step is not None and side is self.step.side
            if trailing and self.swing is not None:
                continue
            points = self._points[side]
            if trailing and on_toe:
                points = points[toe_points(points)]
            corners.append(foothold_corners(self.stance.sole(side), points, self._parameters.cop_margin))
        return corners


def toe_points(points_sole: Array) -> Mask:
    """Which of four contact points (4, 2) are its two foremost, (4,) boolean."""
    chosen = np.zeros(len(points_sole), dtype=bool)
    chosen[np.argsort(-points_sole[:, 0], kind="stable")[:2]] = True
    return chosen
