"""What an operator asks for: goals, decisions on what was planned, pauses and ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Self

from behaviors.operator.event import OperatorEvent, OperatorEventError, is_checkpoint, named
from skills.body_path import Goal


def _place(cls: type[OperatorEvent], value: Any) -> Goal:
    is_triple = isinstance(value, list | tuple) and len(value) == 3
    cls.require(is_triple and all(_is_number(part) for part in value), value)
    try:
        return Goal(*map(float, value))
    except ValueError as error:
        raise OperatorEventError(f"{cls.name}: {error}") from error


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _plain_place(goal: Goal) -> list[float]:
    return [goal.x, goal.y, goal.yaw]


@dataclass(frozen=True, slots=True)
class _PlaceEvent(OperatorEvent):
    goal: Goal

    def __post_init__(self) -> None:
        self.require(isinstance(self.goal, Goal), self.goal)

    @property
    def value(self) -> Any:
        """The place."""
        return _plain_place(self.goal)

    @classmethod
    def of(cls, value: Any) -> Self:
        """From a list of three numbers."""
        return cls(_place(cls, value))


@named("goal", "three numbers, x and y in m and the heading in rad")
class SendGoal(_PlaceEvent):
    """Walk there; the newest goal counts."""

    __slots__ = ()


@named("carrot", "three numbers, x and y in m and the heading in rad")
class MoveCarrot(_PlaceEvent):
    """Follow what is held out there, for as long as it is moved on."""

    __slots__ = ()


@named("waypoints", "a list of places, each three numbers, x and y in m and the heading in rad")
@dataclass(frozen=True, slots=True)
class SendWaypoints(OperatorEvent):
    """Walk to these places in turn.

    Attributes:
        goals: at least one.
    """

    goals: tuple[Goal, ...]

    def __post_init__(self) -> None:
        are_goals = isinstance(self.goals, tuple) and all(isinstance(goal, Goal) for goal in self.goals)
        self.require(are_goals and len(self.goals) > 0, self.goals)

    @property
    def value(self) -> Any:
        """The places."""
        return [_plain_place(goal) for goal in self.goals]

    @classmethod
    def of(cls, value: Any) -> Self:
        """From a list of lists of three numbers."""
        cls.require(isinstance(value, list | tuple), value)
        return cls(tuple(_place(cls, place) for place in value))


@dataclass(frozen=True, slots=True)
class _Decision(OperatorEvent):
    """What an operator thinks of one thing.

    Attributes:
        checkpoint: that asks, such as "body_path" or "footsteps".
        item_id: of the thing that is decided on: `path_id` of a body path, `plan_id` of a footstep plan.
    """

    checkpoint: str
    item_id: int

    def __post_init__(self) -> None:
        is_id = isinstance(self.item_id, int) and not isinstance(self.item_id, bool) and self.item_id >= 0
        self.require(is_checkpoint(self.checkpoint) and is_id, (self.checkpoint, self.item_id))

    @property
    def value(self) -> Any:
        """Checkpoint and id."""
        return [self.checkpoint, self.item_id]

    @classmethod
    def of(cls, value: Any) -> Self:
        """From a list of a checkpoint and an id."""
        cls.require(isinstance(value, list | tuple) and len(value) == 2, value)
        return cls(*value)


@named("approve", "a checkpoint and the id of what is approved, such as [footsteps, 12]")
class Approve(_Decision):
    """Let it be done; approves this thing and no other."""

    __slots__ = ()


@named("reject", "a checkpoint and the id of what is rejected, such as [footsteps, 12]")
class Reject(_Decision):
    """Plan it again."""

    __slots__ = ()


@named("pause")
class PauseWalk(OperatorEvent):
    """Finish the step under way and stand, until the walk is resumed; the goal stays."""

    __slots__ = ()


@named("resume")
class ResumeWalk(OperatorEvent):
    """Go on after a pause."""

    __slots__ = ()


@named("reset")
class ResetBehavior(OperatorEvent):
    """Finish the step under way and stand; forget the goal and all that was planned, and wait for a new goal."""

    __slots__ = ()


@named("stop")
class StopNow(OperatorEvent):
    """End the run: everything is stopped in this tick, and the tree's safe stop lets the robot stand."""

    __slots__ = ()
