"""The phases that the queued steps will make: what is on the ground, where the CoP goes, how high the ground is.

A transfer shifts the CoP into the foot that will carry the next swing, a swing moves it on towards the toe, and after
the last step it comes to rest between the feet. The CoM height follows the lower of the two footholds on the way up
and anticipates the way down.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from skills.footsteps.footstep import Footstep, Side, Stance
from skills.geometry.pose import Array, Pose
from skills.walking.heel_lift import HeelLift, pitched_about_toe
from skills.walking.swing_parameters import SwingParameters
from skills.walking.swing_trajectory import SwingTrajectory
from skills.walking.walking_parameters import WalkingParameters


@dataclass(frozen=True, slots=True, eq=False)
class PlannedPhase:
    """A double or single support to come, or the rest of the present one.

    Attributes:
        stance: soles flat on the ground when it starts; a swinging foot's is where it comes from.
        elapsed: time since it started [s].
        remaining: time to its end [s].
        side: the foot that swings, or that the transfer takes the weight off; None in the last transfer.
        swing: the way of the swinging foot; None in double support.
        heel: toe-off of the trailing foot; None where it stays flat.
        cop_end: CoP at its end, (2,) [m].
        ground_end: height that the CoM height is counted from at its end [m].
        yaw_end: heading of the pelvis at its end [rad].
    """

    stance: Stance
    elapsed: float
    remaining: float
    side: Side | None
    swing: SwingTrajectory | None
    heel: HeelLift | None
    cop_end: Array
    ground_end: float
    yaw_end: float

    def sole(self, side: Side, t: float) -> Pose:
        """T_world_sole of one foot at a time since the phase's start [s]."""
        if side is self.side:
            if self.swing is not None:
                return self.swing.pose(t)
            if self.heel is not None:
                return self.heel.pose(t)
        return self.stance.sole(side)

    def points(self, side: Side, point_sole: Array, times: Array) -> Array:
        """A point fixed to one foot at times since the phase's start, (M, 3) in the world [s, m]."""
        if side is self.side and self.swing is not None:
            R, p = self.swing.poses(times)
            return p + R @ point_sole
        if side is self.side and self.heel is not None:
            return np.stack([self.heel.pose(float(t)) @ point_sole for t in times])
        return np.tile(self.stance.sole(side) @ point_sole, (len(times), 1))


def transfer_phase(
    stance: Stance,
    step: Footstep,
    elapsed: float,
    remaining: float,
    duration: float,
    toe: float,
    parameters: WalkingParameters,
) -> PlannedPhase:
    """The double support before a step; its heel may lift about the toe line."""
    carrying = stance.sole(step.side.opposite)
    start = parameters.heel_lift_start * duration
    lift = heel_lift(duration, parameters)
    heel = HeelLift(stance.sole(step.side), toe, lift, start, max(duration - start, 1e-6))
    return PlannedPhase(
        stance=stance,
        elapsed=elapsed,
        remaining=remaining,
        side=step.side,
        swing=None,
        heel=heel,
        cop_end=cop_in_sole(carrying, step.side.opposite, parameters.cop_in, parameters),
        ground_end=_ground_after_transfer(stance.sole(step.side).p[2], carrying.p[2], parameters),
        yaw_end=stance.yaw,
    )


def swing_phase(
    stance: Stance,
    step: Footstep,
    swing: SwingTrajectory | None,
    elapsed: float,
    remaining: float,
    parameters: WalkingParameters,
) -> PlannedPhase:
    """The single support of a step."""
    carrying = stance.sole(step.side.opposite)
    low, rise = float(carrying.p[2]), float(step.T_world_sole.p[2] - carrying.p[2])
    above = parameters.rise_in_swing * rise if rise >= 0.0 else (1.0 - parameters.drop_after_swing) * rise
    return PlannedPhase(
        stance=stance,
        elapsed=elapsed,
        remaining=remaining,
        side=step.side,
        swing=swing,
        heel=None,
        cop_end=cop_in_sole(carrying, step.side.opposite, parameters.cop_out, parameters),
        ground_end=low + above,
        yaw_end=stance.with_sole(step.side, step.T_world_sole).yaw,
    )


def resting_phase(
    stance: Stance, last_side: Side | None, remaining: float, parameters: WalkingParameters
) -> PlannedPhase:
    """The double support in which the robot comes to rest, or stands."""
    new = stance.sole(last_side or Side.LEFT).p[2]
    old = stance.sole((last_side or Side.LEFT).opposite).p[2]
    return PlannedPhase(
        stance=stance,
        elapsed=0.0,
        remaining=remaining,
        side=None,
        swing=None,
        heel=None,
        cop_end=stance.mid_feet[:2],
        ground_end=_ground_after_transfer(old, new, parameters),
        yaw_end=stance.yaw,
    )


def phases_of_steps(
    stance: Stance,
    steps: Sequence[Footstep],
    last_side: Side | None,
    toe: float,
    horizon: float,
    parameters: WalkingParameters,
    swing_parameters: SwingParameters,
) -> list[PlannedPhase]:
    """The phases of steps to come, each with its transfer, until the robot rests.

    Args:
        stance: soles flat on the ground before the first of them.
        steps: in order.
        last_side: foot that moved last where there are no steps.
        toe: toe line before the sole's centre [m].
        horizon: phases that start later have no swing trajectory [s].
        parameters: settings of walking.
        swing_parameters: settings of swings.
    """
    phases: list[PlannedPhase] = []
    for step in steps:
        transfer, swing_time = step.transfer_duration, step.swing_duration
        phases.append(transfer_phase(stance, step, 0.0, transfer, transfer, toe, parameters))
        horizon -= transfer
        lift_off = pitched_about_toe(stance.sole(step.side), toe, heel_lift(transfer, parameters))
        swing = SwingTrajectory(lift_off, step, swing_parameters) if horizon > 0.0 else None
        phases.append(swing_phase(stance, step, swing, 0.0, swing_time, parameters))
        horizon -= swing_time
        stance, last_side = stance.with_sole(step.side, step.T_world_sole), step.side
    phases.append(resting_phase(stance, last_side, parameters.final_transfer, parameters))
    return phases


def heel_lift(transfer: float, parameters: WalkingParameters) -> float:
    """Pitch that a trailing foot reaches in a transfer of a duration [rad, s]."""
    time = (1.0 - parameters.heel_lift_start) * transfer
    return min(parameters.heel_lift, parameters.heel_lift_rate * time)


def cop_in_sole(T_world_sole: Pose, side: Side, forward: float, parameters: WalkingParameters) -> Array:
    """The planned CoP in one foot from above, (2,) in the world [m]."""
    return (T_world_sole @ np.array([forward, -side.sign * parameters.cop_inward, 0.0]))[:2]


def _ground_after_transfer(old: float, new: float, parameters: WalkingParameters) -> float:
    return float(min(new, old + parameters.rise_in_transfer * (new - old)))
