"""The lattice of poses over which footsteps are searched: places from the stance foot on, headings along the path.

Headings that followed the stance foot's would make every step pay for how that foot happens to be turned.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, sin

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.footstep import Side, Stance
from skills.footsteps.footstep_parameters import FootstepParameters
from skills.footsteps.search_space import LATTICE
from skills.footsteps.search_target import SearchTarget
from skills.footsteps.terrain import Foothold, Terrain, sole_on_slope
from skills.geometry.pose import Array, wrap_angle


@dataclass(frozen=True, slots=True, eq=False)
class FootstepLattice:
    """Where the nodes of a search lie.

    Attributes:
        shape: number of floors, headings, ny, nx.
        start: floor, nearest heading, iy and ix of the stance foot.
        anchor_world: where the stance foot is, (3,) [m].
        yaw: the lattice's heading that is nearest to its own [rad].
        spacing: distance of two nodes [m].
        turn: angle between two headings [rad].
    """

    shape: tuple[int, int, int, int]
    start: tuple[int, int, int, int]
    anchor_world: Array
    yaw: float
    spacing: float
    turn: float

    @classmethod
    def around(
        cls, terrain: Terrain, stance: Stance, first_side: Side, target: SearchTarget, parameters: FootstepParameters
    ) -> FootstepLattice:
        """The lattice through the stance foot that covers the ground and the headings of a search."""
        anchor = stance.sole(first_side.opposite)
        x_before, y_before = (max(0, int(n)) for n in (anchor.p[:2] - target.low_world) / parameters.lattice)
        x_after, y_after = (max(0, int(n)) for n in (target.high_world - anchor.p[:2]) / parameters.lattice)
        turn = 2 * np.pi / parameters.headings
        way = float(target.path_world[-1, 2])
        yaw = way + turn * round(wrap_angle(anchor.yaw - way) / turn)
        most = target.turn(anchor.yaw, parameters)
        headings = min(2 * int(np.ceil(most / turn)) + 1, parameters.headings)
        shape = (terrain.raster.cells.shape[0], headings, y_before + y_after + 1, x_before + x_after + 1)
        start = (terrain.floor(anchor.p), headings // 2, y_before, x_before)
        return cls(shape, start, anchor.p, yaw, parameters.lattice, turn)

    @property
    def stances(self) -> int:
        """Number of nodes of one side."""
        floors, headings, ny, nx = self.shape
        return floors * headings * ny * nx

    def record(self) -> NDArray[np.void]:
        """The lattice as the kernels take it: one `LATTICE`."""
        return np.array([(*self.shape, *self.start, self.stances)], dtype=LATTICE)

    def headings(self, *others: float) -> Array:
        """Rows of angle, cosine and sine of the lattice's headings and of others, (H + len(others), 3)."""
        yaws = [self.yaw + (k - self.start[1]) * self.turn for k in range(self.shape[1])]
        return np.array([(yaw, cos(yaw), sin(yaw)) for yaw in (*yaws, *others)])

    def foothold(self, node: int, grounds: NDArray[np.void]) -> Foothold:
        """The foothold of a node, on the ground that the search found."""
        _, headings, ny, nx = self.shape
        snap = node % self.stances
        heading, iy, ix = snap // (ny * nx) % headings, snap // nx % ny, snap % nx
        x = self.anchor_world[0] + (ix - self.start[3]) * self.spacing
        y = self.anchor_world[1] + (iy - self.start[2]) * self.spacing
        z, a, b = (float(grounds[snap][name]) for name in ("z", "a", "b"))
        T_world_sole = sole_on_slope(x, y, z, self.yaw + (heading - self.start[1]) * self.turn, a, b)
        return Foothold(T_world_sole, float(grounds[snap]["share"]), "")
