"""Maps of 10 x 10 m by chance: hilly ground, a field of blocks, walls and posts to walk around, and what nobody saw."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skills.body_path import Goal
from skills.geometry.pose import Array
from skills.height_map import HeightMap, ScanAccount

SIZE, RESOLUTION = 10.0, 0.05
_CLEAR = 0.9  # Nothing stands so near to start and goal [m].
_NOISE = 0.01  # Standard deviation of a height [m].
_LOST = 0.05  # Share of cells that nobody has seen.


@dataclass(frozen=True, slots=True, eq=False)
class RandomMap:
    """A map, and what really stands on it.

    Attributes:
        height_map: what is known.
        start: (3,) x, y [m] and heading [rad].
        goal: on the other side.
        obstacles: (N, 4, 2) corners of walls and posts, in order [m].
    """

    height_map: HeightMap
    start: Array
    goal: Goal
    obstacles: Array


def random_map(seed: int) -> RandomMap:
    """The map of a seed."""
    rng = np.random.default_rng(seed)
    start = np.array((0.8, rng.uniform(1.5, SIZE - 1.5), 0.0))
    goal = Goal(SIZE - 0.8, float(rng.uniform(1.5, SIZE - 1.5)), 0.0)
    centres = RESOLUTION * (np.arange(round(SIZE / RESOLUTION)) + 0.5)
    x, y = (np.asarray(grid, dtype=np.float64) for grid in np.meshgrid(centres, centres))
    heights = _ground(rng, x, y)
    obstacles = []
    while len(obstacles) < 14:
        size = (rng.uniform(1.0, 3.5), 0.15) if len(obstacles) < 8 else rng.uniform(0.3, 0.9, 2)
        corners = _rectangle(rng.uniform(0.5, SIZE - 0.5, 2), np.array(size), rng.uniform(0.0, np.pi))
        if min(_distance(corners, start[:2]), _distance(corners, np.array((goal.x, goal.y)))) > _CLEAR:
            obstacles.append(corners)
    heights += rng.normal(0.0, _NOISE, heights.shape)
    shadow = _rectangle(rng.uniform(2.0, SIZE - 2.0, 2), rng.uniform(0.5, 1.5, 2), rng.uniform(0.0, np.pi))
    low = heights.min()
    heights[_inside(shadow, x, y)] = np.nan
    for corners in obstacles:
        # They are seen, but for single cells: nobody is blamed for walking into what he cannot know.
        heights[_inside(corners, x, y)] = low + rng.uniform(1.0, 2.0)
    heights[rng.random(heights.shape) < _LOST] = np.nan
    return RandomMap(_height_map(heights), start, goal, np.array(obstacles))


def _ground(rng: np.random.Generator, x: Array, y: Array) -> Array:
    """Waves of 10 cm, and blocks of 0.4 m in a part of the map whose heights and slopes differ."""
    heights = np.zeros_like(x)
    for _ in range(4):
        kx, ky, phase = rng.uniform(-1.0, 1.0, 3)
        heights += 0.05 * np.sin(kx * x + ky * y + 6.0 * phase)
    columns, rows = (x / 0.4).astype(int), (y / 0.4).astype(int)
    count = int(SIZE / 0.4)
    raised, slope_x, slope_y = rng.uniform(-0.12, 0.12, (count, count)), *rng.uniform(-0.3, 0.3, (2, count, count))
    field = _inside(_rectangle(rng.uniform(2.5, 7.5, 2), rng.uniform(2.0, 5.0, 2), rng.uniform(0.0, np.pi)), x, y)
    within = (x % 0.4 - 0.2) * slope_x[rows, columns] + (y % 0.4 - 0.2) * slope_y[rows, columns]
    return heights + np.where(field, raised[rows, columns] + within, 0.0)


def _rectangle(middle: Array, size: Array, yaw: float) -> Array:
    """Corners (4, 2)."""
    corners = 0.5 * size * ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))
    cos, sin = np.cos(yaw), np.sin(yaw)
    return middle + corners @ np.array(((cos, sin), (-sin, cos)))


def _inside(corners: Array, x: Array, y: Array) -> NDArray[np.bool_]:
    """Which points lie in a rectangle."""
    inside = np.ones(x.shape, dtype=bool)
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        inside &= (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]) >= 0.0
    return inside


def _distance(corners: Array, point: Array) -> float:
    """From a point outside of a rectangle to it."""
    ends = np.roll(corners, -1, axis=0) - corners
    along = np.clip(((point - corners) * ends).sum(axis=1) / (ends**2).sum(axis=1), 0.0, 1.0)
    return float(np.linalg.norm(corners + along[:, None] * ends - point, axis=1).min())


def _height_map(heights: Array) -> HeightMap:
    known = heights.astype(np.float32)
    low = float(np.nanpercentile(heights, 4.0))
    filled = np.zeros(known.shape, dtype=bool)
    variances = np.full_like(known, _NOISE**2)
    return HeightMap(known, variances, filled, RESOLUTION, np.zeros(2), 0.0, 0, low, ScanAccount())
