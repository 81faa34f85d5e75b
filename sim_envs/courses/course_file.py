"""A course written in YAML: objects by type or size, start, goal and scripted events (docs/courses.md).

The dataclasses below are the format; a course may also begin with the boxes of a generator and move some of them.
"""

from __future__ import annotations

import dataclasses
import math
import re
from dataclasses import dataclass, field

import numpy as np

from sim_envs.courses.course import Box, BoxEvent, Course, CourseError
from sim_envs.courses.generators import GENERATORS, generate
from sim_envs.courses.ground import Ground
from sim_envs.courses.stock import STOCK
from skills.geometry.pose import Array, Pose, rotation_x, rotation_y, rotation_z
from strict_yaml import Kind, Node, Problem, YamlError, nearest, read_dataclass

MAXIMUM_BOXES = 2000

_NAME = re.compile(r"[A-Za-z0-9_-]+")
_Vector = tuple[float, float, float]

_METRES = {"unit": "m", "minimum": -1000.0, "maximum": 1000.0}
_POSITIVE_METRES = {"unit": "m", "minimum": 0.001, "maximum": 1000.0}
_DEGREES = {"unit": "deg", "minimum": -360.0, "maximum": 360.0}
_SECONDS = {"unit": "s", "minimum": 0.0, "maximum": 1000.0}


@dataclass(frozen=True, slots=True)
class _Repeat:
    count: int = field(metadata={"minimum": 1, "maximum": MAXIMUM_BOXES})
    offset: _Vector = field(metadata=_METRES)


@dataclass(frozen=True, slots=True)
class _Object:
    type: str | None = field(default=None, metadata={"choices": tuple(STOCK)})
    size: _Vector | None = field(default=None, metadata=_POSITIVE_METRES)
    position: _Vector | None = field(default=None, metadata=_METRES)
    top: _Vector | None = field(default=None, metadata=_METRES)
    rpy_deg: _Vector | None = field(default=None, metadata=_DEGREES)
    yaw_deg: float | None = field(default=None, metadata=_DEGREES)
    name: str | None = None
    repeat: tuple[_Repeat, ...] = ()


@dataclass(frozen=True, slots=True)
class _Place:
    x: float = field(metadata=_METRES)
    y: float = field(metadata=_METRES)
    yaw_deg: float = field(default=0.0, metadata=_DEGREES)


@dataclass(frozen=True, slots=True)
class _Event:
    box: str
    distance: float | None = field(default=None, metadata=_POSITIVE_METRES)
    time: float | None = field(default=None, metadata=_SECONDS)
    after: float | None = field(default=None, metadata=_SECONDS)
    duration: float = field(default=0.5, metadata=_SECONDS)
    move_by: _Vector = field(default=(0.0, 0.0, 0.0), metadata=_METRES)
    turn_by_deg: _Vector = field(default=(0.0, 0.0, 0.0), metadata=_DEGREES)


@dataclass(frozen=True, slots=True)
class _File:
    start: _Place | None = None
    goal: _Place | None = None
    generator: Node | None = None
    objects: tuple[Node, ...] = ()
    events: tuple[Node, ...] = ()


def read_course(root: Node, name: str, seed: int = 0) -> Course:
    """Read a course from the root of its YAML document; the seed goes to its generator, where it has one.

    Raises:
        YamlError: holds every problem found.
    """
    problems: list[Problem] = []
    file = read_dataclass(root, _File, problems)
    if file is None:
        raise YamlError(problems)
    base = None if file.generator is None else _generate(file.generator, seed, problems)
    boxes = {} if base is None else {box.name: box for box in base.boxes}
    for index, node in enumerate(file.objects):
        _add_object(node, f"objects[{index}]", boxes, problems)
    start = _place(file.start, base and base.start, "start", root, problems)
    goal = _place(file.goal, base and base.goal, "goal", root, problems)
    # Events and places are checked against the boxes only where these are all read.
    if problems:
        raise YamlError(problems)
    poses = {box.name: box.T_world_box for box in boxes.values()}
    moved: set[str] = set()
    events = [_read_event(node, f"events[{i}]", poses, moved, problems) for i, node in enumerate(file.events)]
    _check_ground(tuple(boxes.values()), {"start": start, "goal": goal}, root, problems)
    if problems:
        raise YamlError(problems)
    return Course(name, tuple(boxes.values()), start, goal, tuple(event for event in events if event is not None))


def _generate(node: Node, seed: int, problems: list[Problem]) -> Course | None:
    """The course of `generator: {name: rough, <option>: <value>}`."""
    name = node.get("name")
    if node.kind is not Kind.MAPPING or name is None:
        problems.append(Problem(node.location, 'needs a mapping with the key "name"', "generator"))
        return None
    if not isinstance(name.value, str) or name.value not in GENERATORS:
        hint = nearest(str(name.value), GENERATORS)
        message = f"got {name.describe()}{hint} (generators: {', '.join(GENERATORS)})"
        problems.append(Problem(name.location, message, "generator.name"))
        return None
    options = dataclasses.replace(node, entries=tuple(entry for entry in node.entries if entry.key != "name"))
    parameters = read_dataclass(options, GENERATORS[name.value][1], problems, "generator")
    if parameters is None:
        return None
    try:
        return generate(name.value, seed, **{key: getattr(parameters, key) for key in options.keys})
    except CourseError as error:
        problems.append(Problem(node.location, str(error), "generator"))
        return None


