"""The error of the robot's state estimate: a frame that slides and turns away from the true world.

Everything the robot believes is the truth seen from that frame: `p_estimate = T_estimate_world @ p_world`. Commands go
the other way when they are given; what the estimate drifts while a step is under way does not bend that step.
"""

from __future__ import annotations

import numpy as np

from skills.footsteps.footstep import Footstep
from skills.geometry.pose import Array, Pose, rotation_z
from skills.parameters import parameter, parameters
from skills.walking.control_sample import ControlSample
from skills.walking.walking_state import RobotState, StepEvent, WalkingStatus


@parameters
class StateDriftParameters:
    """How the state estimate leaves the truth; by default it does not."""

    velocity: tuple[float, float, float] = parameter(
        (0.0, 0.0, 0.0), unit="m/s", minimum=-1.0, maximum=1.0, meaning="speed of the position's error in the world"
    )
    yaw_rate: float = parameter(0.0, unit="rad/s", minimum=-1.0, maximum=1.0, meaning="speed of the heading's error")
    yaw_jump: float = parameter(0.0, unit="rad", minimum=-3.2, maximum=3.2, meaning="sudden error of the heading")
    yaw_jump_time: float = parameter(0.0, unit="s", minimum=0.0, meaning="robot time of the sudden error")

    @property
    def none(self) -> bool:
        """Whether the estimate is the truth."""
        return not any((*self.velocity, self.yaw_rate, self.yaw_jump))


class StateDrift:
    """The frame of the estimate as it leaves the world's; turns are about the robot."""

    def __init__(self, parameters: StateDriftParameters) -> None:
        self._parameters = parameters
        self._none = parameters.none
        self._jumped = parameters.yaw_jump == 0.0
        self.T_estimate_world = Pose.identity()

    def advance(self, time: float, dt: float, robot_world: Array) -> None:
        """Drift on by a time step dt that ends at a robot time [s], with the robot truly at a point (3,) [m]."""
        if self._none:
            return
        turn = self._parameters.yaw_rate * dt
        if not self._jumped and time >= self._parameters.yaw_jump_time:
            turn, self._jumped = turn + self._parameters.yaw_jump, True
        R = rotation_z(turn)
        about = self.T_estimate_world @ robot_world
        shift = about - R @ about + dt * np.array(self._parameters.velocity)
        self.T_estimate_world = Pose(R, shift) @ self.T_estimate_world

    def estimated_state(self, state: RobotState) -> RobotState:
        """What the robot believes of its true state."""
        return state if self._none else state.moved(self.T_estimate_world)

    def estimated_status(self, status: WalkingStatus) -> WalkingStatus:
        """The walking controller's steps where the robot believes them to be."""
        return status if self._none else status.moved(self.T_estimate_world)

    def estimated_event(self, event: StepEvent) -> StepEvent:
        """A step's event where the robot believes it happened."""
        return event if self._none else event.moved(self.T_estimate_world)

    def estimated_sample(self, sample: ControlSample) -> ControlSample:
        """A line of the control-rate log as the robot believes it."""
        return sample if self._none else sample.moved(self.T_estimate_world)

    def true_step(self, step: Footstep) -> Footstep:
        """Where a step that the robot commands now lies in the world."""
        return step if self._none else step.moved(self.T_estimate_world.inverse)
