"""Fill polygons on a grid by the centres of its cells: an exact scan line, unlike drawing, which adds the outline."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array


def fill(rings: Sequence[Array], shape: tuple[int, int]) -> tuple[NDArray[np.bool_], int, int]:
    """The cells whose centres lie inside polygons, holes cut out by the even-odd rule.

    Args:
        rings: outlines and holes, each (N, 2) as (column, row); integers are centres of cells.
        shape: rows and columns of the grid.

    Returns:
        A window of the grid, (height, width) bool, and its first row and column.
    """
    start = np.concatenate(rings)
    end = np.concatenate([np.roll(ring, -1, axis=0) for ring in rings])
    low = np.clip(np.floor(start.min(axis=0)), 0, (shape[1], shape[0])).astype(int)
    high = np.clip(np.ceil(start.max(axis=0)) + 1, low, (shape[1], shape[0])).astype(int)
    width, height = high - low
    # Rows whose centre an edge crosses: from the first at or below its upper end to the last above its lower end.
    upper, lower = np.minimum(start[:, 1], end[:, 1]), np.maximum(start[:, 1], end[:, 1])
    first = np.clip(np.ceil(upper), low[1], high[1]).astype(int)
    count = np.clip(np.ceil(lower), low[1], high[1]).astype(int) - first
    edge = np.repeat(np.arange(len(start)), count)
    row = np.arange(len(edge)) - np.repeat(np.cumsum(count) - count, count) + first[edge]
    share = (row - start[edge, 1]) / (end[edge, 1] - start[edge, 1])
    crossing = start[edge, 0] + share * (end[edge, 0] - start[edge, 0])
    # Every centre from a crossing on changes sides.
    column = np.clip(np.ceil(crossing), low[0], high[0]).astype(int) - low[0]
    changes = np.bincount((row - low[1]) * (width + 1) + column, minlength=height * (width + 1))
    sides = np.cumsum(changes.reshape(height, width + 1).astype(np.uint8), axis=1, dtype=np.uint8)
    return (sides[:, :width] & 1).astype(np.bool_), int(low[1]), int(low[0])
