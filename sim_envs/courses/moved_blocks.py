"""The rough field, on which blocks move, appear and vanish just before the robot is there.

There are four places of two rows each, one after the other, in an order that the seed draws: at two of them all blocks
rise or sink, which no step of a biped can pass by, at one all columns but one appear, and at one a block of each row
vanishes (after the experiments of Calvert et al., 2022, in which people moved the blocks).
"""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator

import numpy as np

from sim_envs.courses.course import Box, BoxEvent, Course, CourseError
from sim_envs.courses.rough import RoughParameters, rough
from skills.geometry.pose import Pose
from skills.parameters import parameter, parameters

_KINDS = ("move", "move", "appear", "vanish")
_ROWS = 2  # of a place
_FREE = 2  # Rows before the first place, and at least as many behind each.
_LEAST_SHIFT = 0.5  # of the largest
_AWAY = np.array((0.0, 0.0, -1.0))  # Where a block is that is not there [m].
_DURATION = 0.5  # of a motion [s]


@parameters
class MovedBlocksParameters(RoughParameters):
    """How far blocks move, and how near the robot is then."""

    shift: float = parameter(0.08, unit="m", minimum=0.0, maximum=0.15, meaning="blocks rise or sink by up to this")
    distance: float = parameter(
        1.0, unit="m", minimum=0.8, maximum=2.0, meaning="the robot is this near when a block begins to move"
    )


def moved_blocks(seed: int, parameters: MovedBlocksParameters) -> Course:
    """The rough course of the same seed, with blocks that move, appear and vanish as the robot comes near."""
    course = rough(seed, parameters)
    # Other numbers than those that the blocks were drawn from.
    generator = np.random.default_rng((seed, len(_KINDS)))
    spare = parameters.rows - len(_KINDS) * (_ROWS + _FREE) - _FREE
    if spare < 0:
        raise CourseError(f"rows: got {parameters.rows}, needs at least {parameters.rows - spare} for blocks to move")
    motions: dict[str, tuple[Pose, Pose]] = {}
    row = _FREE + int(generator.integers(spare + 1))
    for kind in generator.permutation(_KINDS):
        rows = range(row, row + _ROWS)
        motions.update(_motions(str(kind), rows, course, parameters, generator))
        row += _ROWS + _FREE
    boxes = tuple(
        dataclasses.replace(box, T_world_box=motions[box.name][0]) if box.name in motions else box
        for box in course.boxes
    )
    events = tuple(
        BoxEvent(name, end, _DURATION, distance=parameters.distance) for name, (_, end) in sorted(motions.items())
    )
    return dataclasses.replace(course, boxes=boxes, events=events)


def _motions(
    kind: str, rows: range, course: Course, parameters: MovedBlocksParameters, generator: np.random.Generator
) -> Iterator[tuple[str, tuple[Pose, Pose]]]:
    """First and last pose of the boxes of some rows that move, by name."""
    sign = generator.choice((-1.0, 1.0))
    kept, gone = generator.permutation(parameters.columns)[[0, -1]]
    for row in rows:
        for column in range(parameters.columns):
            shift = sign * parameters.shift * generator.uniform(_LEAST_SHIFT, 1.0)
            for box in _boxes(course, row, column):
                here = box.T_world_box
                if kind == "move":
                    yield box.name, (here, _moved(here, np.array((0.0, 0.0, shift))))
                elif kind == "appear" and column != kept:
                    yield box.name, (_moved(here, _AWAY), here)
                elif kind == "vanish" and column == gone and column != kept:
                    yield box.name, (here, _moved(here, _AWAY))


def _boxes(course: Course, row: int, column: int) -> list[Box]:
    """The block of a cell, and the base under it where it is tilted."""
    names = {f"{kind}_r{row:02d}_c{column}" for kind in ("block", "base")}
    return [box for box in course.boxes if box.name in names]


def _moved(T_world_box: Pose, by_world: np.ndarray) -> Pose:
    return Pose(T_world_box.R, T_world_box.p + by_world)
