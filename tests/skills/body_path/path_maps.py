"""Height maps to plan body paths on, made by hand and by chance."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.height_map import HeightMap, ScanAccount

RESOLUTION = 0.05


def height_map(heights: NDArray[np.floating], origin: tuple[float, float] = (-1.0, -3.0)) -> HeightMap:
    """A map of heights, NaN where nobody has looked; rows go along y."""
    heights = heights.astype(np.float32)
    variances, filled = np.full_like(heights, 1e-4), np.zeros(heights.shape, dtype=bool)
    known = heights[~np.isnan(heights)]
    low = float(known.min()) if len(known) else float("nan")
    return HeightMap(heights, variances, filled, RESOLUTION, np.array(origin), 0.0, 0, low, ScanAccount())


def level(size_x: float = 6.0, size_y: float = 6.0) -> NDArray[np.float64]:
    """Level ground."""
    return np.zeros((round(size_y / RESOLUTION), round(size_x / RESOLUTION)))


def box(
    heights: NDArray[np.float64],
    x: tuple[float, float],
    y: tuple[float, float],
    top: float,
    origin: tuple[float, float] = (-1.0, -3.0),
) -> NDArray[np.float64]:
    """The same ground with a box on it."""
    rows, columns = (np.arange(n) for n in heights.shape)
    in_y = (origin[1] + RESOLUTION * (rows + 0.5) > y[0]) & (origin[1] + RESOLUTION * (rows + 0.5) < y[1])
    in_x = (origin[0] + RESOLUTION * (columns + 0.5) > x[0]) & (origin[0] + RESOLUTION * (columns + 0.5) < x[1])
    return np.where(in_y[:, None] & in_x[None, :], top, heights)


def random_ground(seed: int, size: float = 6.0) -> NDArray[np.float64]:
    """Slopes, steps and walls by chance, and a part that nobody has seen; free around (0, 0) and (size - 2, 0)."""
    rng = np.random.default_rng(seed)
    heights = level(size, size)
    v, u = np.mgrid[0.0 : size : heights.shape[0] * 1j, 0.0 : size : heights.shape[1] * 1j]
    for _ in range(3):
        kx, ky, phase = rng.uniform(0.5, 1.5, 3)
        heights += 0.05 * np.sin(kx * u + ky * v + 6.0 * phase)
    for top in (*rng.uniform(0.05, 0.25, 6), *rng.uniform(0.7, 1.5, 4)):
        x, y = rng.uniform(-1.0, size - 1.0), rng.uniform(-3.0, size - 3.0)
        width, depth = rng.uniform(0.2, 1.2, 2)
        if min(np.hypot(x, y), np.hypot(x - size + 2.0, y)) > 1.5:
            heights = box(heights, (x, x + width), (y, y + depth), top)
    return box(heights, (1.0, 1.8), tuple(np.sort(rng.uniform(-3.0, 3.0, 2))), np.nan)
