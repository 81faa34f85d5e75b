"""The cells of a height map as a ring buffer: the map follows the robot while every cell stays where it is in memory.

The cell of the world in row i and column j, counted from the origin of the world, is always stored at (i mod n, j mod
n), n being the number of cells along an edge. When the map moves, the rows and columns that leave it are cleared, and
are from then on those that enter.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray


class Window(NamedTuple):
    """Which part of the world a map holds: its first row and column counted from the origin, and its cells."""

    row: int
    column: int
    cells: int
    resolution: float


class CellRing(NamedTuple):
    """What is known of each cell, (cells, cells) each, stored as in a ring.

    Attributes:
        height: of the highest surface, NaN where unknown [m].
        variance: of the height when it was last confirmed [m^2].
        seen: robot time at which it was last confirmed [s].
        votes: how often in a row the height was contradicted.
    """

    height: NDArray[np.float32]
    variance: NDArray[np.float32]
    seen: NDArray[np.float64]
    votes: NDArray[np.uint8]


def empty_ring(cells: int) -> CellRing:
    """A ring in which nothing is known."""
    shape = (cells, cells)
    height, variance = np.full(shape, np.nan, np.float32), np.zeros(shape, np.float32)
    return CellRing(height, variance, np.zeros(shape), np.zeros(shape, np.uint8))


def scroll(ring: CellRing, before: Window, after: Window) -> None:
    """Forget the cells that a map loses when it moves."""
    ring.height[_leaving(before.row, after.row, before.cells), :] = np.nan
    ring.height[:, _leaving(before.column, after.column, before.cells)] = np.nan


def _leaving(before: int, after: int, cells: int) -> NDArray[np.int64]:
    """Where the rows that are in a window and not in the next are stored."""
    end = before + cells
    first, last = (before, min(after, end)) if after > before else (max(after + cells, before), end)
    return np.arange(first, last) % cells
