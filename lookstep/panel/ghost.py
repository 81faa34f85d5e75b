"""The robot as it would walk a plan: a preview that steps through it at the plan's own times, again and again."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from skills.footsteps import Footstep, Side, Stance
from skills.geometry import Array, Pose

_REST = 0.8  # at the end, before it begins anew [s]


@dataclass(frozen=True, slots=True, eq=False)
class GhostPose:
    """The preview at one moment.

    Attributes:
        stance: both soles, one of them perhaps in the air.
        com_xy: CoM from above, (2,) [m].
        ground_height: under the foot that carries [m].
        yaw: heading of the pelvis [rad].
    """

    stance: Stance
    com_xy: Array
    ground_height: float
    yaw: float


class Ghost:
    """A walk over footsteps from a stance.

    Args:
        stance: where it begins.
        steps: the plan's, in order.
    """

    def __init__(self, stance: Stance, steps: Sequence[Footstep]) -> None:
        self._stances = [stance]
        for step in steps:
            self._stances.append(self._stances[-1].with_sole(step.side, step.T_world_sole))
        self._steps = tuple(steps)

    @property
    def duration(self) -> float:
        """From the first transfer to the last landing [s]."""
        return sum(step.transfer_duration + step.swing_duration for step in self._steps)

    def at(self, time: float) -> GhostPose:
        """The preview so long after its beginning; it rests at the end and begins anew [s]."""
        left = time % (self.duration + _REST)
        for i, step in enumerate(self._steps):
            before, after = self._stances[i], self._stances[i + 1]
            if left < step.transfer_duration:
                share = left / step.transfer_duration
                start = _middle(before) if i == 0 else before.sole(step.side).p
                carrying = before.sole(_other(step.side)).p
                return _pose(before, (1.0 - share) * start + share * carrying)
            left -= step.transfer_duration
            if left < step.swing_duration:
                share = left / step.swing_duration
                sole = _swung(before.sole(step.side), step, share)
                return _pose(after.with_sole(step.side, sole), before.sole(_other(step.side)).p)
            left -= step.swing_duration
        return _pose(self._stances[-1], _middle(self._stances[-1]))


def _swung(start: Pose, step: Footstep, share: float) -> Pose:
    """The sole on its way: along the waypoints, or over a bow of the swing's height where there are none."""
    end = step.T_world_sole
    places = np.vstack((start.p, step.swing_waypoints_world, end.p))
    if len(places) == 2:
        top = 0.5 * (start.p + end.p)
        top[2] = max(start.p[2], end.p[2]) + step.swing_height
        places = np.vstack((start.p, top, end.p))
    lengths = np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(places, axis=0), axis=1))))
    along = lengths[-1] * share
    p = np.array([np.interp(along, lengths, places[:, axis]) for axis in range(3)])
    first, last = start.quaternion_wxyz, end.quaternion_wxyz
    last = -last if first @ last < 0.0 else last
    return Pose.from_quaternion_wxyz((1.0 - share) * first + share * last, p)


def _pose(stance: Stance, com: Array) -> GhostPose:
    height = min(stance.sole(side).p[2] for side in Side)
    return GhostPose(stance, np.array(com[:2]), float(height), stance.yaw)


def _middle(stance: Stance) -> Array:
    return np.asarray(stance.mid_feet)


def _other(side: Side) -> Side:
    return Side.RIGHT if side is Side.LEFT else Side.LEFT
