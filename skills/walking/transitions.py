"""When the phases of walking change: what makes a foot land, lift off, or stand on its toe."""

from __future__ import annotations

import numpy as np

from skills.walking.balance import Balance
from skills.walking.body_dynamics import BodyDynamics
from skills.walking.contact_times import ContactTimes
from skills.walking.gait import Gait
from skills.walking.step_adjustment import StepAdjustmentParameters
from skills.walking.walking_parameters import WalkingParameters


class Transitions:
    """The transitions of one walking robot, asked once a control tick.

    Args:
        gait: what the feet do.
        balance: where the DCM is and shall be.
        body: the robot as it is.
        contact_times: how long soles have been pressed.
        parameters: settings of walking.
        adjustment_parameters: settings of steps that save the balance.
    """

    def __init__(
        self,
        gait: Gait,
        balance: Balance,
        body: BodyDynamics,
        contact_times: ContactTimes,
        parameters: WalkingParameters,
        adjustment_parameters: StepAdjustmentParameters,
    ) -> None:
        self._gait, self._balance, self._body, self._contact_times = gait, balance, body, contact_times
        self._parameters, self._adjustment_parameters = parameters, adjustment_parameters

    def has_landed(self) -> bool:
        """Whether the foot in the air is on the ground: pressed late enough, and near enough to its foothold."""
        p, swing = self._parameters, self._gait.swing
        if swing is None:
            return False
        side = swing.step.side
        if swing.share > p.latest_landing:
            return True
        if not self._contact_times.pressed_for(side, p.touchdown_time):
            return False
        if swing.share >= 1.0:
            return True
        if swing.share < p.touchdown_share:
            return False
        off = self._body.sole(side).p - swing.T_world_target.p
        return bool(np.hypot(off[0], off[1]) < p.touchdown_distance and off[2] < p.touchdown_depth)

    def landed_on_nothing(self) -> bool:
        """Whether the foot that landed last has not been pressed since: what it felt was no ground."""
        p, gait, side = self._parameters, self._gait, self._gait.last_side
        if side is None or not gait.may_take_back or not p.phantom_time <= gait.elapsed < 2.0 * p.phantom_time:
            return False
        return self._contact_times.free_for(side, p.phantom_time)

    def must_lift_off(self) -> bool:
        """Whether a double support is over, or the DCM has left both feet, so that only a step can save the balance."""
        gait = self._gait
        if gait.elapsed >= gait.duration:
            return True
        if gait.step is None or gait.elapsed < self._adjustment_parameters.shortest_transfer:
            return False
        return gait.support().distance(self._balance.dcm) > 0.0

    def must_toe_off(self) -> bool:
        """Whether the trailing leg is nearly straight, and its toe enough for where the CoP is."""
        gait = self._gait
        if gait.on_toe or gait.step is None:
            return False
        knee = self._body.q[7 + self._body.model.legs[gait.step.side].knee]
        if knee >= self._parameters.toe_off_knee:
            return False
        return gait.toe_support().distance(self._balance.cop) <= 0.0
