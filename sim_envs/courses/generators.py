"""Seeded courses: level ground, level blocks of several heights, and rough fields of tilted blocks.

The fields follow the test courses of look-and-step (Calvert et al., 2022): block pairs in columns, row after row, on a
height profile that rises and falls. Blocks touch and fill the whole way between two pits; start and goal lie on pads
no wider than the columns. A tilted block lies on a level base that closes the gaps around it.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from sim_envs.courses.course import Box, Course, CourseError
from skills.geometry.pose import Pose
from skills.parameters import parameter, parameters
from strict_yaml import nearest

_STOCK_HEIGHTS = (0.0, 0.0884, 0.1415, 0.192)  # Bare ground and the three sizes of block [m].
_BASE_CLEARANCE = 0.02  # Base below the lowest edge of the tilted top [m].


@parameters
class FlatParameters:
    """A level slab."""

    length: float = parameter(8.0, unit="m", minimum=1.0, maximum=100.0, meaning="distance from start to goal")
    width: float = parameter(2.4, unit="m", minimum=0.6, maximum=20.0, meaning="width of the slab")


@parameters
class FieldParameters:
    """The grid of a block field and the pads before and behind it."""

    rows: int = parameter(19, unit="1", minimum=1, maximum=100, meaning="rows of block pairs along the way")
    columns: int = parameter(3, unit="1", minimum=1, maximum=20, meaning="block pairs in a row")
    pair_length: float = parameter(0.37, unit="m", minimum=0.1, maximum=1.0, meaning="block pair along the way")
    pair_width: float = parameter(0.39, unit="m", minimum=0.1, maximum=1.0, meaning="block pair across the way")
    field_start: float = parameter(0.5, unit="m", minimum=0.2, maximum=10.0, meaning="start to the first row")
    pad_length: float = parameter(1.3, unit="m", minimum=0.6, maximum=10.0, meaning="pads under start and goal")
    depth: float = parameter(0.25, unit="m", minimum=0.05, maximum=2.0, meaning="boxes reach this far below z = 0")
    goal_y: float = parameter(0.0, unit="m", minimum=-5.0, maximum=5.0, meaning="goal beside the centre line")


@parameters
class UnevenFlatParameters(FieldParameters):
    """Level blocks of the stock heights, higher in the middle of the way."""


@parameters
class RoughParameters(FieldParameters):
    """Blocks at scattered heights, some of them tilted."""

    peak: float = parameter(0.40, unit="m", minimum=0.0, maximum=1.0, meaning="height of the profile's flat top")
    height_spread: float = parameter(0.05, unit="m", minimum=0.0, maximum=0.15, meaning="block height +- this")
    tilted_share: float = parameter(0.34, unit="1", minimum=0.0, maximum=1.0, meaning="share of blocks tilted")
    tilt_minimum: float = parameter(
        math.radians(11.0), unit="rad", minimum=0.0, maximum=0.5, meaning="least tilt of a tilted block"
    )
    tilt_maximum: float = parameter(
        math.radians(18.0), unit="rad", minimum=0.0, maximum=0.5, meaning="greatest tilt of a tilted block"
    )
    missing_share: float = parameter(
        0.0, unit="1", minimum=0.0, maximum=0.30, meaning="share of blocks left out; each row keeps one"
    )
    tilted_thickness: float = parameter(
        0.192, unit="m", minimum=0.05, maximum=0.5, meaning="height of a tilted block above its base"
    )


def flat(seed: int, parameters: FlatParameters) -> Course:
    """A level slab; the same for every seed."""
    del seed
    field = FieldParameters()
    before = field.pad_length - field.field_start
    slab = _box_between(
        "ground",
        "pad",
        (-before, parameters.length + before),
        (-parameters.width / 2, parameters.width / 2),
        0.0,
        field,
    )
    return Course("flat", (slab,), (0.0, 0.0, 0.0), (parameters.length, 0.0, 0.0))


def uneven_flat(seed: int, parameters: UnevenFlatParameters) -> Course:
    """Level blocks whose heights are drawn from the stock, near a profile that rises and falls."""
    generator = np.random.default_rng(seed)
    top = len(_STOCK_HEIGHTS) - 1
    blocks = []
    for row in range(parameters.rows):
        around = top * _profile(row, parameters.rows)
        for column in range(parameters.columns):
            index = int(np.clip(round(around + generator.uniform(-1.5, 1.5)), 0, top))
            blocks.append(_level_block(row, column, _STOCK_HEIGHTS[index], parameters))
    return _field_course("uneven_flat", blocks, parameters)


def rough(seed: int, parameters: RoughParameters) -> Course:
    """Blocks on a profile that rises and falls, a share of them tilted about x or y, to either side."""
    if parameters.tilt_minimum > parameters.tilt_maximum:
        raise CourseError(
            f"tilt_minimum: got {parameters.tilt_minimum:g}, above tilt_maximum {parameters.tilt_maximum:g}"
        )
    generator = np.random.default_rng(seed)
    cells = [(row, column) for row in range(parameters.rows) for column in range(parameters.columns)]
    heights = generator.uniform(-parameters.height_spread, parameters.height_spread, len(cells))
    tilts = generator.uniform(parameters.tilt_minimum, parameters.tilt_maximum, len(cells))
    order = [cells[i] for i in generator.permutation(len(cells))]
    missing = _missing_cells(order, parameters)
    kept = [cell for cell in order if cell not in missing]
    tilted = {cell: i % 4 for i, cell in enumerate(kept[: round(parameters.tilted_share * len(kept))])}
    blocks: list[Box] = []
    for index, (row, column) in enumerate(cells):
        height = parameters.peak * _profile(row, parameters.rows) + heights[index]
        if (row, column) in tilted:
            blocks += _tilted_block(row, column, height, tilts[index], tilted[row, column], parameters)
        elif (row, column) not in missing:
            blocks.append(_level_block(row, column, height, parameters))
    return _field_course("rough", blocks, parameters)


GENERATORS: dict[str, tuple[Callable[[int, Any], Course], type, dict[str, Any]]] = {
    "flat": (flat, FlatParameters, {}),
    "uneven_flat": (uneven_flat, UnevenFlatParameters, {}),
    "rough": (rough, RoughParameters, {}),
    "rough_wide": (rough, RoughParameters, {"rows": 11, "columns": 10, "peak": 0.2, "goal_y": 1.2}),
}
"""By course name: the generator, its parameter class, and the options in which this course differs from the class."""


def generate(name: str, seed: int = 0, **options: Any) -> Course:
    """Make the course of a generator.

    Raises:
        CourseError: where the seed is negative, or an option is unknown or contradicts another.
        ParameterError: where an option's value is not allowed.
    """
    if seed < 0:
        raise CourseError(f'course "{name}": got seed {seed}, needs a whole number from 0')
    generator, parameter_class, own_options = GENERATORS[name]
    allowed = [field.name for field in dataclasses.fields(parameter_class)]
    for option in options:
        if option not in allowed:
            hint = nearest(option, allowed)
            raise CourseError(f'course "{name}" has no option "{option}"{hint} (options: {", ".join(allowed)})')
    course = generator(seed, parameter_class(**(own_options | options)))
    return dataclasses.replace(course, name=name)


def _field_course(name: str, blocks: Sequence[Box], parameters: FieldParameters) -> Course:
    """The blocks between a start pad and a goal pad as wide as the columns."""
    first, length = parameters.field_start, parameters.rows * parameters.pair_length
    half_width = parameters.columns * parameters.pair_width / 2
    across = (-half_width, half_width)
    start_pad = _box_between("start_pad", "pad", (first - parameters.pad_length, first), across, 0.0, parameters)
    end = first + length
    goal_pad = _box_between("goal_pad", "pad", (end, end + parameters.pad_length), across, 0.0, parameters)
    if abs(parameters.goal_y) > half_width:
        raise CourseError(
            f"goal_y: got {parameters.goal_y:g}, the pad reaches from {-half_width:g} to {half_width:g} m"
        )
    goal = (end + first, parameters.goal_y, 0.0)
    return Course(name, (start_pad, *blocks, goal_pad), (0.0, 0.0, 0.0), goal)


def _profile(row: int, rows: int) -> float:
    """Height of a row, 0 .. 1: up over the first 40 % of the way, level, and down over the last 40 %."""
    u = (row + 0.5) / rows
    ramp = min(1.0, min(u, 1.0 - u) / 0.4)
    return ramp * ramp * (3.0 - 2.0 * ramp)


def _missing_cells(order: Sequence[tuple[int, int]], parameters: RoughParameters) -> set[tuple[int, int]]:
    """The first cells of a random order that leave at least one block in every row."""
    wanted = round(parameters.missing_share * len(order))
    missing: set[tuple[int, int]] = set()
    left = [parameters.columns] * parameters.rows
    for row, column in order:
        if len(missing) < wanted and left[row] > 1:
            missing.add((row, column))
            left[row] -= 1
    return missing


def _cell(row: int, column: int, parameters: FieldParameters) -> tuple[float, float]:
    """Centre of a cell of the grid (x, y)."""
    x = parameters.field_start + (row + 0.5) * parameters.pair_length
    return x, (column - 0.5 * (parameters.columns - 1)) * parameters.pair_width


def _level_block(
    row: int, column: int, height: float, parameters: FieldParameters, *, name: str = "block", kind: str = "block"
) -> Box:
    """A level block that fills its cell from the depth up to a height."""
    x, y = _cell(row, column, parameters)
    half_length, half_width = 0.5 * parameters.pair_length, 0.5 * parameters.pair_width
    along, across = (x - half_length, x + half_length), (y - half_width, y + half_width)
    return _box_between(f"{name}_r{row:02d}_c{column}", kind, along, across, height, parameters)


def _tilted_block(
    row: int, column: int, height: float, tilt: float, direction: int, parameters: RoughParameters
) -> list[Box]:
    """A block turned about the centre of its top, and the level base under it.

    The base ends below the lowest edge of the tilted top, so that it closes the gaps beside the block but is no
    foothold of its own.
    """
    roll, pitch = ((tilt, 0.0), (-tilt, 0.0), (0.0, tilt), (0.0, -tilt))[direction]
    x, y = _cell(row, column, parameters)
    T_world_top = Pose.from_xyz_rpy((x, y, height), (roll, pitch, 0.0))
    size = (parameters.pair_length, parameters.pair_width, parameters.tilted_thickness)
    T_world_box = T_world_top @ Pose(np.eye(3), np.array((0.0, 0.0, -0.5 * size[2])))
    block = Box(f"block_r{row:02d}_c{column}", size, T_world_box, "block")
    lowest_edge = height - 0.5 * max(size[0], size[1]) * math.tan(tilt)
    return [_level_block(row, column, lowest_edge - _BASE_CLEARANCE, parameters, name="base", kind="base"), block]


def _box_between(
    name: str,
    kind: str,
    along: tuple[float, float],
    across: tuple[float, float],
    top: float,
    parameters: FieldParameters,
) -> Box:
    """A level box between two x, two y, the depth and a top height."""
    low = np.array((along[0], across[0], min(-parameters.depth, top - parameters.depth)))
    high = np.array((along[1], across[1], top))
    size = high - low
    return Box(name, (float(size[0]), float(size[1]), float(size[2])), Pose(np.eye(3), 0.5 * (low + high)), kind)
