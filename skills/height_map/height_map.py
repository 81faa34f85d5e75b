"""Height maps: the ground around the robot as one height a cell."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skills.geometry.pose import Array, readonly


@dataclass(frozen=True, slots=True)
class ScanAccount:
    """What became of the returns of one scan, and of the cells.

    Attributes:
        returns: beams that came back.
        outside, above, own_body: returns outside the map, above the ceiling, and from the robot itself.
        new, confirmed, replaced: cells whose first height returns gave, or whose height they confirmed or raised.
        doubted, faded: cells whose height the scan contradicts, or has contradicted for so long that it was given up.
        spikes, filled: outliers removed, and holes filled, in this map alone.
    """

    returns: int = 0
    outside: int = 0
    above: int = 0
    own_body: int = 0
    new: int = 0
    confirmed: int = 0
    replaced: int = 0
    doubted: int = 0
    faded: int = 0
    spikes: int = 0
    filled: int = 0


@dataclass(frozen=True, slots=True, eq=False)
class HeightMap:
    """Heights of the highest surface in each cell of a horizontal grid.

    Attributes:
        heights: (rows, columns) float32, NaN where unknown [m]; rows go along y, columns along x.
        variances: of the heights, NaN where unknown [m^2].
        filled: cells without data of their own, (rows, columns) bool.
        resolution: edge of a cell [m].
        origin_world: corner of the first cell with the least x and y, (2,) [m].
        time: robot time of the newest scan [s].
        scan_id: of the newest scan.
        ground_height: height of the lowest ground around; NaN where nothing is known [m].
        account: what became of the newest scan.
    """

    heights: NDArray[np.float32]
    variances: NDArray[np.float32]
    filled: NDArray[np.bool_]
    resolution: float
    origin_world: Array
    time: float
    scan_id: int
    ground_height: float
    account: ScanAccount

    def __post_init__(self) -> None:
        for array in (self.heights, self.variances, self.filled):
            array.flags.writeable = False
        object.__setattr__(self, "origin_world", readonly(self.origin_world, (2,)))

    def inside(self, xy_world: ArrayLike) -> NDArray[np.bool_]:
        """Whether points of shape (..., 2) lie in the map, shape (...)."""
        cells = self._cells(xy_world)
        return np.asarray(((cells >= 0.0) & (cells < self._extent)).all(axis=-1))

    def nearest(self, xy_world: ArrayLike) -> Array:
        """Heights of the cells that hold points of shape (..., 2); NaN outside and where unknown, shape (...) [m]."""
        inside = self.inside(xy_world)
        column, row = np.moveaxis(np.where(inside[..., None], self._cells(xy_world), 0.0).astype(int), -1, 0)
        return np.where(inside, self.heights[row, column].astype(np.float64), np.nan)

    def bilinear(self, xy_world: ArrayLike) -> Array:
        """Heights at points of shape (..., 2) from the four cells around, shape (...) [m].

        Where not all four are known it is `nearest`.
        """
        inside = self.inside(xy_world)
        cells = np.where(inside[..., None], self._cells(xy_world) - 0.5, 0.0)
        first = np.clip(np.floor(cells), 0, self._extent - 2).astype(int)
        s, t = np.moveaxis(np.clip(cells - first, 0.0, 1.0), -1, 0)
        column, row = np.moveaxis(first, -1, 0)
        low = (1.0 - s) * self.heights[row, column] + s * self.heights[row, column + 1]
        high = (1.0 - s) * self.heights[row + 1, column] + s * self.heights[row + 1, column + 1]
        heights = np.asarray((1.0 - t) * low + t * high, dtype=np.float64)
        return np.where(inside & ~np.isnan(heights), heights, self.nearest(xy_world))

    @property
    def points_world(self) -> Array:
        """Centres of all known cells, (N, 3) [m]."""
        row, column = np.nonzero(~np.isnan(self.heights))
        xy = self.origin_world + self.resolution * (np.column_stack((column, row)) + 0.5)
        return np.column_stack((xy, self.heights[row, column].astype(np.float64)))

    @property
    def _extent(self) -> NDArray[np.int64]:
        rows, columns = self.heights.shape
        return np.array((columns, rows))

    def _cells(self, xy_world: ArrayLike) -> Array:
        """Column and row of points, with fractions, (..., 2)."""
        return (np.asarray(xy_world, dtype=np.float64) - self.origin_world) / self.resolution
