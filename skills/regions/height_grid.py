"""Regions on a horizontal grid, so that old and new ground can be compared cell by cell.

The grid's cells have fixed places in the world: the cells of a region are found once and hold wherever the robot goes.
"""

from __future__ import annotations

from typing import NamedTuple

import cv2
import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array
from skills.regions.planar_region import PlanarRegion

_PROBES = 32  # about how many points of a region are compared with a depth image
_SHIFT = 4  # fractional bits of polygon corners in OpenCV
_NEIGHBOURS = np.ones((3, 3), np.uint8)


class Cells(NamedTuple):
    """The cells that a region covers: indices of the window's first column and row, and by row and column the rest."""

    column: int
    row: int
    mask: NDArray[np.bool_]
    heights: Array
    probes_world: Array


class Comparison(NamedTuple):
    """Cells of a region: all, covered by newer regions, seen by the newest frame, and seen there at another height."""

    inside: int
    covered: int
    seen: int
    differing: int


def cells_of(region: PlanarRegion, cell: float) -> Cells:
    """The cells of a given edge [m] that a region covers, their heights, and points spread over it, (K, 3)."""
    T, normal = region.T_world_region, region.normal_world
    rings = [(ring @ T.R[:2, :2].T + T.p[:2]) / cell - 0.5 for ring in (region.hull_region, *region.holes_region)]
    low = np.floor(rings[0].min(axis=0)).astype(int)
    high = np.ceil(rings[0].max(axis=0)).astype(int) + 1
    mask = np.zeros((high[1] - low[1], high[0] - low[0]), np.uint8)
    contours = [np.round((ring - low) * 2**_SHIFT).astype(np.int32).reshape(-1, 1, 2) for ring in rings]
    cv2.fillPoly(mask, contours, (1,), cv2.LINE_8, _SHIFT)
    x = (np.arange(low[0], high[0]) + 0.5) * cell
    y = (np.arange(low[1], high[1]) + 0.5) * cell
    heights = T.p[2] - (normal[0] * (x[None, :] - T.p[0]) + normal[1] * (y[:, None] - T.p[1])) / normal[2]
    rows, columns = np.nonzero(mask)
    rows, columns = rows[:: len(rows) // _PROBES + 1], columns[:: len(columns) // _PROBES + 1]
    probes = np.column_stack((x[columns], y[rows], heights[rows, columns]))
    return Cells(int(low[0]), int(low[1]), mask.astype(bool), heights, probes)


class HeightGrid:
    """Heights of regions around the feet."""

    def __init__(self, middle_world: Array, radius: float, cell: float) -> None:
        self._column, self._row = (int(np.floor((value - radius) / cell)) for value in middle_world[:2])
        size = int(np.ceil(2.0 * radius / cell))
        self._height = np.full((size, size), np.nan)
        self._newest = self._height

    def freeze(self) -> None:
        """Take what was painted so far as the newest frame."""
        self._newest = self._height.copy()

    def paint(self, cells: Cells) -> None:
        """Fill in a region where nothing newer is."""
        window, mask, heights = self._window(cells)
        patch = self._height[window]
        empty = mask & np.isnan(patch)
        patch[empty] = heights[empty]

    def compare(self, cells: Cells, same_height: float) -> Comparison:
        """Hold a region against what is newer; cells next to a covered one count as covered, outlines being noisy."""
        window, mask, heights = self._window(cells)
        if not mask.any():
            return Comparison(0, 0, 0, 0)
        known = (~np.isnan(self._height[window])).view(np.uint8)
        covered = mask & cv2.dilate(known, _NEIGHBOURS).view(bool)
        newest = self._newest[window]
        # Not a number compares as false.
        same = np.abs(newest - heights) <= same_height
        seen = mask & ~np.isnan(newest)
        counts = (np.count_nonzero(flags) for flags in (mask, covered, seen, seen & ~same))
        return Comparison(*(int(count) for count in counts))

    def _window(self, cells: Cells) -> tuple[tuple[slice, slice], NDArray[np.bool_], Array]:
        """The part of the grid under a region, and the part of the region on the grid."""
        size = len(self._height)
        spans = []
        for first, count in (
            (cells.row - self._row, len(cells.mask)),
            (cells.column - self._column, cells.mask.shape[1]),
        ):
            low, high = min(max(first, 0), size), min(max(first + count, 0), size)
            spans.append((slice(low, high), slice(low - first, high - first) if high > low else slice(0, 0)))
        (rows, own_rows), (columns, own_columns) = spans
        return (rows, columns), cells.mask[own_rows, own_columns], cells.heights[own_rows, own_columns]
