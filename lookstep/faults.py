"""A file of faults, put where they belong: around the robot, between nodes and leaves, and into the course's events."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from behaviors import OperatorInbox, Robot, Tree
from behaviors.faults import Fault, FaultMode, read_faults
from behaviors.faulty_inbox import FaultyInbox
from behaviors.faulty_leaf import break_leaf
from behaviors.faulty_robot import FaultyRobot
from lookstep.errors import UserError
from sim_envs.courses import BoxEvent, Course
from skills.geometry import Pose
from strict_yaml import Problem, YamlError, load_document, nearest

# A block that is off lies this far down the pit; how fast blocks move [m, s].
_AWAY = np.array((0.0, 0.0, -20.0))
_MOTION = 0.1
_SHOWN = 10  # Blocks that an error lists.


def load_faults(path: Path, course: Course) -> tuple[Fault, ...]:
    """Read a file of faults.

    Raises:
        YamlError: where it is not usable, or names a block that the course does not have.
    """
    placed = read_faults(load_document(path))
    names = [box.name for box in course.boxes]
    shown = ", ".join(names[:_SHOWN]) + (", ..." if len(names) > _SHOWN else "")
    problems = [
        Problem(
            placed_fault.location,
            f'course {course.name} has no block "{name}"{nearest(name, names)} (blocks: {shown})',
        )
        for placed_fault in placed
        if placed_fault.fault.kind == "world" and (name := placed_fault.fault.name) not in names
    ]
    if problems:
        raise YamlError(problems)
    return tuple(placed_fault.fault for placed_fault in placed)


def faulty_course(course: Course, faults: Sequence[Fault]) -> Course:
    """A course whose blocks move when their faults begin, and back when they end."""
    events = list(course.events)
    boxes = {box.name: box for box in course.boxes}
    for fault in faults:
        if fault.kind != "world":
            continue
        placed = boxes[fault.name].T_world_box
        shift = _AWAY if fault.mode is FaultMode.OFF else np.array(fault.shift)
        events.append(BoxEvent(fault.name, Pose(placed.R, placed.p + shift), _MOTION, time=fault.start))
        if np.isfinite(fault.end):
            events.append(BoxEvent(fault.name, placed, _MOTION, time=fault.end))
    return dataclasses.replace(course, events=tuple(events))


def faulty_robot(robot: Robot, faults: Sequence[Fault]) -> Robot:
    """The robot itself where none of its sensors breaks."""
    sensors = [fault for fault in faults if fault.kind.startswith("sensor:")]
    return FaultyRobot(robot, sensors) if sensors else robot


def faulty_inbox(inbox: OperatorInbox, faults: Sequence[Fault]) -> OperatorInbox:
    """The inbox itself where the operator does not break."""
    found = [fault for fault in faults if fault.kind == "operator"]
    return FaultyInbox(inbox, found) if found else inbox


def break_leaves(tree: Tree, faults: Sequence[Fault]) -> None:
    """Put faults between the nodes of a tree and their leaves.

    Raises:
        UserError: where the tree has no such leaf, or it cannot break so.
    """
    paths = {fault.at for fault in faults if fault.kind == "leaf"}
    for path in sorted(paths):
        try:
            break_leaf(tree.node(path), [fault for fault in faults if fault.at == path])
        except (LookupError, ValueError) as error:
            raise UserError(f"--faults: {error}") from error
