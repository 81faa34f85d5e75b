"""From a height map to what the cost of a way looks up: layers on the lattice, made once for each map.

The lattice is tied to the world, so that it stays the same when the map moves. Each of its cells takes the heights of
the map's cells in it. A layer holds the mean ground, how good a foothold is, the slope, the distance from obstacles,
and the highest height that the body could touch.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skills.body_path.path_parameters import BodyPathParameters
from skills.footsteps.records import Records
from skills.geometry.pose import Array
from skills.height_map import HeightMap
from skills.kernels import kernel

GROUND, FOOTHOLD, SLOPE_X, SLOPE_Y, DISTANCE, AWAY, TOP = range(7)
LAYERS = 7

_LEAST_CELLS = 8  # A plane is fitted to no fewer.
_FAR = 100.0  # Distance from obstacles where there is none [m].

SCALE = np.dtype(
    [
        (name, np.float64)
        for name in (
            *("x", "y", "spacing", "cells_x", "cells_y", "resolution"),
            *("half_depth", "half_width", "ground_clearance", "half_stance", "piece"),
            *("stance_weight", "step_weight", "roll_weight", "roll_deadband", "roll_most"),
            *("incline_weight", "incline_free", "clearance_weight", "near", "far", "away_weight"),
        )
    ]
)
"""Where the layers and the map's cells lie, and the weights of the cost, for kernels.

x, y: centre of the first cell of a layer [m]; cells_x, cells_y: corner of the first cell of the map [m].
near, far: distance from obstacles at which the body touches them, and from which they cost nothing [m].
piece: a motion is looked at in pieces no longer than this [m].
"""


@dataclass(frozen=True, slots=True, eq=False)
class GroundLayers:
    """What the cost of a way looks up.

    Attributes:
        layers: (LAYERS, rows, columns): `GROUND` mean height [m]; `FOOTHOLD` 0 .. 1; `SLOPE_X` and `SLOPE_Y` of the
            ground; `DISTANCE` from the nearest obstacle [m]; `AWAY` 0 .. 1 from the path that is walked; `TOP` the
            highest height that the body could touch [m].
        cells: heights of the map, NaN where unknown, (map rows, map columns) [m].
        x, y: centre of the first cell of a layer in the world [m].
        spacing: edge of a cell of a layer [m].
        cells_x, cells_y: corner of the first cell of the map [m].
        resolution: edge of a cell of the map [m].
    """

    layers: Array
    cells: NDArray[np.float32]
    x: float
    y: float
    spacing: float
    cells_x: float
    cells_y: float
    resolution: float

    @classmethod
    def of(cls, height_map: HeightMap, parameters: BodyPathParameters) -> GroundLayers:
        """Compute the layers of a map; nothing is away from a path yet."""
        p, resolution = parameters, height_map.resolution
        group = max(1, round(p.spacing / resolution))
        spacing = group * resolution
        first = np.round(height_map.origin_world / resolution).astype(int)
        offset_x, offset_y = (int(n) for n in first % group)
        rows, columns = (
            -(-(n + o) // group) for n, o in zip(height_map.heights.shape, (offset_y, offset_x), strict=True)
        )
        layers, tops = np.zeros((LAYERS, rows, columns)), np.empty((rows, columns))
        means, counts = np.empty((rows, columns)), np.empty((rows, columns))
        _gather(height_map.heights, group, offset_x, offset_y, counts, means, tops)
        low = height_map.ground_height if np.isfinite(height_map.ground_height) else 0.0
        around = int(np.ceil(0.5 * float(np.hypot(p.body_depth, p.body_width)) / spacing)) + 1
        _fit_ground(counts, means, around, low, layers[GROUND])
        _fit_slopes(counts, means, _reach(p.slope_window, spacing), spacing, layers[SLOPE_X], layers[SLOPE_Y])
        quality = np.empty((rows, columns))
        limits = (p.height_deadband, p.height_window, np.tan(p.slope_deadband), np.tan(p.slope_most), p.unseen_quality)
        _judge_footholds(counts, means, layers[GROUND], spacing, np.array(limits), quality)
        _average(quality, _reach(p.foot_window, spacing), layers[FOOTHOLD])
        _find_obstacles(tops, layers[GROUND], around // 2, p.ground_clearance, layers[DISTANCE])
        _measure_distances(layers[DISTANCE], spacing)
        _highest(tops, around, layers[TOP])
        x, y = resolution * (first - (offset_x, offset_y)) + 0.5 * spacing
        layers.flags.writeable = False
        cells_x, cells_y = height_map.origin_world
        return cls(layers, height_map.heights, float(x), float(y), spacing, float(cells_x), float(cells_y), resolution)

    def scale(self, parameters: BodyPathParameters, nominal_incline: float) -> Records:
        """One `SCALE`; the incline from start to goal costs nothing."""
        p = parameters
        scale = np.zeros(1, SCALE)[0]
        values = {
            "x": self.x,
            "y": self.y,
            "spacing": self.spacing,
            "cells_x": self.cells_x,
            "cells_y": self.cells_y,
            "resolution": self.resolution,
            "half_depth": 0.5 * p.body_depth,
            "half_width": 0.5 * p.body_width,
            "ground_clearance": p.ground_clearance,
            "half_stance": p.half_stance,
            # The longest edge of the lattice is one piece.
            "piece": 2.3 * self.spacing,
            "stance_weight": p.stance_weight,
            "step_weight": p.step_weight,
            "roll_weight": p.roll_weight,
            "roll_deadband": np.tan(p.roll_deadband),
            "roll_most": np.tan(p.roll_most),
            "incline_weight": p.incline_weight,
            "incline_free": max(nominal_incline, 0.0) + p.incline_deadband,
            "clearance_weight": p.clearance_weight,
            "near": 0.5 * p.body_width,
            "far": 0.5 * p.body_width + p.clearance,
            "away_weight": 0.0,
        }
        for name, value in values.items():
            scale[name] = value
        return scale


def _reach(window: float, spacing: float) -> int:
    """How many cells a window reaches to each side of its middle cell."""
    return max(0, round(0.5 * window / spacing - 0.5))


@kernel
def _gather(
    heights: NDArray[np.float32], group: int, offset_x: int, offset_y: int, counts: Array, means: Array, tops: Array
) -> None:
    """Number of known cells, their mean and highest height, in each group of cells."""
    counts[:] = 0.0
    means[:] = 0.0
    tops[:] = -np.inf
    for i in range(heights.shape[0]):
        row = (i + offset_y) // group
        for j in range(heights.shape[1]):
            height = heights[i, j]
            if np.isnan(height):
                continue
            column = (j + offset_x) // group
            counts[row, column] += 1.0
            means[row, column] += height
            tops[row, column] = max(tops[row, column], height)
    for i in range(counts.shape[0]):
        for j in range(counts.shape[1]):
            if counts[i, j] > 0.0:
                means[i, j] /= counts[i, j]


@kernel
def _fit_ground(counts: Array, means: Array, around: int, low: float, ground: Array) -> None:
    """Mean height of a cell and its neighbours; where none is known, of all around; else the map's lowest ground."""
    for i in range(ground.shape[0]):
        for j in range(ground.shape[1]):
            mean = _mean_around(counts, means, i, j, 1)
            if np.isnan(mean):
                mean = _mean_around(counts, means, i, j, around)
            ground[i, j] = low if np.isnan(mean) else mean


