"""The log of a search: every step that it looked at, in order, with its outcome, where it is, and what it cost."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.footstep import Side
from skills.footsteps.footstep_lattice import FootstepLattice
from skills.footsteps.search_space import EDGE_LOG, EXPANDED, OPENED, SearchSpace
from skills.geometry.pose import Array, readonly


@dataclass(frozen=True, slots=True, eq=False)
class SearchLog:
    """The steps that a search looked at.

    Attributes:
        first_side: the foot that makes the first step.
        shape: number of floors, headings, rows and columns of the lattice.
        start: floor, heading, row and column of the stance foot.
        anchor_world: where it is, (3,) [m].
        yaw: its heading [rad].
        spacing: distance of two nodes [m].
        turn: angle between two headings [rad].
        edges: `EDGE_LOG`s in the order in which they were looked at.
    """

    LAYOUT: ClassVar[np.dtype[np.void]] = EDGE_LOG

    first_side: Side
    shape: tuple[int, int, int, int]
    start: tuple[int, int, int, int]
    anchor_world: Array
    yaw: float
    spacing: float
    turn: float
    edges: NDArray[np.void]

    @classmethod
    def of(cls, lattice: FootstepLattice, first_side: Side, space: SearchSpace) -> SearchLog:
        """What a search has written down."""
        edges = space.log[: space.logged[0]].copy()
        edges.flags.writeable = False
        return cls(
            first_side, lattice.shape, lattice.start, lattice.anchor_world, lattice.yaw, lattice.spacing, lattice.turn,
            edges,
        )  # fmt: skip

    @property
    def expanded(self) -> NDArray[np.bool_]:
        """Which rows tell that their node was expanded, (N,)."""
        return self.edges["reason"] == EXPANDED

    @property
    def opened(self) -> NDArray[np.bool_]:
        """Which rows tell that a step was allowed, and its node opened, (N,); all others were rejected."""
        return self.edges["reason"] == OPENED

    def places(self, nodes: NDArray[np.int32]) -> tuple[Array, NDArray[np.bool_]]:
        """Where nodes are, (N, 3) rows of x, y [m], yaw [rad] in the world, and which are of the left foot, (N,).

        The node past the last, the swing foot before the first step, has no place: NaN.
        """
        floors, headings, ny, nx = self.shape
        stances = floors * headings * ny * nx
        snap = nodes.astype(np.int64) % stances
        heading, iy, ix = snap // (ny * nx) % headings, snap // nx % ny, snap % nx
        places = np.column_stack(
            (
                self.anchor_world[0] + (ix - self.start[3]) * self.spacing,
                self.anchor_world[1] + (iy - self.start[2]) * self.spacing,
                self.yaw + (heading - self.start[1]) * self.turn,
            )
        )
        places[nodes >= 2 * stances] = np.nan
        return readonly(places), nodes < stances
