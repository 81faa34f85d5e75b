"""A course: boxes to walk over, where to start, where to go, and what moves on the way.

The ground of a course is the boxes and nothing else. Beside and between them lies a pit, so that a course cannot be
walked around.
"""

from __future__ import annotations

from dataclasses import dataclass

from skills.geometry.pose import Pose


class CourseError(ValueError):
    """A course that cannot be made or found; the message says what is allowed."""


@dataclass(frozen=True, slots=True, eq=False)
class Box:
    """A box of a course.

    Attributes:
        name: unique in its course; letters, digits, `_` and `-`.
        size: full lengths along its own x, y and z [m].
        T_world_box: frame at the box's centre.
        kind: what it stands for, such as "block", "base" or "pad"; decides its colour, nothing else.
    """

    name: str
    size: tuple[float, float, float]
    T_world_box: Pose
    kind: str


@dataclass(frozen=True, slots=True, eq=False)
class BoxEvent:
    """A box that moves to another pose once; exactly one of `time`, `distance` and `after` says when.

    Attributes:
        box: name of the box.
        T_world_box: pose at the end of the motion.
        duration: of the motion [s].
        time: robot time at which it begins [s].
        distance: horizontal distance between robot and box centre at which it begins [m].
        after: time from the beginning of the event before it of the same box [s].
    """

    box: str
    T_world_box: Pose
    duration: float
    time: float | None = None
    distance: float | None = None
    after: float | None = None

    def __post_init__(self) -> None:
        if sum(when is not None for when in (self.time, self.distance, self.after)) != 1:
            raise CourseError(f"event of box {self.box!r}: needs one of time, distance and after")


@dataclass(frozen=True, slots=True, eq=False)
class Course:
    """Boxes, start, goal and scripted events.

    Attributes:
        name: of the generator or file.
        boxes: all ground there is.
        start, goal: x [m], y [m] and yaw [rad] on the ground.
        events: in the order of the file.
    """

    name: str
    boxes: tuple[Box, ...]
    start: tuple[float, float, float]
    goal: tuple[float, float, float]
    events: tuple[BoxEvent, ...] = ()
