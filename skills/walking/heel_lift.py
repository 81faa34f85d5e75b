"""Toe-off: the trailing foot pitches about its toe line in double support, so that a long step stays within reach."""

from __future__ import annotations

from dataclasses import dataclass

from skills.geometry.pose import Pose, rotation_y
from skills.walking.uniform_spline import minimum_jerk_at


@dataclass(frozen=True, slots=True, eq=False)
class HeelLift:
    """A heel that rises about the toe line.

    Attributes:
        T_world_sole: the sole flat on its foothold.
        toe: toe line before the sole's centre [m].
        pitch: at the end of the lift [rad].
        start, duration: of the lift, since the phase's start [s].
    """

    T_world_sole: Pose
    toe: float
    pitch: float
    start: float
    duration: float

    def pose(self, t: float) -> Pose:
        """T_world_sole at a time since the phase's start [s]."""
        pitch = self.pitch * minimum_jerk_at((t - self.start) / self.duration)
        return pitched_about_toe(self.T_world_sole, self.toe, pitch)


def pitched_about_toe(T_world_sole: Pose, toe: float, pitch: float) -> Pose:
    """A sole turned about its toe line, heel up [m, rad]."""
    if pitch == 0.0:
        return T_world_sole
    R = T_world_sole.R @ rotation_y(pitch)
    return Pose(R, T_world_sole.p + toe * (T_world_sole.R[:, 0] - R[:, 0]))
