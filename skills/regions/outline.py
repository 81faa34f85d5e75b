"""Outlines of labelled pixels, by following the cracks between pixels.

A crack is the side of a pixel that parts it from another label. Followed with the region on its left, cracks close to
loops: counter-clockwise around a piece of the region, clockwise around a hole, as seen in a frame with y up. Their
midpoints are the outline, which halves the staircase of the pixel grid.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array
from skills.kernels import kernel

Labels = NDArray[np.int16]


def trace_outlines(labels: Labels) -> list[tuple[int, Array]]:
    """All loops of all regions.

    Args:
        labels: region of each pixel, (height, width) int16; -1 for none.

    Returns:
        (region, loop) pairs; a loop is (N, 2), (column, row) where integers are corners of pixels.
    """
    points, ends, owners = _trace(labels)
    starts = [0, *ends.tolist()]
    return [(owner, points[starts[k] : starts[k + 1]]) for k, owner in enumerate(owners.tolist())]


@kernel
def _trace(labels: Labels) -> tuple[Array, NDArray[np.int64], NDArray[np.int64]]:
    rows, columns = labels.shape
    # Directions of travel: 0 right, 1 down, 2 left, 3 up (rows grow downwards); the region is on the left.
    visited = np.zeros((rows, columns), np.uint8)
    cracks = 0
    for row in range(rows):
        for column in range(columns):
            if labels[row, column] >= 0:
                for side in range(4):
                    cracks += _open(labels, row, column, side)
    points = np.empty((cracks, 2))
    ends = np.empty(cracks + 1, np.int64)
    owners = np.empty(cracks + 1, np.int64)
    written, loops = 0, 0
    for row in range(rows):
        for column in range(columns):
            if labels[row, column] < 0 or visited[row, column] & 4 or not _open(labels, row, column, 2):
                continue
            i, j, side = row, column, 2
            while not visited[i, j] & (1 << side):
                visited[i, j] |= np.uint8(1 << side)
                points[written, 0] = j + 0.5 + 0.5 * ((side == 0) - (side == 2))
                points[written, 1] = i + 0.5 + 0.5 * ((side == 1) - (side == 3))
                written += 1
                # Next crack along the loop: around the same pixel's corner, straight on, or around a concave corner.
                turn = (side + 3) % 4
                if _open(labels, i, j, turn):
                    side = turn
                    continue
                i, j = i + (turn == 1) - (turn == 3), j + (turn == 0) - (turn == 2)
                if not _open(labels, i, j, side):
                    i, j = i + (side == 1) - (side == 3), j + (side == 0) - (side == 2)
                    side = (side + 1) % 4
            ends[loops] = written
            owners[loops] = labels[row, column]
            loops += 1
    return points[:written], ends[:loops], owners[:loops]


@kernel
def _open(labels: Labels, row: int, column: int, side: int) -> bool:
    """Whether the side of a pixel (0 right, 1 below, 2 left, 3 above) is a crack."""
    i, j = row + (side == 1) - (side == 3), column + (side == 0) - (side == 2)
    if i < 0 or j < 0 or i >= labels.shape[0] or j >= labels.shape[1]:
        return True
    return labels[i, j] != labels[row, column]
