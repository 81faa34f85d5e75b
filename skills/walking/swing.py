"""A foot in the air: how far along its trajectory it is, and how far its target has moved since lift-off."""

from __future__ import annotations

import numpy as np

from skills.footsteps.footstep import Footstep
from skills.geometry.pose import Array, Pose
from skills.walking.swing_parameters import SwingParameters
from skills.walking.swing_trajectory import SoleMotion, SwingTrajectory


class Swing:
    """One swing under way.

    Args:
        T_world_start: sole at lift-off.
        step: the step to make.
        parameters: settings of the swing.

    Attributes:
        step: the step to make, as commanded.
        trajectory: the way to its foothold.
        share: of the trajectory that has passed; more than 1 where the ground did not come.
        pace: how fast the trajectory passes, 1 as commanded.
        taken_back: whether it ended on nothing and goes on.
        shift: of the target from the commanded foothold, in its plane, (3,) in the world [m].
    """

    def __init__(self, T_world_start: Pose, step: Footstep, parameters: SwingParameters) -> None:
        self.step = step
        self.trajectory = SwingTrajectory(T_world_start, step, parameters)
        self.share = 0.0
        self.pace = 1.0
        self.taken_back = False
        self.shift = np.zeros(3)
        self._shift_rate = np.zeros(3)

    @property
    def remaining(self) -> float:
        """Time to the end of the trajectory at the present pace [s]."""
        return max(0.0, 1.0 - self.share) * self.step.swing_duration / self.pace

    @property
    def T_world_target(self) -> Pose:
        """Where the sole shall land."""
        target = self.step.T_world_sole
        return Pose(target.R, target.p + self.shift)

    def advance(self, dt: float) -> None:
        """Let time pass [s]."""
        self.share += dt * self.pace / self.step.swing_duration

    def retarget(self, shift: Array, pace: float, dt: float) -> None:
        """Move the target by a step of its shift within one control tick dt, and change the pace.

        Args:
            shift: of the target from the commanded foothold, (2,) in the world; the third follows from its plane [m].
            pace: 1 as commanded.
            dt: since the last tick [s].
        """
        normal = self.step.T_world_sole.R[:, 2]
        moved = np.array((shift[0], shift[1], -(normal[0] * shift[0] + normal[1] * shift[1]) / normal[2]))
        self._shift_rate = (moved - self.shift) / dt
        self.shift, self.pace = moved, pace

    def motion(self) -> SoleMotion:
        """Where the sole shall be now and how it shall move."""
        rate = self.pace / self.step.swing_duration
        motion = self.trajectory.motion(self.share, rate)
        if not self.shift.any():
            return motion
        travelled, slope = self.trajectory.travelled(self.share)
        velocity = motion.velocity.copy()
        velocity[:3] += self._shift_rate * travelled + self.shift * (slope * rate)
        pose = Pose(motion.pose.R, motion.pose.p + self.shift * travelled)
        return SoleMotion(pose, velocity, motion.acceleration)