@kernel
def _mean_around(counts: Array, means: Array, i: int, j: int, reach: int) -> float:
    total, n = 0.0, 0
    for row in range(max(i - reach, 0), min(i + reach + 1, means.shape[0])):
        for column in range(max(j - reach, 0), min(j + reach + 1, means.shape[1])):
            if counts[row, column] > 0.0:
                total += means[row, column]
                n += 1
    return total / n if n > 0 else np.nan


@kernel
def _plane(counts: Array, means: Array, i: int, j: int, reach: int) -> tuple[int, float, float]:
    """How many cells are known around one, and the slopes along x and y of their plane [m per cell]."""
    n, x, y, z, xx, yy, xy, xz, yz = 0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for row in range(max(i - reach, 0), min(i + reach + 1, means.shape[0])):
        v = float(row - i)
        for column in range(max(j - reach, 0), min(j + reach + 1, means.shape[1])):
            if counts[row, column] == 0.0:
                continue
            u, height = float(column - j), means[row, column]
            n += 1
            x += u
            y += v
            z += height
            xx += u * u
            yy += v * v
            xy += u * v
            xz += u * height
            yz += v * height
    if n == 0:
        return 0, 0.0, 0.0
    xx -= x * x / n
    yy -= y * y / n
    xy -= x * y / n
    xz -= x * z / n
    yz -= y * z / n
    determinant = xx * yy - xy * xy
    if determinant < 1e-9:
        return n, 0.0, 0.0
    return n, (yy * xz - xy * yz) / determinant, (xx * yz - xy * xz) / determinant


