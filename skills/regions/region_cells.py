"""The cells of an endless raster that regions cover, and windows of that raster filled with their heights.

Cells have fixed places in the world: those of a region are found once and hold wherever the robot goes. Their heights
are exact, their outline is right to the cell.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array, Pose, rotation_z
from skills.kernels import kernel
from skills.regions.planar_region import PlanarRegion

Raster = NDArray[np.float32]
Indices = NDArray[np.int32]

# Edges of a course along an axis would lie between the same two cells all along; turned, they do not.
T_RASTER_WORLD = Pose(rotation_z(-0.4), np.zeros(3))


class Cells(NamedTuple):
    """Cells of some regions, one after the other: rows, columns, heights [m], and where each region's begin."""

    rows: Indices
    columns: Indices
    heights: Raster
    starts: NDArray[np.int64]

    def of(self, region: int) -> Cells:
        """Those of one region."""
        part = slice(self.starts[region], self.starts[region + 1])
        count = self.starts[region + 1] - self.starts[region]
        return Cells(self.rows[part], self.columns[part], self.heights[part], np.array((0, count)))

    @classmethod
    def joined(cls, parts: list[Cells]) -> Cells:
        """Those of single regions, one after the other."""
        if not parts:
            return _NO_CELLS
        starts = np.cumsum([0, *(len(part.rows) for part in parts)])
        return cls(
            np.concatenate([part.rows for part in parts]),
            np.concatenate([part.columns for part in parts]),
            np.concatenate([part.heights for part in parts]),
            starts,
        )

    def points_world(self, cell: float, stride: int = 1) -> Array:
        """Every so many of the points, (N, 3) [m]."""
        places = np.column_stack((self.columns[::stride], self.rows[::stride])) + 0.5
        points = np.column_stack((cell * places, self.heights[::stride]))
        return T_RASTER_WORLD.inverse @ points.astype(np.float64)


_NO_CELLS = Cells(np.empty(0, np.int32), np.empty(0, np.int32), np.empty(0, np.float32), np.zeros(1, np.int64))


@dataclass(frozen=True, slots=True)
class Window:
    """A part of the raster.

    Attributes:
        column, row: of its first cell, counted from the origin of the raster's frame.
        shape: rows and columns.
        cell: edge of a cell [m].
    """

    column: int
    row: int
    shape: tuple[int, int]
    cell: float

    @classmethod
    def between(cls, low: Array, high: Array, cell: float) -> Window:
        """The window that holds two corners, (2,) in the raster's frame [m]."""
        column, row = (int(n) for n in np.floor(low / cell))
        columns, rows = (int(n) for n in np.ceil(high / cell))
        return cls(column, row, (max(rows - row, 1), max(columns - column, 1)), cell)

    @classmethod
    def around(cls, p_world: Array, radius: float, cell: float) -> Window:
        """A square window about a point."""
        middle = (T_RASTER_WORLD @ p_world)[:2]
        return cls.between(middle - radius, middle + radius, cell)

    @property
    def middle(self) -> Array:
        """Its middle at height 0, (3,) in the raster's frame [m]."""
        rows, columns = self.shape
        return self.cell * np.array((self.column + 0.5 * columns, self.row + 0.5 * rows, 0.0))

    def overlap(self, other: Window) -> tuple[tuple[slice, slice], tuple[slice, slice]]:
        """Rows and columns of this window and of another one that are the same cells."""
        own, others = [], []
        starts = ((self.row, other.row), (self.column, other.column))
        for (start, other_start), size, other_size in zip(starts, self.shape, other.shape, strict=True):
            low = max(start, other_start)
            high = max(low, min(start + size, other_start + other_size))
            own.append(slice(low - start, high - start))
            others.append(slice(low - other_start, high - other_start))
        return (own[0], own[1]), (others[0], others[1])

    def paint(self, cells: Cells) -> tuple[Raster, Raster]:
        """Heights, 0 where no region is, and 1 where one is, (rows, columns) each.

        Where regions overlap, the mean of their heights is taken: pixels of a riser are given in part to the tread
        above and in part to the one below, and drawn on either they reach equally far beyond the edge.
        """
        heights, mask = np.zeros(self.shape, np.float32), np.zeros(self.shape, np.float32)
        _paint(cells.rows, cells.columns, cells.heights, self.row, self.column, heights, mask)
        return heights, mask


