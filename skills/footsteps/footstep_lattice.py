"""The lattice of poses over which footsteps are searched, anchored at the stance foot."""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.footstep import Side, Stance
from skills.footsteps.footstep_parameters import FootstepParameters
from skills.footsteps.search_space import LATTICE
from skills.footsteps.terrain import sole_on_slope
from skills.geometry.pose import Array, Pose, wrap_angle

if TYPE_CHECKING:
    from skills.body_path.sub_goal import SubGoal


@dataclass(frozen=True, slots=True, eq=False)
class FootstepLattice:
    """Where the nodes of a search lie.

    Attributes:
        shape: number of headings, ny, nx.
        start: heading, iy and ix of the stance foot.
        anchor_world: where the stance foot is, (3,) [m].
        yaw: its heading [rad].
        spacing: distance of two nodes [m].
        turn: angle between two headings [rad].
    """

    shape: tuple[int, int, int]
    start: tuple[int, int, int]
    anchor_world: Array
    yaw: float
    spacing: float
    turn: float

    @classmethod
    def around(cls, stance: Stance, first_side: Side, goal: SubGoal, parameters: FootstepParameters) -> FootstepLattice:
        """The lattice through the stance foot that covers the ground and the headings to a sub-goal."""
        anchor = stance.sole(first_side.opposite)
        low, high = search_window(stance, goal, parameters)
        x_before, y_before = (int(n) for n in (anchor.p[:2] - low) / parameters.lattice)
        x_after, y_after = (int(n) for n in (high - anchor.p[:2]) / parameters.lattice)
        turn = 2 * np.pi / parameters.headings
        most = max(abs(wrap_angle(yaw - anchor.yaw)) for yaw in goal.searched_world[:, 2])
        headings = min(2 * int(np.ceil((most + parameters.heading_margin) / turn)) + 1, parameters.headings)
        shape = (headings, y_before + y_after + 1, x_before + x_after + 1)
        start = (headings // 2, y_before, x_before)
        return cls(shape, start, anchor.p, anchor.yaw, parameters.lattice, turn)

    @property
    def stances(self) -> int:
        """Number of nodes of one side."""
        return self.shape[0] * self.shape[1] * self.shape[2]

    def record(self) -> NDArray[np.void]:
        """The lattice as the kernels take it: one `LATTICE`."""
        return np.array([(*self.shape, *self.start, self.stances)], dtype=LATTICE)

    def headings(self, *others: float) -> Array:
        """Rows of angle, cosine and sine of the lattice's headings and of others, (H + len(others), 3)."""
        yaws = [self.yaw + (k - self.start[0]) * self.turn for k in range(self.shape[0])]
        return np.array([(yaw, cos(yaw), sin(yaw)) for yaw in (*yaws, *others)])

    def pose(self, node: int, grounds: NDArray[np.void]) -> Pose:
        """Sole frame of a node, on the ground that the search found."""
        _, ny, nx = self.shape
        snap = node % self.stances
        heading, iy, ix = snap // (ny * nx), snap // nx % ny, snap % nx
        x = self.anchor_world[0] + (ix - self.start[2]) * self.spacing
        y = self.anchor_world[1] + (iy - self.start[1]) * self.spacing
        z, a, b = (float(grounds[snap][name]) for name in ("z", "a", "b"))
        return sole_on_slope(x, y, z, self.yaw + (heading - self.start[0]) * self.turn, a, b)


def search_window(stance: Stance, goal: SubGoal, parameters: FootstepParameters) -> tuple[Array, Array]:
    """Corners of the ground that is searched from a stance to a sub-goal."""
    points = np.vstack((goal.searched_world[:, :2], stance.T_world_left.p[:2], stance.T_world_right.p[:2]))
    return points.min(axis=0) - parameters.window_margin, points.max(axis=0) + parameters.window_margin
