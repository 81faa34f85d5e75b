"""A course: boxes to walk over, where to start, where to go, and what moves on the way.

The ground of a course is the boxes and nothing else. Beside and between them lies a pit, so that a course cannot be
walked around.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skills.geometry.pose import Array, Pose, readonly


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
class CarrotWay:
    """Where an operator leads a robot over a course: a place that moves on steadily.

    Attributes:
        points_world: (N >= 2, 2) the way from the start on [m].
        speed: of the place along it [m/s].
    """

    points_world: Array
    speed: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "points_world", readonly(self.points_world, (None, 2)))

    @property
    def length(self) -> float:
        """From end to end [m]."""
        return float(self._arcs[-1])

    def at(self, time: float) -> tuple[float, float, float]:
        """The place a time [s] after it has left: x, y [m] and the direction of the way [rad]; at last it rests."""
        arcs, arc = self._arcs, min(max(self.speed * time, 0.0), self.length)
        i = int(np.clip(np.searchsorted(arcs, arc, side="right") - 1, 0, len(arcs) - 2))
        span = self.points_world[i + 1] - self.points_world[i]
        x, y = self.points_world[i] + span * (arc - arcs[i]) / max(arcs[i + 1] - arcs[i], 1e-12)
        return float(x), float(y), float(np.arctan2(span[1], span[0]))

    def distance(self, point_world: Array) -> float:
        """How far a point, of which x and y count, is from the way [m]."""
        starts, spans = self.points_world[:-1], np.diff(self.points_world, axis=0)
        off = np.asarray(point_world)[:2] - starts
        share = np.sum(off * spans, axis=1) / np.maximum(np.sum(spans * spans, axis=1), 1e-12)
        return float(np.min(np.linalg.norm(off - np.clip(share, 0.0, 1.0)[:, None] * spans, axis=1)))

    @property
    def _arcs(self) -> Array:
        return np.concatenate(([0.0], np.cumsum(np.linalg.norm(np.diff(self.points_world, axis=0), axis=1))))


@dataclass(frozen=True, slots=True, eq=False)
class Course:
    """Boxes, start, goal, scripted events, and a way on which a carrot moves.

    Attributes:
        name: of the generator or file.
        boxes: all ground there is.
        start, goal: x [m], y [m] and yaw [rad] on the ground.
        events: in the order of the file.
        carrot: where an operator leads the robot; None where nobody does.
    """

    name: str
    boxes: tuple[Box, ...]
    start: tuple[float, float, float]
    goal: tuple[float, float, float]
    events: tuple[BoxEvent, ...] = ()
    carrot: CarrotWay | None = None
