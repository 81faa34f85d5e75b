"""How the CoM moves: by the divergent component of motion (DCM) under a CoP that follows its plan within the soles.

The plan is made anew from the present motion whenever support or queue change, so nothing jumps; between plans the
DCM obeys its dynamics exactly, and an error against the plan is fed back into the CoP as far as the soles allow
(Englsberger et al., 2015).
"""

from __future__ import annotations

from collections.abc import Sequence
from math import hypot

import numpy as np

from skills.footsteps.footstep import Side
from skills.geometry.pose import Array
from skills.walking.com_height import ComState, body_offset, nominal_height, plan_height, reach_band
from skills.walking.dcm_plan import DcmPlan, advance_exactly, plan_from_present
from skills.walking.gait import Gait
from skills.walking.preview import PlannedPhase
from skills.walking.robot_model import RobotModel
from skills.walking.walking_parameters import WalkingParameters


class Balance:
    """The CoM of a walking robot, at rest above the middle of its feet at first.

    Args:
        gait: what the feet do.
        height: CoM height above the world's origin at the start [m].
        model: the robot.
        parameters: settings of walking.
    """

    def __init__(self, gait: Gait, height: float, model: RobotModel, parameters: WalkingParameters) -> None:
        self._gait, self._model, self._parameters = gait, model, parameters
        self.omega = float(np.sqrt(parameters.gravity / parameters.com_height))
        self.com = self.dcm = self.cop = gait.stance.mid_feet[:2]
        self.height, self.height_velocity, self._height_acceleration = height, 0.0, 0.0
        self.dcm_reference = self.dcm

    @property
    def com_world(self) -> Array:
        """CoM, (3,) [m]."""
        return np.array((self.com[0], self.com[1], self.height))

    @property
    def dcm_error(self) -> float:
        """Distance of the DCM from its plan in the plane [m]."""
        return hypot(self.dcm[0] - self.dcm_reference[0], self.dcm[1] - self.dcm_reference[1])

    def replan(self, p_world_pelvis: Array, yaw: float) -> None:
        """Plan DCM, toe-off and CoM height from the present to where the queue ends.

        Args:
            p_world_pelvis: pelvis now, (3,) [m].
            yaw: heading of the pelvis now [rad].
        """
        gait, p = self._gait, self._parameters
        heels = gait.heel_lifts()
        phases = gait.preview(heels[0], p.height_horizon)
        self._plan_dcm(phases)
        state = self._com_state(p_world_pelvis, yaw)
        for heel in heels[1:]:
            if self._reaches(phases, state):
                break
            phases = gait.preview(heel, p.height_horizon)
        gait.choose_heel_lift(phases[0].heel)
        self._height_plan = plan_height(phases, self._plan, state, self._model, p)

    def advance(self, duration: float) -> None:
        """Move DCM, CoM and CoM height on, within one phase [s]."""
        since_plan = self._gait.elapsed - self._planned_at
        _, cop = self._plan.reference(since_plan + 0.5 * duration)
        gain = 1.0 + self._parameters.dcm_gain / self.omega
        self.cop = self._gait.support().nearest(cop + gain * (self.dcm - self.dcm_reference))
        self.com, self.dcm = advance_exactly(self.omega, self.com, self.dcm, self.cop, duration)
        self.dcm_reference, _ = self._plan.reference(since_plan + duration)
        self.height, self.height_velocity, self._height_acceleration = (
            float(x[0]) for x in self._height_plan.motion(since_plan + duration)
        )

    def fall(self) -> str:
        """Why balance is lost, one sentence; empty while it is not."""
        limit, error = self._parameters.fall_distance, self.dcm_error
        if error <= limit:
            return ""
        outside = self._gait.support().distance(self.dcm)
        if outside <= limit:
            return ""
        return f"balance is lost: the DCM is {100 * outside:.0f} cm outside the feet, {100 * error:.0f} cm off its plan"

    def must_hold(self) -> bool:
        """Whether the DCM is too far off its plan to lift a foot now, and double support can still bring it back."""
        p, gait = self._parameters, self._gait
        if self.dcm_error <= p.hold_error or gait.held >= p.hold_limit:
            return False
        return gait.support().distance(self.dcm) < 0.0

    def _plan_dcm(self, phases: Sequence[PlannedPhase]) -> None:
        support = self._gait.support()
        self._planned_at = self._gait.elapsed
        self._plan: DcmPlan = plan_from_present(
            self.omega,
            self.dcm,
            support.nearest(self.cop),
            [max(phase.remaining, 1e-6) for phase in phases],
            [phase.cop_end for phase in phases],
            support.nearest,
            self._parameters.shortest_replan,
        )
        self.dcm_reference, _ = self._plan.reference(0.0)

    def _reaches(self, phases: Sequence[PlannedPhase], state: ComState) -> bool:
        """Whether the legs reach at the commanded CoM height until the next landing."""
        horizon = phases[0].remaining + phases[1].remaining
        times = np.arange(0.0, horizon, 0.5 * self._parameters.height_knot)
        _, cap = reach_band(phases, self._plan, state, self._model, self._parameters, times)
        return bool(np.all(cap >= nominal_height(phases, self.height, self._parameters, times)))

    def _com_state(self, p_world_pelvis: Array, yaw: float) -> ComState:
        soles, model = self._gait.soles(), self._model
        ankles = {side: soles.sole(side) @ model.legs[side].p_sole_ankle for side in Side}
        return ComState(
            com=self.com_world,
            velocity=self.height_velocity,
            acceleration=self._height_acceleration,
            p_pelvis_body=body_offset(self.com_world, ankles, p_world_pelvis, yaw, model),
            yaw=yaw,
        )
