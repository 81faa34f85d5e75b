"""Rough fields: blocks at scattered heights on a profile that rises and falls, a share of them tilted, some missing.

A tilted block lies on a level base that closes the gaps around it.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from sim_envs.courses.block_field import FieldParameters, cell_centre, field_course, level_block, profile
from sim_envs.courses.course import Box, Course, CourseError
from skills.geometry.pose import Pose
from skills.parameters import parameter, parameters

_BASE_CLEARANCE = 0.02  # Base below the lowest edge of the tilted top [m].


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
    missing_rows: int = parameter(
        0, unit="1", minimum=0, maximum=3, meaning="whole rows left out, one behind the other"
    )
    tilted_thickness: float = parameter(
        0.192, unit="m", minimum=0.05, maximum=0.5, meaning="height of a tilted block above its base"
    )


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
    kept = [place for place in order if place not in missing]
    tilted = {place: i % 4 for i, place in enumerate(kept[: round(parameters.tilted_share * len(kept))])}
    void = _missing_rows(generator, parameters)
    blocks: list[Box] = []
    for index, (row, column) in enumerate(cells):
        if row in void or (row, column) in missing:
            continue
        height = parameters.peak * profile(row, parameters.rows) + heights[index]
        if (row, column) in tilted:
            blocks += _tilted_block(row, column, height, tilts[index], tilted[row, column], parameters)
        else:
            blocks.append(level_block(row, column, height, parameters))
    return field_course("rough", blocks, parameters)


def _missing_rows(generator: np.random.Generator, parameters: RoughParameters) -> range:
    """Rows that are left out as a whole, somewhere in the middle half of the way."""
    first, count = parameters.rows // 4, parameters.missing_rows
    middle = parameters.rows - 2 * first
    if count > middle:
        raise CourseError(f"missing_rows: got {count}, {parameters.rows} rows can lack {middle}")
    begin = first + int(generator.integers(middle - count + 1))
    return range(begin, begin + count)


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


def _tilted_block(
    row: int, column: int, height: float, tilt: float, direction: int, parameters: RoughParameters
) -> list[Box]:
    """A block turned about the centre of its top, and the level base under it.

    The base ends below the lowest edge of the tilted top, so that it closes the gaps beside the block but is no
    foothold of its own.
    """
    roll, pitch = ((tilt, 0.0), (-tilt, 0.0), (0.0, tilt), (0.0, -tilt))[direction]
    x, y = cell_centre(row, column, parameters)
    T_world_top = Pose.from_xyz_rpy((x, y, height), (roll, pitch, 0.0))
    size = (parameters.pair_length, parameters.pair_width, parameters.tilted_thickness)
    T_world_box = T_world_top @ Pose(np.eye(3), np.array((0.0, 0.0, -0.5 * size[2])))
    block = Box(f"block_r{row:02d}_c{column}", size, T_world_box, "block")
    lowest_edge = height - 0.5 * max(size[0], size[1]) * math.tan(tilt)
    return [level_block(row, column, lowest_edge - _BASE_CLEARANCE, parameters, name="base", kind="base"), block]
