"""Seeded courses of level blocks: a way over them, and a wide field with a figure-eight on which a carrot leads."""

from __future__ import annotations

import dataclasses
import math

import numpy as np

from sim_envs.courses.block_field import FieldParameters, field_course, level_block, profile
from sim_envs.courses.course import Box, CarrotWay, Course, CourseError
from skills.parameters import parameter, parameters

_STOCK_HEIGHTS = (0.0, 0.0884, 0.1415, 0.192)  # Bare ground and the three sizes of block [m].
_AROUND_EIGHT = 0.6  # Blocks around a figure-eight [m].
_EIGHT_POINTS = 73  # of each of its two circles


@parameters
class UnevenFlatParameters(FieldParameters):
    """Level blocks of the stock heights, higher in the middle of the way."""


@parameters
class UnevenFieldParameters(FieldParameters):
    """A wide field of level blocks, and a figure-eight over it on which a carrot leads the robot."""

    eight_length: float = parameter(20.0, unit="m", minimum=4.0, maximum=100.0, meaning="length of the figure-eight")
    carrot_speed: float = parameter(0.3, unit="m/s", minimum=0.01, maximum=5.0, meaning="speed of the carrot on it")


def uneven_flat(seed: int, parameters: UnevenFlatParameters) -> Course:
    """Level blocks whose heights are drawn from the stock, near a profile that rises and falls."""
    return field_course("uneven_flat", _blocks(seed, parameters), parameters)


def uneven_field(seed: int, parameters: UnevenFieldParameters) -> Course:
    """The blocks of `uneven_flat` on all sides of a figure-eight: straight on, around to the left, to the right."""
    radius = parameters.eight_length / (4.0 * math.pi)
    middle = parameters.field_start + radius + _AROUND_EIGHT
    needed = 2.0 * (2.0 * radius + _AROUND_EIGHT), 2.0 * (radius + _AROUND_EIGHT)
    sizes = parameters.columns * parameters.pair_width, parameters.rows * parameters.pair_length
    if min(size - need for size, need in zip(sizes, needed, strict=True)) < 0.0:
        raise CourseError(
            f"eight_length: got {parameters.eight_length:g}, which needs blocks {needed[0]:.1f} m across the way "
            f"(columns: {sizes[0]:.1f} m) and {needed[1]:.1f} m along it (rows: {sizes[1]:.1f} m)"
        )
    angles = np.linspace(0.0, 2.0 * math.pi, _EIGHT_POINTS)
    left = np.column_stack((middle + radius * np.sin(angles), radius - radius * np.cos(angles)))
    points = np.vstack(((0.0, 0.0), left, (left * (1.0, -1.0))[1:]))
    course = field_course("uneven_field", _blocks(seed, parameters), parameters)
    carrot = CarrotWay(points, parameters.carrot_speed)
    return dataclasses.replace(course, goal=(middle, 0.0, 0.0), carrot=carrot)


def _blocks(seed: int, parameters: FieldParameters) -> list[Box]:
    generator = np.random.default_rng(seed)
    top = len(_STOCK_HEIGHTS) - 1
    blocks = []
    for row in range(parameters.rows):
        around = top * profile(row, parameters.rows)
        for column in range(parameters.columns):
            index = int(np.clip(round(around + generator.uniform(-1.5, 1.5)), 0, top))
            blocks.append(level_block(row, column, _STOCK_HEIGHTS[index], parameters))
    return blocks
