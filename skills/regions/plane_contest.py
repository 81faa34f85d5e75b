"""Planes that compete for pixels: the one that the 5 x 5 window about a pixel fits best has it.

What a pixel adds to a window's misfit is capped, and counts in shares of that cap: across a depth edge the majority
wins, exactly at a straight one; along a crease the misfits of two planes cross where the planes do, and the window
averages the noise away.

Blocks of a few rows of LANES pixels lie in memory in one piece, so that each loop over them runs in vectors.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array
from skills.kernels import leaf_kernel
from skills.regions.noise_level import depth_noise

PixelLabels = NDArray[np.int16]
LANES = 12  # pixels of a row that are worked on at a time: patches of eight with their windows
RADIUS = 2  # of the window about a pixel [px]; its sums are written out for five columns and rows
_VALID_MIN = 4.5  # a window with fewer valid pixels gives no label
_SLANT_MAX = 2.0  # planes seen more edge-on than this get no more tolerance
_BARE = 0.5  # share of the cap above which no plane fits: most of the window is elsewhere


@leaf_kernel
def tolerances(limits: Array, depth: float, slant: float) -> tuple[float, float]:
    """Relative errors of depth: the cap of a pixel's, and the root mean square that puts a window at odds.

    Args:
        limits: nearest and farthest valid depth, pixel offset, noise factor and the law of the noise.
        depth: of the pixels.
        slant: how many times further off in depth a pixel is than off a plane that may be its own.
    """
    offset, factor = limits[2] * min(slant, _SLANT_MAX), limits[3]
    pixel, shared = depth_noise(limits[4:], depth, 1.0), depth_noise(limits[4:], depth, 1e12)
    spread = 1.0 + factor * np.sqrt(2.0) / (2 * RADIUS + 1)  # of a mean of squares over a window
    odd = offset * offset + spread * (pixel * pixel - shared * shared) + (factor * shared) ** 2
    return (offset + factor * pixel) / depth, np.sqrt(odd) / depth


@leaf_kernel
def load_block(
    depth: NDArray[np.float32], top: int, left: int, near: np.float32, far: np.float32, block: NDArray[np.float32]
) -> None:
    """Copy a block of depth; 0 where there is none."""
    height, width = depth.shape
    zero = np.float32(0.0)
    for i in range(block.shape[0] // LANES):
        v, first = top + i, i * LANES
        if v < 0 or v >= height:
            for j in range(LANES):
                block[first + j] = zero
        elif left >= 0 and left + LANES <= width:
            line, start, target = depth[v], np.uint64(left), np.uint64(first)
            for j in range(LANES):
                z = line[start + np.uint64(j)]
                block[target + np.uint64(j)] = z if (z >= near) & (z <= far) else zero
        else:
            for j in range(LANES):
                u = left + j
                z = depth[v, u] if u >= 0 and u < width else zero
                block[first + j] = z if (z >= near) & (z <= far) else zero


@leaf_kernel
def open_contest(
    block: NDArray[np.float32],
    costs: NDArray[np.float32],
    column_sums: NDArray[np.float32],
    valid: NDArray[np.float32],
    least: NDArray[np.float32],
    chosen: PixelLabels,
) -> None:
    """Count the valid pixels of windows, and what misfit leaves a pixel without a label; all of them where few are."""
    zero, one, bare = np.float32(0.0), np.float32(1.0), np.int16(-1)
    enough, refused, share = np.float32(_VALID_MIN), np.float32(-1.0), np.float32(_BARE)
    for k in range(block.shape[0]):
        costs[k] = one if block[k] > zero else zero
    _add_rows(costs, column_sums)
    for k in range(least.shape[0]):
        count = column_sums[k] + column_sums[k + 1] + column_sums[k + 2] + column_sums[k + 3] + column_sums[k + 4]
        valid[k] = count
        least[k] = share * count if count >= enough else refused
        chosen[k] = bare


@leaf_kernel
def compete(
    block: NDArray[np.float32],
    right: NDArray[np.float32],
    down: NDArray[np.float32],
    a: np.float32,
    b: np.float32,
    corner: np.float32,
    per_cap: np.float32,
    costs: NDArray[np.float32],
    column_sums: NDArray[np.float32],
    least: NDArray[np.float32],
    chosen: PixelLabels,
    label: int,
) -> None:
    """Give a label to the pixels whose windows its plane fits better than any before."""
    zero, one, mine = np.float32(0.0), np.float32(1.0), np.int16(label)
    for k in range(block.shape[0]):
        z = block[k]
        off = (z * (a * right[k] + b * down[k] + corner) - one) * per_cap
        square = off * off
        square = square if square < one else one
        costs[k] = square if z > zero else zero
    _add_rows(costs, column_sums)
    for k in range(least.shape[0]):
        cost = column_sums[k] + column_sums[k + 1] + column_sums[k + 2] + column_sums[k + 3] + column_sums[k + 4]
        better = cost < least[k]
        least[k] = cost if better else least[k]
        chosen[k] = mine if better else chosen[k]


@leaf_kernel
def _add_rows(costs: NDArray[np.float32], column_sums: NDArray[np.float32]) -> None:
    """Sums of five rows each."""
    for k in range(costs.shape[0] - 4 * LANES):
        column_sums[k] = (
            costs[k] + costs[k + LANES] + costs[k + 2 * LANES] + costs[k + 3 * LANES] + costs[k + 4 * LANES]
        )
