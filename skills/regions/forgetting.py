"""Which old regions no longer hold, compared cell by cell with what is newer."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from skills.geometry.camera import DepthImage
from skills.geometry.pose import Array
from skills.kernels import kernel
from skills.regions.memory_parameters import MemoryParameters
from skills.regions.region_cells import Cells, Raster, Window

_PROBES = 32  # about how many points of a region are compared with a depth image
_SPARSE = 16  # rows and columns from one pixel to the next that tell whether a camera sees anything
_BLIND = 0.1  # share of an image that must have depth before its holes mean anything
REASONS = ("", "too old", "too far", "seen differently", "seen through", "covered by newer ones", "too many")
_OLD, _FAR, _CHANGED, _VANISHED, _COVERED, _MANY = range(1, 7)


def judge_regions(
    old: Cells,
    newest: Cells,
    ages: Array,
    image: DepthImage,
    window: Window,
    replaces: bool,
    parameters: MemoryParameters,
) -> NDArray[np.int64]:
    """Index of the reason to forget each old region, (R,); 0 where it holds.

    Args:
        old: cells of the old regions, the newest last.
        newest: cells of the newest frame.
        ages: of the old regions, (R,) [s].
        image: the newest frame.
        window: the surroundings that are remembered.
        replaces: whether old regions that newer ones cover may go; a frame that is not kept must replace nothing.
        parameters: limits.
    """
    reasons = np.zeros(len(ages), np.int64)
    newest_heights, newest_mask = window.paint(newest)
    gone = _seen_through(old, image, window.cell, parameters.same_height)
    limits = (
        parameters.age_max,
        parameters.same_height,
        parameters.changed_share,
        parameters.covered_share if replaces else np.inf,
        float(parameters.regions_max - len(newest.starts) + 1),
    )
    _judge(*old, ages, gone, newest_heights, newest_mask, window.row, window.column, np.array(limits), reasons)
    return reasons


@kernel
def _judge(
    rows: NDArray[Any],
    columns: NDArray[Any],
    heights: Raster,
    starts: NDArray[Any],
    ages: Array,
    gone: NDArray[Any],
    newest: Raster,
    newest_mask: Raster,
    row: int,
    column: int,
    limits: Array,
    reasons: NDArray[Any],
) -> None:
    """From the newest old region to the oldest: count its cells, judge it, and let it cover what is older still."""
    age_max, same_height, changed_share, covered_share, room = limits
    ny, nx = newest.shape
    known = newest_mask.copy()
    kept = 0
    for region in range(ages.shape[0] - 1, -1, -1):
        inside, covered, seen, differing = 0, 0, 0, 0
        for n in range(starts[region], starts[region + 1]):
            i, j = rows[n] - row, columns[n] - column
            if not (0 <= i < ny and 0 <= j < nx):
                continue
            inside += 1
            if newest_mask[i, j] > 0.0:
                seen += 1
                if abs(newest[i, j] - heights[n]) > same_height:
                    differing += 1
            # Outlines are noisy: cells next to a covered one count as covered.
            for k in range(9):
                y, x = i + k // 3 - 1, j + k % 3 - 1
                if 0 <= y < ny and 0 <= x < nx and known[y, x] > 0.0:
                    covered += 1
                    break
        if ages[region] > age_max:
            reasons[region] = _OLD
        elif inside == 0:
            reasons[region] = _FAR
        elif seen >= changed_share * inside and differing > 0.5 * seen:
            reasons[region] = _CHANGED
        elif gone[region]:
            reasons[region] = _VANISHED
        elif covered >= covered_share * inside:
            reasons[region] = _COVERED
        elif kept >= room:
            reasons[region] = _MANY
        else:
            kept += 1
            for n in range(starts[region], starts[region + 1]):
                i, j = rows[n] - row, columns[n] - column
                if 0 <= i < ny and 0 <= j < nx:
                    known[i, j] = 1.0


def _seen_through(old: Cells, image: DepthImage, cell: float, same_height: float) -> NDArray[np.bool_]:
    """For each old region, whether the newest image shows something clearly behind most of it, or nothing, (R,)."""
    counts = np.diff(old.starts)
    strides = counts // _PROBES + 1
    owner = np.repeat(np.arange(len(counts)), counts)
    picked = (np.arange(len(owner)) - old.starts[owner]) % strides[owner] == 0
    owner = owner[picked]
    camera = image.camera
    probes = Cells(old.rows[picked], old.columns[picked], old.heights[picked], old.starts)
    points = image.T_world_camera.inverse @ probes.points_world(cell)
    ahead = np.maximum(points[:, 2], camera.near)
    u = np.round(points[:, 0] / ahead * camera.fx + camera.cx).astype(int)
    v = np.round(points[:, 1] / ahead * camera.fy + camera.cy).astype(int)
    in_view = (points[:, 2] > camera.near) & (u >= 0) & (u < camera.width) & (v >= 0) & (v < camera.height)
    measured = np.where(in_view, image.depth[np.where(in_view, v, 0), np.where(in_view, u, 0)], 0.0)
    # Where the old surface is seen at a slant, its error in height shows as a larger one in depth.
    behind = in_view & (measured > points[:, 2] + 2.0 * same_height)
    if np.mean(image.depth[::_SPARSE, ::_SPARSE] > 0.0) > _BLIND:
        # A pit returns nothing where ground would.
        behind |= in_view & (measured == 0.0)
    probed, seen, gone = (
        np.bincount(owner, weights=flags, minlength=len(counts))
        for flags in (np.ones(len(owner)), behind | (measured > 0.0), behind)
    )
    return gone > np.maximum(0.6 * seen, 0.25 * probed)
