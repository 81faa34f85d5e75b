"""The way that a moving place has taken, as a body path for whoever follows it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skills.body_path.body_path import BodyPath
from skills.body_path.goal import Goal
from skills.geometry.pose import Array, readonly, wrap_angle

# Places nearer to each other than these are one [m] and [rad].
_SPACING, _TURN = 0.05, 0.05


@dataclass(frozen=True, slots=True, eq=False)
class Trail:
    """Where something has been.

    Attributes:
        poses_world: (N >= 1, 3) rows of x, y [m] and heading [rad], the oldest first.
    """

    poses_world: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "poses_world", readonly(self.poses_world, (None, 3)))

    def to(self, place: Goal) -> Trail:
        """The trail after a move."""
        poses, pose = self.poses_world, place.xyyaw_world
        last = poses[-2] if len(poses) > 1 else poses[-1]
        near = np.hypot(*(pose - last)[:2]) < _SPACING and abs(wrap_angle(pose[2] - last[2])) < _TURN
        return Trail(np.vstack((poses[:-1] if near and len(poses) > 1 else poses, pose)))

    def behind(self, point_world: Array) -> Trail:
        """What of it is left for whoever has come to a point, of which x and y count."""
        if len(self.poses_world) < 3:
            return self
        path = self.path()
        passed = int(np.searchsorted(path.arc_lengths, path.project(point_world), side="right")) - 1
        return Trail(self.poses_world[max(min(passed, len(self.poses_world) - 2), 0) :])

    def path(self, path_id: int = 0) -> BodyPath:
        """A body path along it."""
        poses = self.poses_world
        return BodyPath(poses if len(poses) > 1 else np.repeat(poses, 2, axis=0), path_id, squares_up=False)
