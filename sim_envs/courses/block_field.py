"""A field of block pairs in columns, row after row, between a start pad and a goal pad no wider than the columns.

Blocks touch and fill the whole way between two pits (after the test courses of look-and-step, Calvert et al., 2022).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from sim_envs.courses.course import Box, Course, CourseError
from skills.geometry.pose import Pose
from skills.parameters import parameter, parameters


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


def field_course(name: str, blocks: Sequence[Box], parameters: FieldParameters) -> Course:
    """The blocks between a start pad and a goal pad as wide as the columns."""
    first, length = parameters.field_start, parameters.rows * parameters.pair_length
    half_width = parameters.columns * parameters.pair_width / 2
    across = (-half_width, half_width)
    start_pad = box_between("start_pad", "pad", (first - parameters.pad_length, first), across, 0.0, parameters)
    end = first + length
    goal_pad = box_between("goal_pad", "pad", (end, end + parameters.pad_length), across, 0.0, parameters)
    if abs(parameters.goal_y) > half_width:
        raise CourseError(
            f"goal_y: got {parameters.goal_y:g}, the pad reaches from {-half_width:g} to {half_width:g} m"
        )
    goal = (end + first, parameters.goal_y, 0.0)
    return Course(name, (start_pad, *blocks, goal_pad), (0.0, 0.0, 0.0), goal)


def profile(row: int, rows: int) -> float:
    """Height of a row, 0 .. 1: up over the first 40 % of the way, level, and down over the last 40 %."""
    u = (row + 0.5) / rows
    ramp = min(1.0, min(u, 1.0 - u) / 0.4)
    return ramp * ramp * (3.0 - 2.0 * ramp)


def cell_centre(row: int, column: int, parameters: FieldParameters) -> tuple[float, float]:
    """Centre of a cell of the grid (x, y)."""
    x = parameters.field_start + (row + 0.5) * parameters.pair_length
    return x, (column - 0.5 * (parameters.columns - 1)) * parameters.pair_width


def level_block(
    row: int, column: int, height: float, parameters: FieldParameters, *, name: str = "block", kind: str = "block"
) -> Box:
    """A level block that fills its cell from the depth up to a height."""
    x, y = cell_centre(row, column, parameters)
    half_length, half_width = 0.5 * parameters.pair_length, 0.5 * parameters.pair_width
    along, across = (x - half_length, x + half_length), (y - half_width, y + half_width)
    return box_between(f"{name}_r{row:02d}_c{column}", kind, along, across, height, parameters)


def box_between(
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
