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
from skills.kernels import kernel, leaf_kernel

Labels = NDArray[np.int16]
Indices = NDArray[np.int64]

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
        for first in range(0, columns, _STRETCH):
            last = min(first + _STRETCH, columns)
            # Most stretches hold no crack; comparing all their pixels at once is cheaper than one by one.
            if first > 0 and last - first == _STRETCH and _alike(labels, row, first):
                continue
            for column in range(first, last):
                label = labels[row, column]
                if label < 0 or passed[row, column] or (column > 0 and labels[row, column - 1] == label):
                    continue
                end, pixels = _follow(labels, row, column, passed, points, written)
                while end < 0:
                    points = _grown(points)
                    end, pixels = _follow(labels, row, column, passed, points, written)
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


@leaf_kernel
def _alike(labels: Labels, row: int, first: int) -> bool:
    """Whether the pixels of a stretch have the same label as the one before it."""
    start, before, change = np.uint64(first), labels[row, first - 1], np.int16(0)
    for k in range(_STRETCH):
        change |= labels[row, start + np.uint64(k)] ^ before
    return change == 0


@leaf_kernel
def _follow(
    labels: Labels, row: int, column: int, passed: NDArray[np.uint8], points: Array, written: int
) -> tuple[int, int]:
    """Write the loop that begins at the left of a pixel; its end, -1 without room, and the pixels that it encloses."""
    label = labels[row, column]
    x, y, out_x, out_y = column, row, -1, 0
    run, pixels = 1, 0
    while True:
        # Only the ends of a straight run of cracks are vertices.
        if run > 2:
            written -= 1
        elif written == points.shape[0]:
            return -1, 0
        points[written, 0], points[written, 1] = x + 0.5 * out_x, y + 0.5 * out_y
        written += 1
        if out_x < 0:
            passed[y, x] = 1
            pixels -= x
        elif out_x > 0:
            pixels += x + 1
        # The next crack: around the same pixel's corner, straight on, or around a concave corner.
        if not _has(labels, x + out_y, y - out_x, label):
            out_x, out_y, run = out_y, -out_x, 1
        else:
            x, y, run = x + out_y, y - out_x, run + 1
            if _has(labels, x + out_x, y + out_y, label):
                x, y = x + out_x, y + out_y
                out_x, out_y, run = -out_y, out_x, 1
        if x == column and y == row and out_x < 0:
            return written, pixels


@kernel
def _grown(rows: Any) -> Any:
    """The same rows with as many free ones behind them."""
    grown = np.empty((2 * rows.shape[0], rows.shape[1]), rows.dtype)
    for i in range(rows.shape[0]):
        for k in range(rows.shape[1]):
            grown[i, k] = rows[i, k]
    return grown


@leaf_kernel
def _has(labels: Labels, x: int, y: int, label: int) -> bool:
    """Whether a pixel is in the image and has a label."""
    return 0 <= x < labels.shape[1] and 0 <= y < labels.shape[0] and labels[y, x] == label