def cells_of(regions: tuple[PlanarRegion, ...], cell: float) -> Cells:
    """The cells that regions cover, of a given edge [m]; none may be vertical."""
    if not regions:
        return _NO_CELLS
    R = T_RASTER_WORLD.R @ np.array([region.T_world_region.R for region in regions])
    p = T_RASTER_WORLD @ np.array([region.T_world_region.p for region in regions])
    slopes = -R[:, :2, 2] / R[:, 2, 2:]
    planes = np.column_stack((slopes, p[:, 2] - np.sum(slopes * p[:, :2], axis=1)))
    rings, ring_starts, owners = [], [0], []
    for index, region in enumerate(regions):
        for ring in (region.hull_region, *region.holes_region):
            rings.append(ring @ R[index, :2, :2].T + p[index, :2])
            ring_starts.append(ring_starts[-1] + len(ring))
            owners.append(index)
    outlines = (np.concatenate(rings), np.array(ring_starts), np.array(owners))
    starts = np.zeros(len(regions) + 1, np.int64)
    nothing = np.empty(0, np.int32)
    _scan(*outlines, planes, cell, starts, nothing, nothing, np.empty(0, np.float32))
    count = int(starts[-1])
    rows, columns = np.empty(count, np.int32), np.empty(count, np.int32)
    heights = np.empty(count, np.float32)
    _scan(*outlines, planes, cell, starts, rows, columns, heights)
    return Cells(rows, columns, heights, starts)


@kernel
def _scan(
    vertices: Array,
    ring_starts: NDArray[Any],
    ring_regions: NDArray[Any],
    planes: Array,
    cell: float,
    starts: NDArray[Any],
    rows: Indices,
    columns: Indices,
    heights: Raster,
) -> None:
    """Scan outlines row by row, even-odd, so that holes stay open; writes cells as far as there is room for them."""
    crossings = np.empty(vertices.shape[0] + 1)
    found = 0
    ring = 0
    while ring < ring_regions.shape[0]:
        region = ring_regions[ring]
        last = ring
        lowest, highest = np.inf, -np.inf
        while last < ring_regions.shape[0] and ring_regions[last] == region:
            for v in range(ring_starts[last], ring_starts[last + 1]):
                lowest, highest = min(lowest, vertices[v, 1]), max(highest, vertices[v, 1])
            last += 1
        for row in range(int(np.ceil(lowest / cell - 0.5)), int(np.floor(highest / cell - 0.5)) + 1):
            y = (row + 0.5) * cell
            count = 0
            for k in range(ring, last):
                begin, end = ring_starts[k], ring_starts[k + 1]
                for v in range(begin, end):
                    w = v + 1 if v + 1 < end else begin
                    if (vertices[v, 1] <= y) != (vertices[w, 1] <= y):
                        slope = (vertices[w, 0] - vertices[v, 0]) / (vertices[w, 1] - vertices[v, 1])
                        x = vertices[v, 0] + (y - vertices[v, 1]) * slope
                        place = count
                        while place > 0 and crossings[place - 1] > x:
                            crossings[place] = crossings[place - 1]
                            place -= 1
                        crossings[place] = x
                        count += 1
            for k in range(0, count - 1, 2):
                first = int(np.ceil(crossings[k] / cell - 0.5))
                for column in range(first, int(np.floor(crossings[k + 1] / cell - 0.5)) + 1):
                    if found < rows.shape[0]:
                        rows[found], columns[found] = row, column
                        x = (column + 0.5) * cell
                        heights[found] = planes[region, 0] * x + planes[region, 1] * y + planes[region, 2]
                    found += 1
        starts[region + 1] = found
        ring = last


@kernel
def _paint(
    rows: Indices, columns: Indices, cell_heights: Raster, row: int, column: int, heights: Raster, mask: Raster
) -> None:
    ny, nx = mask.shape
    for n in range(rows.shape[0]):
        i, j = rows[n] - row, columns[n] - column
        if 0 <= i < ny and 0 <= j < nx:
            mask[i, j] += np.float32(1.0)
            # A running mean: the same as the sum divided at the end, but without a second pass.
            heights[i, j] += (cell_heights[n] - heights[i, j]) / mask[i, j]
    for i in range(ny):
        for j in range(nx):
            mask[i, j] = min(mask[i, j], np.float32(1.0))


def hold(cells: Cells, points_world: Array, cell: float, tolerance: float) -> NDArray[np.bool_]:
    """Which points, (N, 3), lie on a cell, up to a tolerance in height [m]."""
    points = T_RASTER_WORLD @ points_world
    found = np.zeros(len(points), np.bool_)
    _hold(cells.rows, cells.columns, cells.heights, points, cell, tolerance, found)
    return found


@kernel
def _hold(
    rows: Indices,
    columns: Indices,
    heights: Raster,
    points: Array,
    cell: float,
    tolerance: float,
    found: NDArray[Any],
) -> None:
    for k in range(points.shape[0]):
        row, column = int(np.floor(points[k, 1] / cell)), int(np.floor(points[k, 0] / cell))
        for n in range(rows.shape[0]):
            if rows[n] == row and columns[n] == column and abs(heights[n] - points[k, 2]) <= tolerance:
                found[k] = True
                break
