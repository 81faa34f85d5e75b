"""How much of a sole the true ground carries, counted in small cells of the sole's area."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from sim_envs.courses import Ground
from sim_envs.judge.parameters import JudgeParameters
from skills.geometry.pose import Array, Pose


@dataclass(frozen=True, slots=True)
class Support:
    """What carries a sole.

    Attributes:
        fraction: share of the sole's area with ground near it, 0 .. 1.
        boxes: names of the boxes under that area, in the order of the course.
    """

    fraction: float
    boxes: tuple[str, ...]


def sole_support(
    T_world_sole: Pose, sole_size: tuple[float, float], ground: Ground, parameters: JudgeParameters | None = None
) -> Support:
    """Measure which part of a sole rests on the ground.

    Args:
        T_world_sole: sole frame, origin at the sole's centre, z out of the ground.
        sole_size: length and width of the sole [m].
        ground: the true ground.
        parameters: how near counts, and the cell size.
    """
    limits = parameters or JudgeParameters()
    cells_world = T_world_sole @ _cells(sole_size, limits.support_cell)
    heights, normals, boxes = ground.surface(cells_world[:, :2])
    above = np.where(boxes >= 0, cells_world[:, 2] - heights, np.inf)
    # The vertical gap times the cosine of the slope is the distance to the surface.
    carried = np.abs(above) * np.where(boxes >= 0, normals[:, 2], 1.0) <= limits.support_distance
    names = tuple(ground.boxes[i].name for i in np.unique(boxes[carried]))
    return Support(float(np.mean(carried)), names)


def support_fraction(
    T_world_sole: Pose, sole_size: tuple[float, float], ground: Ground, parameters: JudgeParameters | None = None
) -> float:
    """Share of a sole's area with true ground near it, 0 .. 1; arguments as in `sole_support`."""
    return sole_support(T_world_sole, sole_size, ground, parameters).fraction


def _cells(sole_size: tuple[float, float], edge: float) -> Array:
    """Centres of equal cells of at most the given edge that fill the sole, (N, 3) in the sole frame."""
    x, y = (
        length * ((np.arange(n) + 0.5) / n - 0.5) for length, n in ((s, math.ceil(s / edge - 1e-9)) for s in sole_size)
    )
    grid_x, grid_y = np.meshgrid(x, y, indexing="ij")
    return np.column_stack((grid_x.ravel(), grid_y.ravel(), np.zeros(grid_x.size)))