def _add_object(node: Node, path: str, boxes: dict[str, Box], problems: list[Problem]) -> None:
    """Add the boxes of one entry of `objects`, repeated as it says."""
    thing = read_dataclass(node, _Object, problems, path)
    if thing is None:
        return
    refusals = [
        "" if (thing.type is None) != (thing.size is None) else 'needs either "type" or "size"',
        "" if (thing.position is None) != (thing.top is None) else 'needs either "position" or "top"',
        "" if thing.rpy_deg is None or thing.yaw_deg is None else 'takes "rpy_deg" or "yaw_deg", not both',
    ]
    problems += [Problem(node.location, refusal, path) for refusal in refusals if refusal]
    if any(refusals):
        return
    size = STOCK[thing.type] if thing.type is not None else thing.size
    corner = thing.position if thing.position is not None else thing.top
    assert size is not None and corner is not None
    raised = 0.0 if thing.top is None else -0.5 * size[2]
    rpy = thing.rpy_deg if thing.rpy_deg is not None else (0.0, 0.0, thing.yaw_deg or 0.0)
    offsets = _offsets(thing.repeat)
    if len(boxes) + math.prod(repeat.count for repeat in thing.repeat) > MAXIMUM_BOXES:
        problems.append(Problem(node.location, f"more than {MAXIMUM_BOXES} boxes", path))
        return
    kind = thing.type or "box"
    if thing.name is not None and not _NAME.fullmatch(thing.name):
        place = node.get("name") or node
        problems.append(
            Problem(place.location, f'got "{thing.name}", allowed: letters, digits, _ and -', f"{path}.name")
        )
        return
    stem = thing.name or f"{kind}_{path.partition('[')[2].rstrip(']')}"
    for index, offset in enumerate(offsets):
        name = f"{stem}_{index}" if thing.repeat else stem
        T_world_corner = Pose.from_xyz_rpy(np.add(corner, offset), np.radians(rpy))
        T_world_box = T_world_corner @ Pose(np.eye(3), np.array((0.0, 0.0, raised)))
        if name in boxes:
            problems.append(Problem(node.location, f'the name "{name}" is taken by another box', path))
            return
        boxes[name] = Box(name, size, T_world_box, kind)


def _offsets(repeats: tuple[_Repeat, ...]) -> list[Array]:
    """Displacements of the copies of an object; the first repeat varies slowest."""
    offsets = [np.zeros(3)]
    for repeat in repeats:
        offsets = [offset + k * np.array(repeat.offset) for offset in offsets for k in range(repeat.count)]
    return offsets


def _read_event(
    node: Node, path: str, poses: dict[str, Pose], moved: set[str], problems: list[Problem]
) -> BoxEvent | None:
    """One entry of `events`; `poses` holds where the events before it leave each box, `moved` which they move."""
    event = read_dataclass(node, _Event, problems, path)
    if event is None:
        return None
    if sum(when is not None for when in (event.distance, event.time, event.after)) != 1:
        problems.append(Problem(node.location, 'needs one of "distance", "time" and "after"', path))
        return None
    if event.box not in poses:
        place = node.get("box")
        message = f'no box "{event.box}"{nearest(event.box, poses)}'
        problems.append(Problem(place.location if place else node.location, message, f"{path}.box"))
        return None
    if event.after is not None and event.box not in moved:
        problems.append(Problem(node.location, f'no event before it moves "{event.box}", after which it could', path))
    moved.add(event.box)
    before = poses[event.box]
    roll, pitch, yaw = np.radians(event.turn_by_deg)
    turned = rotation_z(yaw) @ rotation_y(pitch) @ rotation_x(roll) @ before.R
    poses[event.box] = Pose(turned, before.p + np.array(event.move_by))
    when = {"time": event.time, "distance": event.distance, "after": event.after}
    return BoxEvent(event.box, poses[event.box], event.duration, **when)


def _place(
    place: _Place | None, given: tuple[float, float, float] | None, key: str, root: Node, problems: list[Problem]
) -> tuple[float, float, float]:
    """Start or goal as the file says, or as its generator has it."""
    if place is not None:
        return (place.x, place.y, math.radians(place.yaw_deg))
    if given is None:
        problems.append(Problem(root.location, f'missing key "{key}"'))
        return (0.0, 0.0, 0.0)
    return given


def _check_ground(
    boxes: tuple[Box, ...], places: dict[str, tuple[float, float, float]], root: Node, problems: list[Problem]
) -> None:
    """Start and goal must not lie over the pit."""
    ground = Ground(boxes)
    for key, (x, y, _) in places.items():
        if not np.isfinite(ground.ground_height(np.array([[x, y]]))[0]):
            node = root.get(key) or root
            problems.append(Problem(node.location, f"no box lies under the point ({x:g}, {y:g})", key))
