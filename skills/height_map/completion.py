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
    n = window.cells
    first_row, first_column = window.row % n, window.column % n
    known = np.empty((n, n), np.float32)
    for i in range(n):
        row = first_row + i if first_row + i < n else first_row + i - n
        for j in range(n):
            column = first_column + j if first_column + j < n else first_column + j - n
            known[i, j] = ring.height[row, column]
            variances[i * n + j] = ring.variance[row, column] + growth * (time - ring.seen[row, column])
    for i in range(n):
        for j in range(n):
            cell = i * n + j
            heights[cell] = known[i, j]
            filled[cell] = False
            if not np.isnan(known[i, j]):
                heights[cell] = _without_spike(known, i, j, spike)
                counts[SPIKES] += heights[cell] != known[i, j]
            if np.isnan(heights[cell]):
                variances[cell] = np.nan
    _fill_lines(heights, variances, filled, n, n, 1, reach, step, counts)
    _fill_lines(heights, variances, filled, n, 1, n, reach, step, counts)


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
def _fill_lines(
    heights: NDArray[np.float32],
    variances: NDArray[np.float32],
    filled: NDArray[np.bool_],
    n: int,
    across: int,
    along: int,
    reach: int,
    step: float,
    counts: NDArray[np.int64],
) -> None:
    """Fill the holes of n lines, `across` cells apart, of n cells, `along` cells apart."""
    for line in range(n):
        last = -1
        for k in range(n):
            cell = line * across + k * along
            if np.isnan(heights[cell]) or filled[cell]:
                continue
            first = cell - (k - last) * along
            if last >= 0 and 1 < k - last <= 2 * reach and abs(heights[cell] - heights[first]) <= step:
                slope = (heights[cell] - heights[first]) / (k - last)
                # The line between the sides may miss what is between them by half of their difference.
                variance = max(variances[first], variances[cell]) + 0.25 * (heights[cell] - heights[first]) ** 2
                for hole in range(max(last + 1, k - reach), min(k, last + reach + 1)):
                    inner = line * across + hole * along
                    if not filled[inner]:
                        heights[inner] = heights[first] + slope * (hole - last)
                        variances[inner] = variance
                        filled[inner] = True
                        counts[FILLED] += 1
            last = k
