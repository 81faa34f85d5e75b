"""Outlines of labelled pixels, by following the cracks between pixels.

A crack is the side of a pixel that parts it from another label. Followed with the region on their left, cracks close to
loops: counter-clockwise around a piece of the region, clockwise around a hole, as seen in a frame with y up. A piece
holds together by the sides of its pixels, not by their corners, so no loop touches itself. The outline joins the
midpoints of the cracks: an edge passes between a pixel that is in and one that is out, so midpoints are off it by half
a pixel at most, and by nothing on average.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array
from skills.kernels import kernel

Labels = NDArray[np.int16]
Indices = NDArray[np.int64]

RIGHT, BELOW, LEFT, ABOVE = range(4)
_STRETCH = 32  # pixels of a row that are looked at together [px]


@dataclass(frozen=True, slots=True, eq=False)
class Outlines:
    """Loops around the pieces of all regions and around their holes.

    Attributes:
        points: the loops' vertices, loop after loop, (N, 2) [px]; integers are the centres of pixels.
        starts: where each loop begins in `points`, and the end of the last, (L + 1,).
        labels: region of each loop, (L,).
        pixels: how many pixels each loop encloses, (L,); negative around a hole.
    """

    points: Array
    starts: Indices
    labels: Indices
    pixels: Indices


def trace_outlines(labels: Labels, pixels_min: int) -> Outlines:
    """All loops of all regions that enclose enough pixels, in the order of their uppermost cracks.

    Args:
        labels: region of each pixel, (height, width) int16; -1 for none.
        pixels_min: loops around fewer pixels are specks of noise.
    """
    return Outlines(*_trace(np.ascontiguousarray(labels), pixels_min))


@kernel
def _trace(labels: Labels, pixels_min: int) -> tuple[Array, Indices, Indices, Indices]:
    rows, columns = labels.shape
    passed = np.zeros((rows, columns), np.uint8)  # cracks on the left of pixels that a loop has followed
    points = np.empty((1 << 14, 2))
    loops = np.empty((1 << 8, 3), np.int64)
    written, count = 0, 0
    for row in range(rows):
        line = labels[row]
        for first in range(0, columns, _STRETCH):
            last = min(first + _STRETCH, columns)
            if first > 0 and last - first == _STRETCH:
                # Most stretches hold no crack; comparing all their pixels at once is cheaper than one by one.
                here, before, change = line[first:], line[first - 1 :], np.int16(0)
                for k in range(_STRETCH):
                    change |= here[k] ^ before[k]
                if change == 0:
                    continue
            for column in range(first, last):
                label = line[column]
                if label < 0 or passed[row, column] or (column > 0 and line[column - 1] == label):
                    continue
                end, pixels, points = _follow(labels, row, column, passed, points, written)
                if abs(pixels) < pixels_min:
                    continue
                if count == loops.shape[0]:
                    loops = _grown(loops)
                loops[count, 0], loops[count, 1], loops[count, 2] = end, label, pixels
                written = end
                count += 1
    starts = np.zeros(count + 1, np.int64)
    owners, enclosed = np.empty(count, np.int64), np.empty(count, np.int64)
    for k in range(count):
        starts[k + 1], owners[k], enclosed[k] = loops[k, 0], loops[k, 1], loops[k, 2]
    return points[:written], starts, owners, enclosed


@kernel
def _follow(
    labels: Labels, row: int, column: int, passed: NDArray[np.uint8], points: Array, written: int
) -> tuple[int, int, Array]:
    """Write the loop that begins at the left of a pixel; its end, the pixels it encloses, and where it was written."""
    i, j, side = row, column, LEFT
    run, pixels = 1, 0
    while True:
        # Only the ends of a straight run of cracks are vertices.
        if run > 2:
            written -= 1
        elif written + 2 > points.shape[0]:
            points = _grown(points)
        points[written, 0] = j + 0.5 * ((side == RIGHT) - (side == LEFT))
        points[written, 1] = i + 0.5 * ((side == BELOW) - (side == ABOVE))
        written += 1
        if side == LEFT:
            passed[i, j] = 1
            pixels -= j
        elif side == RIGHT:
            pixels += j + 1
        # The next crack: around the same pixel's corner, straight on, or around a concave corner.
        before = side
        turn = (side + 3) % 4
        if _open(labels, i, j, turn):
            side = turn
        else:
            i, j = i + (turn == BELOW) - (turn == ABOVE), j + (turn == RIGHT) - (turn == LEFT)
            if not _open(labels, i, j, side):
                i, j = i + (side == BELOW) - (side == ABOVE), j + (side == RIGHT) - (side == LEFT)
                side = (side + 1) % 4
        run = run + 1 if side == before else 1
        if side == LEFT and i == row and j == column:
            return written, pixels, points


@kernel
def _grown(rows: Any) -> Any:
    """The same rows with as many free ones behind them."""
    grown = np.empty((2 * rows.shape[0], rows.shape[1]), rows.dtype)
    for i in range(rows.shape[0]):
        for k in range(rows.shape[1]):
            grown[i, k] = rows[i, k]
    return grown


@kernel
def _open(labels: Labels, row: int, column: int, side: int) -> bool:
    """Whether the side of a pixel is a crack."""
    i, j = row + (side == BELOW) - (side == ABOVE), column + (side == RIGHT) - (side == LEFT)
    if i < 0 or j < 0 or i >= labels.shape[0] or j >= labels.shape[1]:
        return True
    return labels[i, j] != labels[row, column]
