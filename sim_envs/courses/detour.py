"""A winding way over rough ground between two walls, in which something stands that must be walked around.

The way goes straight, bends to one side, bends back, and goes straight on. An obstacle stands near its middle in the
bends, and leaves room to pass it on one side.
"""

from __future__ import annotations

import dataclasses
import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from sim_envs.courses.course import Box, Course
from sim_envs.courses.rough import RoughParameters, rough
from skills.geometry.pose import Pose
from skills.parameters import parameter, parameters

_WALL, _PIECE = 0.12, 0.5  # Thickness of a wall and length of one of its boxes [m].
_UNDER_WALL = 0.25  # Blocks reach so far beyond the way [m].
_BENDS = (0.2, 0.75)  # Shares of the field where the bends begin and end.
_OBSTACLE = (0.35, 0.6)  # Shares of the field between which the obstacle stands.


@parameters
class DetourParameters(RoughParameters):
    """How far the way leads aside, and what stands in it; the columns of the field follow from that."""

    peak: float = parameter(0.15, unit="m", minimum=0.0, maximum=1.0, meaning="height of the profile's flat top")
    aside: float = parameter(1.6, unit="m", minimum=0.0, maximum=2.0, meaning="the way leads so far to one side")
    way_width: float = parameter(2.4, unit="m", minimum=1.6, maximum=3.0, meaning="between the walls")
    wall_height: float = parameter(1.2, unit="m", minimum=0.5, maximum=2.0, meaning="above z = 0, also the obstacle")
    obstacle_length: float = parameter(0.4, unit="m", minimum=0.1, maximum=1.0, meaning="along x")
    obstacle_width: float = parameter(0.7, unit="m", minimum=0.1, maximum=1.2, meaning="along y")
    off_middle: float = parameter(
        0.3, unit="m", minimum=0.0, maximum=0.6, meaning="the obstacle stands so far beside the middle of the way"
    )


@dataclass(frozen=True, slots=True)
class _Middle:
    """The middle of the way: y over x, from 0 to one side between two x.

    Attributes:
        begin, end: of the bends [m].
        aside: y behind them [m].
    """

    begin: float
    end: float
    aside: float

    def y(self, x: float) -> float:
        """Where the way is [m]."""
        u = self._share(x)
        return self.aside * u * u * (3.0 - 2.0 * u)

    def slope(self, x: float) -> float:
        """How it leads aside."""
        u = self._share(x)
        return self.aside * 6.0 * u * (1.0 - u) / (self.end - self.begin)

    def _share(self, x: float) -> float:
        return min(max((x - self.begin) / (self.end - self.begin), 0.0), 1.0)


def detour(seed: int, parameters: DetourParameters) -> Course:
    """The rough blocks of a seed, as far as they lie on the way, with walls and an obstacle."""
    p, half = parameters, 0.5 * parameters.way_width
    # Other numbers than those that the blocks are drawn from.
    generator = np.random.default_rng((seed, len(_BENDS)))
    to_left, beside = (1.0 if generator.random() < 0.5 else -1.0 for _ in range(2))
    first, length = p.field_start, p.rows * p.pair_length
    last = first + length
    middle = _Middle(first + _BENDS[0] * length, first + _BENDS[1] * length, to_left * p.aside)
    columns = 2 * math.ceil((p.aside + 0.75 * p.way_width) / p.pair_width)
    blocks = [box for box in rough(seed, dataclasses.replace(p, columns=columns)).boxes if _on_way(box, middle, half)]
    ground = (-p.depth, 0.0)
    aside = middle.y(last)
    start_pad = _box("start_pad", "pad", (first - p.pad_length, first), (-half, half), ground)
    goal_pad = _box("goal_pad", "pad", (last, last + p.pad_length), (aside - half, aside + half), ground)
    x = first + generator.uniform(*_OBSTACLE) * length
    y = middle.y(x) + beside * p.off_middle
    along, across, high = 0.5 * p.obstacle_length, 0.5 * p.obstacle_width, (-p.depth, p.wall_height)
    obstacle = _box("obstacle", "wall", (x - along, x + along), (y - across, y + across), high)
    walls = _walls(p, middle, first - p.pad_length, last + p.pad_length)
    boxes = (start_pad, *blocks, goal_pad, obstacle, *walls)
    return Course("detour", boxes, (0.0, 0.0, 0.0), (last + first, aside, 0.0))


def _on_way(box: Box, middle: _Middle, half: float) -> bool:
    """Whether a block lies between the walls, or under one of them."""
    x, y, _ = box.T_world_box.p
    off = abs(y - middle.y(x)) / math.hypot(1.0, middle.slope(x))
    return box.kind != "pad" and off < half + _UNDER_WALL


def _walls(p: DetourParameters, middle: _Middle, begin: float, end: float) -> Iterator[Box]:
    """Boxes along both sides of the way, each overlapping the next."""
    count = math.ceil((end - begin) / _PIECE)
    for side, name in ((1.0, "left"), (-1.0, "right")):
        corners = []
        for x in np.linspace(begin, end, count + 1):
            slope = middle.slope(x)
            off = side * 0.5 * (p.way_width + _WALL) / math.hypot(1.0, slope)
            corners.append(np.array((x - slope * off, middle.y(x) + off)))
        for index, (a, b) in enumerate(itertools.pairwise(corners)):
            size = (float(np.hypot(*(b - a))) + _WALL, _WALL, p.wall_height + p.depth)
            centre = (*(0.5 * (a + b)), 0.5 * (p.wall_height - p.depth))
            yaw = math.atan2(*(b - a)[::-1])
            yield Box(f"{name}_wall_{index:02d}", size, Pose.from_xyz_rpy(centre, (0.0, 0.0, yaw)), "wall")


def _box(
    name: str, kind: str, along: tuple[float, float], across: tuple[float, float], height: tuple[float, float]
) -> Box:
    """A box between two x, two y and two heights."""
    low, high = (np.array(corner) for corner in zip(along, across, height, strict=True))
    size = high - low
    return Box(name, (float(size[0]), float(size[1]), float(size[2])), Pose(np.eye(3), 0.5 * (low + high)), kind)
