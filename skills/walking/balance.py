"""Where the CoM shall accelerate, so that the divergent component of motion (DCM) follows its plan within the soles.

The plan is made anew from the present DCM whenever support or queue change. Between plans the error against it is fed
back into the centre of pressure (CoP), which is kept to the soles but for a little that leaning the body can make
(Englsberger et al., 2015; Koolen et al., 2016). The CoM height follows a plan of its own.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import hypot

import numpy as np

from skills.footsteps.footstep import Side
from skills.geometry.pose import Array
from skills.walking.body_dynamics import BodyDynamics
from skills.walking.com_height import ComState, body_offset, plan_height
from skills.walking.dcm_plan import DcmPlan, plan_from_present
from skills.walking.gait import Gait
from skills.walking.preview import PlannedPhase
from skills.walking.robot_model import RobotModel
from skills.walking.walking_parameters import WalkingParameters
from skills.walking.whole_body_parameters import WholeBodyParameters

_LEAST_PHASE = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class BalanceCommand:
    """What balance asks of the CoM in one tick.

    Attributes:
        com_acceleration: in the world, (3,) [m/s^2].
        cmp: centroidal moment pivot that it needs, (2,) in the world [m].
        clipped: how far that had to be moved to stay near the soles [m].
    """

    com_acceleration: Array
    cmp: Array
    clipped: float


class Balance:
    """The balance of a walking robot.

    Args:
        gait: what the feet do.
        model: the robot.
        parameters: settings of walking.
        body_parameters: gains of the CoM height.

    Attributes:
        omega: sqrt(gravity / CoM height) [1/s].
        dcm, dcm_reference: as it is, and as planned, (2,) in the world [m].
        cop: as planned, (2,) in the world [m].
    """

    def __init__(
        self, gait: Gait, model: RobotModel, parameters: WalkingParameters, body_parameters: WholeBodyParameters
    ) -> None:
        self._gait, self._model, self._parameters, self._body_parameters = gait, model, parameters, body_parameters
        self.omega = float(np.sqrt(parameters.gravity / parameters.com_height))
        self.dcm = self.dcm_reference = self.cop = gait.stance.mid_feet[:2]
        self._height: tuple[float, float, float] | None = None
        self._since_plan = self._height_clock = 0.0

    @property
    def dcm_error(self) -> float:
        """Distance of the DCM from its plan in the plane [m]."""
        return hypot(self.dcm[0] - self.dcm_reference[0], self.dcm[1] - self.dcm_reference[1])

    @property
    def dcm_at_landing(self) -> Array:
        """DCM planned for the end of the present phase, (2,) [m]."""
        return self._plan.reference(self._phase_end)[0]

    def replan(self, body: BodyDynamics, yaw: float) -> None:
        """Plan DCM and CoM height from the present to where the queue ends; the pelvis heads to a yaw [rad]."""
        phases = self._gait.preview(self._parameters.height_horizon)
        self.dcm = self._dcm_of(body)
        self._plan_dcm(phases)
        if self._height is None:
            self._height = (float(body.com[2]), float(body.com_velocity[2]), 0.0)
        state = self._com_state(body, yaw)
        self._height_clock = 0.0
        self._height_plan = plan_height(phases, self._plan, state, self._model, self._parameters)

    def replan_dcm(self) -> None:
        """Plan the DCM anew, for another landing of the foot in the air; the CoM height stays as planned."""
        elapsed = self._since_plan
        self._plan_dcm(self._gait.preview(0.0))
        self._height_clock += elapsed

    def control(self, body: BodyDynamics, dt: float) -> BalanceCommand:
        """The CoM acceleration of this tick; the last one was dt ago [s]."""
        self._since_plan += dt
        self.dcm = self._dcm_of(body)
        # Behind the end of its phase a plan waits: the next support is not there yet.
        self.dcm_reference, self.cop = self._plan.reference(min(self._since_plan, self._phase_end))
        if self._gait.held > 0.0:
            # A reference that rests has its CoP beneath itself; with that of lift-off an error would stay.
            self.cop = self.dcm_reference
        upwards = self._height_acceleration(body)
        gain = 1.0 + self._parameters.dcm_gain / self.omega
        wanted = self.cop + gain * (self.dcm - self.dcm_reference)
        # The pendulum of the plan has a constant height; the true one has another stiffness.
        stiffness = (self._parameters.gravity + upwards) / max(body.com[2] - self._ground_at(wanted), 0.1)
        com = body.com[:2]
        wanted = com - self.omega**2 * (com - wanted) / stiffness
        nearest = self._gait.support().nearest(wanted)
        outside = hypot(wanted[0] - nearest[0], wanted[1] - nearest[1])
        excess = self._parameters.cmp_excess
        cmp = wanted if outside <= excess else nearest + (wanted - nearest) * (excess / outside)
        acceleration = np.append(stiffness * (com - cmp), upwards)
        return BalanceCommand(acceleration, cmp, max(0.0, outside - excess))

    def fall(self) -> str:
        """Why balance is lost, one sentence; empty while it is not."""
        limit, error = self._parameters.fall_distance, self.dcm_error
        if error <= limit:
            return ""
        outside = self._gait.catching_support().distance(self.dcm)
        if outside <= limit:
            return ""
        return f"balance is lost: the DCM is {100 * outside:.0f} cm outside the feet, {100 * error:.0f} cm off its plan"

    def must_hold(self) -> bool:
        """Whether the DCM is too far off its plan to lift a foot now, and double support can still bring it back."""
        p, gait = self._parameters, self._gait
        if self.dcm_error <= p.hold_error or gait.held >= p.hold_limit:
            return False
        return gait.support().distance(self.dcm) < 0.0

    def _dcm_of(self, body: BodyDynamics) -> Array:
        return body.com[:2] + body.com_velocity[:2] / self.omega

    def _plan_dcm(self, phases: Sequence[PlannedPhase]) -> None:
        support = self._gait.support()
        self._plan: DcmPlan = plan_from_present(
            self.omega,
            self.dcm,
            support.nearest(self.cop),
            [max(phase.remaining, _LEAST_PHASE) for phase in phases],
            [phase.cop_end for phase in phases],
            support.nearest,
            self._parameters.shortest_replan,
        )
        self._since_plan = 0.0
        self._phase_end = max(phases[0].remaining, _LEAST_PHASE) if len(phases) > 1 else np.inf
        self.dcm_reference, _ = self._plan.reference(0.0)

    def _height_acceleration(self, body: BodyDynamics) -> float:
        p, gravity = self._body_parameters, self._parameters.gravity
        self._height = height, velocity, acceleration = self._planned_height()
        wanted = (
            acceleration
            + p.height_stiffness * (height - body.com[2])
            + p.height_damping * (velocity - body.com_velocity[2])
        )
        return float(min(max(wanted, -p.lowest_descent * gravity), p.highest_ascent * gravity))

    def _planned_height(self) -> tuple[float, float, float]:
        value, velocity, acceleration = self._height_plan.motion(self._height_clock + self._since_plan)
        return float(value[0]), float(velocity[0]), float(acceleration[0])

    def _ground_at(self, cop: Array) -> float:
        """Height of the ground under a CoP between the feet [m]."""
        gait, stance = self._gait, self._gait.stance
        if gait.swing is not None:
            return float(stance.sole(gait.swing.step.side.opposite).p[2])
        left, right = stance.T_world_left.p, stance.T_world_right.p
        across = right[:2] - left[:2]
        share = min(max(float(across @ (cop - left[:2])) / float(across @ across), 0.0), 1.0)
        return float(left[2] + share * (right[2] - left[2]))

    def _com_state(self, body: BodyDynamics, yaw: float) -> ComState:
        assert self._height is not None
        model, height = self._model, self._height
        ankles = {side: body.sole(side) @ model.legs[side].p_sole_ankle for side in Side}
        return ComState(
            com=np.array((body.com[0], body.com[1], height[0])),
            velocity=height[1],
            acceleration=height[2],
            p_pelvis_body=body_offset(body.com, ankles, body.q[:3], yaw, model),
            yaw=yaw,
        )
