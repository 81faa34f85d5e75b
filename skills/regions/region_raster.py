"""Regions painted into a raster of heights, exactly in height, to the cell in outline.

Where regions of one frame overlap, the mean of their heights is taken: pixels of a riser are given in part to the tread
above and in part to the one below, and drawn on either they reach equally far beyond the edge.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array, Pose
from skills.kernels import kernel
from skills.regions.planar_region import PlanarRegion

Raster = NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class Window:
    """A part of the endless raster.

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
        """The window that holds two corners, (2,) each [m]."""
        column, row = (int(n) for n in np.floor(low / cell))
        columns, rows = (int(n) for n in np.ceil(high / cell))
        return cls(column, row, (max(rows - row, 1), max(columns - column, 1)), cell)

    @property
    def corner(self) -> Array:
        """Its corner with the smallest x and y, (2,) [m]."""
        return self.cell * np.array((self.column, self.row), dtype=np.float64)

    @property
    def middle(self) -> Array:
        """Its middle at height 0, (3,) [m]."""
        return np.append(self.corner + 0.5 * self.cell * np.array(self.shape[::-1]), 0.0)

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


def paint_regions(regions: tuple[PlanarRegion, ...], T_raster_world: Pose, window: Window) -> tuple[Raster, Raster]:
    """Heights in the raster's frame, 0 where no region is, and 1 where one is; (rows, columns) each.

    Args:
        regions: what to paint; none may be vertical.
        T_raster_world: frame of the raster: rows along y, columns along x.
        window: which part of the raster.
    """
    heights, mask = np.zeros(window.shape, np.float32), np.zeros(window.shape, np.float32)
    if not regions:
        return heights, mask
    rings, starts, owners, planes = [], [0], [], []
    for index, region in enumerate(regions):
        T = T_raster_world @ region.T_world_region
        a, b = -T.R[0, 2] / T.R[2, 2], -T.R[1, 2] / T.R[2, 2]
        xy = T.p[:2] - window.corner
        planes.append((a, b, T.p[2] - a * xy[0] - b * xy[1]))
        for ring in (region.hull_region, *region.holes_region):
            rings.append(ring @ T.R[:2, :2].T + xy)
            starts.append(starts[-1] + len(ring))
            owners.append(index)
    _paint(np.concatenate(rings), np.array(starts), np.array(owners), np.array(planes), window.cell, heights, mask)
    return heights, mask


@kernel
def _paint(
    vertices: Array,
    ring_starts: NDArray[Any],
    ring_regions: NDArray[Any],
    planes: Array,
    cell: float,
    heights: Raster,
    mask: Raster,
) -> None:
    """Scan the outlines row by row, even-odd, so that holes stay open."""
    ny, nx = mask.shape
    crossings = np.empty(vertices.shape[0] + 1)
    ring = 0
    while ring < ring_regions.shape[0]:
        region = ring_regions[ring]
        last = ring
        lowest, highest = np.inf, -np.inf
        while last < ring_regions.shape[0] and ring_regions[last] == region:
            for v in range(ring_starts[last], ring_starts[last + 1]):
                lowest, highest = min(lowest, vertices[v, 1]), max(highest, vertices[v, 1])
            last += 1
        bottom = max(0, int(np.ceil(lowest / cell - 0.5)))
        top = min(ny - 1, int(np.floor(highest / cell - 0.5)))
        for row in range(bottom, top + 1):
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
                first = max(0, int(np.ceil(max(crossings[k] / cell, -1.0) - 0.5)))
                stop = min(nx - 1, int(np.floor(min(crossings[k + 1] / cell, float(nx)) - 0.5)))
                for column in range(first, stop + 1):
                    height = planes[region, 0] * (column + 0.5) * cell + planes[region, 1] * y + planes[region, 2]
                    mask[row, column] += np.float32(1.0)
                    # A running mean: the sum of the same numbers, but it needs no second pass.
                    heights[row, column] += (np.float32(height) - heights[row, column]) / mask[row, column]
        ring = last
    for row in range(ny):
        for column in range(nx):
            mask[row, column] = min(mask[row, column], np.float32(1.0))
