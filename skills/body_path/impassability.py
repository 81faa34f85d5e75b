"""What stands in the way of the body: high cells of the height map on the path ahead (after Calvert et al., 2022).

The strip that the body sweeps is looked at station by station along the path. The ground is followed from the feet on,
so that stairs and blocks on which the robot can step are no obstacle, however high they lead; what rises above the
ground around it so far that the body would meet it, is one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skills.body_path.body_path import BodyPath
from skills.footsteps.footstep import Stance
from skills.geometry.pose import Array, readonly
from skills.height_map.height_map import HeightMap
from skills.parameters import parameter, parameters


@parameters
class ImpassabilityParameters:
    """When something stands in the way of the body."""

    halts: bool = parameter(True, unit="1", meaning="halt for it")
    horizon: float = parameter(
        1.8, unit="m", meaning="way ahead along the path that must be clear", minimum=0.3, maximum=10.0
    )
    release: float = parameter(
        0.4, unit="m", meaning="way beyond the horizon that must be clear as well to go on", minimum=0.0, maximum=10.0
    )
    brake: float = parameter(
        0.8,
        unit="m",
        meaning="way ahead that must be clear of what stood there before it was seen",
        minimum=0.0,
        maximum=10.0,
    )
    near: float = parameter(0.3, unit="m", meaning="way ahead that is not looked at", minimum=0.0, maximum=1.0)
    width: float = parameter(0.6, unit="m", meaning="width of the strip that the body sweeps", minimum=0.1, maximum=2.0)
    base: float = parameter(
        0.45, unit="m", meaning="height over the ground around it from which a thing is met", minimum=0.1, maximum=2.0
    )
    top: float = parameter(
        1.9, unit="m", meaning="height over the ground above which a thing is passed under", minimum=0.1, maximum=3.0
    )
    gap: float = parameter(
        0.6, unit="m", meaning="a hollow this long along the path does not lower the ground", minimum=0.0, maximum=2.0
    )
    depth: float = parameter(
        0.3, unit="m", meaning="way along the path on which a thing lies", minimum=0.05, maximum=2.0
    )
    cells: int = parameter(4, unit="1", meaning="cells of the height map that make a thing", minimum=1, maximum=1000)
    patience: float = parameter(
        10.0,
        unit="s",
        meaning="time to wait for it to go before a way around is planned",
        minimum=0.0,
        maximum=3600.0,
    )


@dataclass(frozen=True, slots=True, eq=False)
class Obstacle:
    """Something in the way of the body.

    Attributes:
        distance: from the mid-feet along the path to where it begins [m].
        height: of its highest cell over the ground around it [m].
        points_world: its cells in the strip, (N, 3) [m].
    """

    distance: float
    height: float
    points_world: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "points_world", readonly(self.points_world, (None, 3)))

    def has_come_since(self, before: HeightMap) -> bool:
        """Whether most of its cells were seen to be lower before, by more than half of its height."""
        lower = before.nearest(self.points_world[:, :2]) < self.points_world[:, 2] - 0.5 * self.height
        return bool(np.mean(lower) > 0.5)


def find_obstacle(
    path: BodyPath,
    imminent_stance: Stance,
    height_map: HeightMap,
    parameters: ImpassabilityParameters,
    *,
    halted: bool = False,
) -> Obstacle | None:
    """The first thing that stands on the path within the horizon; None where the way is clear, as far as is known.

    Args:
        path: where the body is to go.
        imminent_stance: from where.
        height_map: what is known of the ground and of what stands on it.
        parameters: what counts.
        halted: whether the robot stands because of a thing: to go on, it needs a little more than the horizon.
    """
    p, step = parameters, height_map.resolution
    start = path.project(imminent_stance.mid_feet)
    horizon = p.horizon + (p.release if halted else 0.0)
    stations = np.arange(start + 0.5 * step, min(start + horizon, path.length), step)
    if not len(stations):
        return None
    poses = np.array([path.at(s) for s in stations])
    offsets = np.arange(-0.5 * (p.width - step), 0.5 * p.width, step)
    sideways = np.stack((-np.sin(poses[:, 2]), np.cos(poses[:, 2])), axis=-1)
    strip_world = poses[:, None, :2] + offsets[None, :, None] * sideways[:, None, :]
    heights = height_map.nearest(strip_world)
    ground = _ground(heights, float(imminent_stance.mid_feet[2]), max(round(p.gap / step), 1), p.base)
    above = heights - ground[:, None]
    high = (above > p.base) & (above < p.top)
    high[stations < start + p.near] = False
    first = _first_thing(high, max(round(p.depth / step), 1), p.cells)
    if first is None:
        return None
    rows, thing = slice(first, first + max(round(p.depth / step), 1)), np.zeros_like(high)
    thing[rows] = high[rows]
    points = np.column_stack((strip_world[thing], heights[thing]))
    return Obstacle(float(stations[first] - 0.5 * step - start), float(above[thing].max()), points)


def _ground(heights: Array, feet_height: float, window: int, base: float) -> Array:
    """Height of the ground at each station, (S,): the highest of the last few medians of what can be stepped on [m]."""
    last = [feet_height] * window
    ground = np.empty(len(heights))
    for row, cells in enumerate(heights):
        known = cells[cells <= max(last) + base]
        last = [*last[1:], float(np.median(known)) if len(known) else last[-1]]
        ground[row] = max(last)
    return ground


def _first_thing(high: NDArray[np.bool_], depth: int, cells: int) -> int | None:
    """The first station that has a high cell and enough of them from there on."""
    counts = np.concatenate(([0], np.cumsum(high.sum(axis=1))))
    for station in np.flatnonzero(high.any(axis=1)):
        if counts[min(station + depth, len(high))] - counts[station] >= cells:
            return int(station)
    return None
