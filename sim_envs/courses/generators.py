"""Seeded courses: level ground, level blocks of several heights, and rough fields; one seed, one course."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

from sim_envs.courses.block_field import FieldParameters, box_between
from sim_envs.courses.course import Course, CourseError
from sim_envs.courses.detour import DetourParameters, detour
from sim_envs.courses.moved_blocks import MovedBlocksParameters, moved_blocks
from sim_envs.courses.rough import RoughParameters, rough
from sim_envs.courses.uneven import UnevenFieldParameters, UnevenFlatParameters, uneven_field, uneven_flat
from skills.parameters import parameter, parameters
from strict_yaml import nearest


@parameters
class FlatParameters:
    """A level slab."""

    length: float = parameter(8.0, unit="m", minimum=1.0, maximum=100.0, meaning="distance from start to goal")
    width: float = parameter(2.4, unit="m", minimum=0.6, maximum=20.0, meaning="width of the slab")


def flat(seed: int, parameters: FlatParameters) -> Course:
    """A level slab; the same for every seed."""
    del seed
    field = FieldParameters()
    before = field.pad_length - field.field_start
    slab = box_between(
        "ground",
        "pad",
        (-before, parameters.length + before),
        (-parameters.width / 2, parameters.width / 2),
        0.0,
        field,
    )
    return Course("flat", (slab,), (0.0, 0.0, 0.0), (parameters.length, 0.0, 0.0))


GENERATORS: dict[str, tuple[Callable[[int, Any], Course], type, dict[str, Any]]] = {
    "flat": (flat, FlatParameters, {}),
    "uneven_flat": (uneven_flat, UnevenFlatParameters, {}),
    "uneven_field": (uneven_field, UnevenFieldParameters, {"rows": 13, "columns": 20}),
    "rough": (rough, RoughParameters, {}),
    "rough_wide": (rough, RoughParameters, {"rows": 11, "columns": 10, "peak": 0.2, "goal_y": 1.2}),
    "moved_blocks": (moved_blocks, MovedBlocksParameters, {}),
    "detour": (detour, DetourParameters, {}),
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
