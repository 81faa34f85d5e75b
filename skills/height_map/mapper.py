"""From lidar scans to a height map that follows the robot.

The map lies between the robot and its goal. Each scan is sorted into cells, each cell is filtered over time, and what
comes out is cleaned for those who read it. What the filter knows stays in a ring buffer, where nothing moves when the
map does.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skills.geometry.lidar import LidarScan
from skills.geometry.pose import Array
from skills.height_map.cell_filter import Beams, FilterSettings, View, average_tops, update_cells
from skills.height_map.cell_ring import Window, empty_ring, scroll
from skills.height_map.completion import complete
from skills.height_map.height_map import HeightMap, ScanAccount
from skills.height_map.parameters import HeightMapParameters
from skills.height_map.scan_binning import beam_directions, bin_returns, capsule_table


class HeightMapper:
    """Fuses each new scan with those before."""

    def __init__(self, parameters: HeightMapParameters | None = None) -> None:
        self.parameters = parameters or HeightMapParameters()
        self._settings = FilterSettings(*(getattr(self.parameters, name) for name in FilterSettings._fields))
        self._cells = round(self.parameters.size / self.parameters.resolution)
        self._ring = empty_ring(self._cells)
        self._window: Window | None = None
        self._scans = 0
        # Where each scan is sorted; kept because new memory costs more than the sorting.
        self._tops = np.empty(self._cells**2, np.float32)
        self._sums, self._hits = np.empty(self._cells**2), np.empty(self._cells**2, np.int32)
        self._in_cell, self._heights = np.empty(0, np.int32), np.empty(0, np.float32)

    def update(self, scan: LidarScan, feet_world: ArrayLike, goal_world: ArrayLike | None = None) -> HeightMap:
        """The map as known now.

        Args:
            scan: the newest scan.
            feet_world: the middle between the feet, (3,) [m].
            goal_world: where the robot walks to, (2,) or more [m]; None where it has no goal.
        """
        feet = np.asarray(feet_world, dtype=np.float64)
        goal = feet if goal_world is None else np.asarray(goal_world, dtype=np.float64)
        window = self._follow(feet[:2], goal[:2])
        of_returns, of_cells = np.zeros(4, np.int64), np.zeros(5, np.int64)
        found = self._sort(scan, window, float(feet[2]) + self.parameters.ceiling, of_returns)
        average_tops(self._in_cell, self._heights, found, self._tops, self.parameters.surface, self._sums, self._hits)
        view = self._view(scan, float(feet[2]))
        update_cells(self._ring, window, self._sums, self._hits, view, self._settings, of_cells)
        self._scans += 1
        return self._completed(scan, window, [*of_returns, *of_cells])

    def _follow(self, feet: Array, goal: Array) -> Window:
        """Move the map between feet and goal, but with the feet well inside; cells that leave are forgotten."""
        p, cells = self.parameters, self._cells
        away = max(0.5 * p.size - p.border, 0.0)
        middle = feet + np.clip(0.5 * (goal - feet), -away, away)
        column, row = np.round(middle / p.resolution - 0.5 * cells).astype(int)
        window = Window(int(row), int(column), cells, p.resolution)
        if self._window is not None:
            scroll(self._ring, self._window, window)
        self._window = window
        return window

    def _sort(self, scan: LidarScan, window: Window, ceiling: float, counts: NDArray[np.int64]) -> int:
        """Put the returns of a scan into cells; how many count."""
        lidar = scan.lidar
        if len(self._in_cell) < scan.ranges.size:
            self._in_cell, self._heights = np.empty(scan.ranges.size, np.int32), np.empty(scan.ranges.size, np.float32)
        return bin_returns(
            scan.ranges,
            lidar.near,
            lidar.far,
            np.cos(lidar.elevations),
            beam_directions(scan),
            scan.T_world_lidar.p,
            window,
            ceiling,
            capsule_table(scan, self.parameters.body_margin),
            self._in_cell,
            self._heights,
            self._tops,
            counts,
        )

    def _view(self, scan: LidarScan, feet_height: float) -> View:
        lidar, T = scan.lidar, scan.T_world_lidar
        above_feet = max(float(T.p[2]) - feet_height, 0.0)
        beams = Beams(
            lidar.near,
            lidar.far,
            lidar.elevation_max,
            lidar.elevation_min,
            # Down this slope a beam is back within half of the lidar's range.
            fall=2.0 * above_feet / lidar.far,
            middle=feet_height + 0.5 * above_feet,
        )
        return View(scan.ranges, beams, T.R, T.p, scan.time, self._scans)

    def _completed(self, scan: LidarScan, window: Window, counts: list[np.int64]) -> HeightMap:
        """What the filter knows, without outliers and small holes."""
        p, shape = self.parameters, (self._cells, self._cells)
        heights, variances = np.empty(shape, np.float32), np.empty(shape, np.float32)
        filled, of_map = np.empty(shape, np.bool_), np.zeros(2, np.int64)
        flat = heights.reshape(-1), variances.reshape(-1), filled.reshape(-1)
        complete(self._ring, window, scan.time, p.growth, p.spike, p.fill_reach, p.fill_step, *flat, of_map)
        return HeightMap(
            heights=heights,
            variances=variances,
            filled=filled,
            resolution=p.resolution,
            origin_world=p.resolution * np.array((window.column, window.row), dtype=np.float64),
            time=scan.time,
            scan_id=scan.scan_id,
            ground_height=_ground_height(heights, p.ground_low, p.ground_high),
            account=ScanAccount(*(int(count) for count in (*counts, *of_map))),
        )


def _ground_height(heights: NDArray[np.float32], low: float, high: float) -> float:
    """Mean of the heights between two of their quantiles; NaN where none is known."""
    sample = heights[::2, ::2]  # Every other cell along both axes says as much and takes a quarter of the time.
    known = np.sort(sample[~np.isnan(sample)])
    if len(known) == 0:
        return float("nan")
    first = int(low * (len(known) - 1))
    last = max(int(high * (len(known) - 1)), first)
    return float(known[first : last + 1].mean(dtype=np.float64))
