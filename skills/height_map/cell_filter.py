"""From binned returns to heights: one Kalman filter a cell, and a vote on cells whose height may be gone.

The highest returns of a cell are its measurement. One within the gate of what is known is averaged in; a higher one
replaces it, because it is an obstacle; a lower one changes nothing, because it may have hit a side, but is a vote
against the height. A cell without returns is voted against by a beam that would have hit what is there and went on.
Enough votes in a row and the cell is taken anew; where the view is blocked nobody votes.

Outliers as in the height maps of McCrory et al. ("Bipedal navigation planning over rough terrain using traversability
models", 2022); beams that go on as in the visibility cleanup of Fankhauser et al. ("Probabilistic terrain mapping for
mobile robots with uncertain localization", 2018).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from skills.geometry.pose import Array
from skills.height_map.cell_ring import CellRing, Window
from skills.kernels import kernel

NEW, CONFIRMED, REPLACED, DOUBTED, FADED = range(5)


class FilterSettings(NamedTuple):
    """What the filter takes from `HeightMapParameters`; the names are the same."""

    range_sd: float
    range_sd_per_metre: float
    angle_sd: float
    slope_sd: float
    growth: float
    surface: float
    gate: float
    votes: int
    check_every: int
    see_through: float


class Beams(NamedTuple):
    """How the beams of a lidar point, and which come back.

    Attributes:
        near, far: valid ranges [m].
        elevation_max, elevation_min: of first and last ring [rad].
        fall: slope down which every beam comes back where the ground is level.
        middle: a height in the world between feet and lidar [m].
    """

    near: float
    far: float
    elevation_max: float
    elevation_min: float
    fall: float
    middle: float


class View(NamedTuple):
    """One scan as the filter asks it.

    Attributes:
        ranges: (rings, columns) [m].
        beams: of the lidar.
        R, origin: pose of the lidar in the world, rotation and position [m].
        time: robot time [s].
        number: counts scans; decides which cells are checked.
    """

    ranges: NDArray[np.float32]
    beams: Beams
    R: Array
    origin: Array
    time: float
    number: int


@kernel
def average_tops(
    cells: NDArray[np.int32],
    heights: NDArray[np.float32],
    found: int,
    tops: NDArray[np.float32],
    surface: float,
    sums: NDArray[np.float64],
    hits: NDArray[np.int32],
) -> None:
    """Sum the returns that are at most `surface` below the highest of their cell, and count them."""
    for cell in range(len(sums)):
        sums[cell] = 0.0
        hits[cell] = 0
    for k in range(found):
        cell = cells[k]
        if heights[k] >= tops[cell] - surface:
            sums[cell] += heights[k]
            hits[cell] += 1


@kernel
def update_cells(
    ring: CellRing,
    window: Window,
    sums: NDArray[np.float64],
    hits: NDArray[np.int32],
    view: View,
    settings: FilterSettings,
    counts: NDArray[np.int64],
) -> None:
    """Update every cell of a map by one scan.

    Args:
        ring: what is known of the cells; changed.
        window: the map's part of the world.
        sums: of the highest returns of each cell, see `average_tops` [m].
        hits: how many those are.
        view: the scan.
        settings: of the filter.
        counts: filled by what became of the cells.
    """
    # Taken apart here: handing on a tuple of arrays costs more than what is done with one cell.
    heights, variances, seen, all_votes = ring.height, ring.variance, ring.seen, ring.votes
    ranges, R, origin, beams, time = view.ranges, view.R, view.origin, view.beams, view.time
    n = window.cells
    first_row, first_column = window.row % n, window.column % n
    for i in range(n):
        row = first_row + i if first_row + i < n else first_row + i - n
        dy = (window.row + i + 0.5) * window.resolution - origin[1]
        checked = (window.row + i + view.number) % settings.check_every == 0
        for j in range(n):
            column = first_column + j if first_column + j < n else first_column + j - n
            height, hit = heights[row, column], hits[row * n + column]
            known = not np.isnan(height)
            if hit == 0 and not (known and checked):
                continue
            dx = (window.column + j + 0.5) * window.resolution - origin[0]
            if hit == 0:
                if not _passed_through(ranges, R, beams, dx, dy, height, origin[2], settings.see_through):
                    continue
                z, noise, outcome, votes = np.nan, 0.0, FADED, settings.check_every
            else:
                z = sums[row * n + column] / hit
                noise = _noise(settings, window.resolution, dx, dy, z - origin[2], hit)
                predicted = variances[row, column] + settings.growth * (time - seen[row, column])
                outcome, votes = _compare(known, z - height, settings.gate * np.sqrt(predicted + noise)), 1
                if outcome == CONFIRMED:
                    gain = predicted / (predicted + noise)
                    z, noise = height + gain * (z - height), (1.0 - gain) * predicted
            if outcome == FADED:
                votes += all_votes[row, column]
                if votes < settings.votes:
                    counts[DOUBTED] += 1
                    all_votes[row, column] = votes
                    continue
            counts[outcome] += 1
            heights[row, column] = z
            variances[row, column] = noise
            seen[row, column] = time
            all_votes[row, column] = 0


@kernel
def _compare(known: bool, step: float, limit: float) -> int:
    """What a measurement means for a cell that is `step` lower."""
    if not known:
        return NEW
    if step > limit:
        return REPLACED
    return FADED if step < -limit else CONFIRMED


@kernel
def _noise(settings: FilterSettings, resolution: float, dx: float, dy: float, dz: float, hits: int) -> float:
    """Variance of the mean of returns from one cell; the lidar's tilt errs alike for all of them."""
    level = dx * dx + dy * dy
    squared = level + dz * dz
    range_sd = settings.range_sd + settings.range_sd_per_metre * np.sqrt(squared)
    radial = range_sd * range_sd / squared
    along = radial * level + resolution * resolution / 12.0
    one = radial * dz * dz + settings.slope_sd * settings.slope_sd * along
    return one / hits + settings.angle_sd * settings.angle_sd * level


@kernel
def _passed_through(
    ranges: NDArray[np.float32],
    R: Array,
    beams: Beams,
    dx: float,
    dy: float,
    height: float,
    lidar_height: float,
    depth: float,
) -> bool:
    """Whether the beam toward a point below the top of a cell went on beyond it."""
    dz = height - depth - lidar_height
    if dz > -beams.fall * np.sqrt(dx * dx + dy * dy):
        # Beams toward the horizon may not come back: what is so high is looked for lower down.
        dz = beams.middle - lidar_height
    a = R[0, 0] * dx + R[1, 0] * dy + R[2, 0] * dz
    b = R[0, 1] * dx + R[1, 1] * dy + R[2, 1] * dz
    c = R[0, 2] * dx + R[1, 2] * dy + R[2, 2] * dz
    rings, columns = ranges.shape
    spacing = (beams.elevation_max - beams.elevation_min) / max(rings - 1, 1)
    ring = int(np.floor((beams.elevation_max - np.arctan2(c, np.sqrt(a * a + b * b))) / spacing + 0.5))
    if ring < 0 or ring >= rings:
        return False
    column = int((np.pi - np.arctan2(b, a)) / (2.0 * np.pi) * columns) % columns
    measured = ranges[ring, column]
    return beams.near <= measured <= beams.far and measured > np.sqrt(dx * dx + dy * dy + dz * dz) + depth