@kernel
def _fit_slopes(counts: Array, means: Array, reach: int, spacing: float, slope_x: Array, slope_y: Array) -> None:
    """Slopes of the least-squares planes of windows; level where too little is known."""
    for i in range(means.shape[0]):
        for j in range(means.shape[1]):
            n, a, b = _plane(counts, means, i, j, reach)
            enough = n >= _LEAST_CELLS
            slope_x[i, j] = a / spacing if enough else 0.0
            slope_y[i, j] = b / spacing if enough else 0.0


@kernel
def _judge_footholds(counts: Array, means: Array, ground: Array, spacing: float, limits: Array, quality: Array) -> None:
    """How good each cell is for a foot: near the ground's mean height, and not steep."""
    deadband, window, gentle, steep, unseen = limits
    for i in range(means.shape[0]):
        for j in range(means.shape[1]):
            if counts[i, j] == 0.0:
                quality[i, j] = unseen
                continue
            _, a, b = _plane(counts, means, i, j, 1)
            slope = np.sqrt(a * a + b * b) / spacing
            off = abs(means[i, j] - ground[i, j])
            level = 1.0 - min(max((slope - gentle) / (steep - gentle), 0.0), 1.0)
            near = 1.0 - min(max((off - deadband) / (window - deadband), 0.0), 1.0)
            quality[i, j] = level * near


@kernel
def _average(values: Array, reach: int, averages: Array) -> None:
    """Mean of a window around each cell."""
    rows, columns = values.shape
    for i in range(rows):
        for j in range(columns):
            total, n = 0.0, 0
            for row in range(max(i - reach, 0), min(i + reach + 1, rows)):
                for column in range(max(j - reach, 0), min(j + reach + 1, columns)):
                    total += values[row, column]
                    n += 1
            averages[i, j] = total / n


@kernel
def _find_obstacles(tops: Array, ground: Array, reach: int, clearance: float, obstacles: Array) -> None:
    """0 where something rises further above the lowest ground around than the body clears, else infinity."""
    rows, columns = tops.shape
    for i in range(rows):
        for j in range(columns):
            obstacles[i, j] = np.inf
            low = np.inf
            for row in range(max(i - reach, 0), min(i + reach + 1, rows)):
                for column in range(max(j - reach, 0), min(j + reach + 1, columns)):
                    low = min(low, ground[row, column])
            if tops[i, j] > low + clearance:
                obstacles[i, j] = 0.0


@kernel
def _measure_distances(distances: Array, spacing: float) -> None:
    """Exact distance from each cell to the nearest 0 [m]: parabolas along rows, then columns (Felzenszwalb, 2012)."""
    rows, columns = distances.shape
    most = (_FAR / spacing) ** 2
    line = np.empty(max(rows, columns))
    for i in range(rows):
        for j in range(columns):
            line[j] = min(distances[i, j], most)
        _lower_envelope(line[:columns], distances[i])
    for j in range(columns):
        for i in range(rows):
            line[i] = distances[i, j]
        _lower_envelope(line[:rows], distances[:, j])
    for i in range(rows):
        for j in range(columns):
            distances[i, j] = spacing * np.sqrt(distances[i, j])


@kernel
def _lower_envelope(values: Array, lowest: Array) -> None:
    """The least of (x - k)^2 + values[k] over all k, for each whole x."""
    n = len(values)
    centres, bounds = np.empty(n, np.int64), np.empty(n + 1)
    count = 0
    centres[0], bounds[0], bounds[1] = 0, -np.inf, np.inf
    for k in range(1, n):
        crossing = _crossing(values, centres[count], k)
        while crossing <= bounds[count]:
            count -= 1
            crossing = _crossing(values, centres[count], k)
        count += 1
        centres[count], bounds[count], bounds[count + 1] = k, crossing, np.inf
    count = 0
    for x in range(n):
        while bounds[count + 1] < x:
            count += 1
        lowest[x] = (x - centres[count]) ** 2 + values[centres[count]]


@kernel
def _crossing(values: Array, c: int, k: int) -> float:
    """Where the parabolas at c and k meet."""
    return ((values[k] + k * k) - (values[c] + c * c)) / (2.0 * (k - c))


@kernel
def _highest(tops: Array, reach: int, highest: Array) -> None:
    """The highest height in a square around each cell: along rows, then columns."""
    rows, columns = tops.shape
    along = np.empty((rows, columns))
    for i in range(rows):
        for j in range(columns):
            top = -np.inf
            for column in range(max(j - reach, 0), min(j + reach + 1, columns)):
                top = max(top, tops[i, column])
            along[i, j] = top
    for i in range(rows):
        for j in range(columns):
            top = -np.inf
            for row in range(max(i - reach, 0), min(i + reach + 1, rows)):
                top = max(top, along[row, j])
            highest[i, j] = top
