"""From the ring to the map that others see: outliers removed, small holes filled, in rows and columns of the world.

A cell clearly above all of its neighbours takes their mean; one that stands alone is dropped. An unknown cell with data
on both sides along x, or else along y, lies on the line between them. None of this goes back into the filter.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.height_map.cell_ring import CellRing, Window
from skills.kernels import kernel

SPIKES, FILLED = range(2)

_NEIGHBOURS_TO_STAY = 2
_NEIGHBOURS_TO_MEAN = 3


@kernel
def complete(
    ring: CellRing,
    window: Window,
    time: float,
    growth: float,
    spike: float,
    reach: int,
    step: float,
    heights: NDArray[np.float32],
    variances: NDArray[np.float32],
    filled: NDArray[np.bool_],
    counts: NDArray[np.int64],
) -> None:
    """Write the map.

    Args:
        ring: what is known of the cells.
        window: the map's part of the world.
        time: now [s].
        growth: variance that a height gains while nothing confirms it [m^2/s].
        spike: a cell this far above all its neighbours is an outlier [m].
        reach: holes are filled from so many cells on both sides.
        step: they are filled where the sides differ by no more [m].
        heights: written, (rows * columns,) [m].
        variances: written, likewise [m^2].
        filled: written, likewise: cells that were holes.
        counts: cells removed and filled.
    """
    known_heights, known_variances, seen = ring.height, ring.variance, ring.seen
    n = window.cells
    first_row, first_column = window.row % n, window.column % n
    known = np.empty((n, n), np.float32)
    for i in range(n):
        row = first_row + i if first_row + i < n else first_row + i - n
        for j in range(n):
            column = first_column + j if first_column + j < n else first_column + j - n
            known[i, j] = known_heights[row, column]
            variances[i * n + j] = known_variances[row, column] + growth * (time - seen[row, column])
    last_row = np.full(n, n + 2 * reach)
    for i in range(n):
        last_column = n + 2 * reach
        for j in range(n):
            cell, height = i * n + j, known[i, j]
            heights[cell] = height
            filled[cell] = False
            # Most known cells have level neighbours on both sides; only the others are worth a closer look.
            level = 0 < j < n - 1 and known[i, j - 1] >= height - spike and known[i, j + 1] >= height - spike
            if not (level or np.isnan(height)):
                heights[cell] = _without_spike(known, i, j, spike)
                counts[SPIKES] += heights[cell] != height
            if np.isnan(heights[cell]):
                variances[cell] = np.nan
                continue
            # Holes along x are closed before those along y, because a row is done before the next one begins.
            if 1 < j - last_column <= 2 * reach:
                counts[FILLED] += _fill(heights, variances, filled, cell, j - last_column, 1, reach, step)
            if 1 < i - last_row[j] <= 2 * reach:
                counts[FILLED] += _fill(heights, variances, filled, cell, i - last_row[j], n, reach, step)
            last_column, last_row[j] = j, i


@kernel
def _without_spike(known: NDArray[np.float32], i: int, j: int, spike: float) -> float:
    """The height of a cell; that of its neighbours where it sticks out, NaN where it stands alone."""
    height = known[i, j]
    n, total, sticks_out = 0, 0.0, True
    for row in range(max(i - 1, 0), min(i + 2, len(known))):
        for column in range(max(j - 1, 0), min(j + 2, len(known))):
            other = known[row, column]
            if np.isnan(other) or (row == i and column == j):
                continue
            n += 1
            total += other
            sticks_out = sticks_out and height > other + spike
            if n >= _NEIGHBOURS_TO_STAY and not sticks_out:
                return height
    if n < _NEIGHBOURS_TO_STAY:
        return np.nan
    return total / n if sticks_out and n >= _NEIGHBOURS_TO_MEAN else height


@kernel
def _fill(
    heights: NDArray[np.float32],
    variances: NDArray[np.float32],
    filled: NDArray[np.bool_],
    last: int,
    steps: int,
    stride: int,
    reach: int,
    step: float,
) -> int:
    """Fill a hole between two known cells, `steps` cells of a `stride` apart, the second at `last`; how many cells."""
    first = last - steps * stride
    rise = heights[last] - heights[first]
    if abs(rise) > step:
        return 0
    # The line between the sides may miss what is between them by half of their difference.
    variance = max(variances[first], variances[last]) + 0.25 * rise * rise
    count = 0
    for k in range(max(1, steps - reach), min(steps, reach + 1)):
        cell = first + k * stride
        if np.isnan(heights[cell]):
            heights[cell] = heights[first] + rise * k / steps
            variances[cell] = variance
            filled[cell] = True
            count += 1
    return count
