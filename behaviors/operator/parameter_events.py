"""What an operator changes: parameters, and the switches that are parameters, review and impassability."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Self

from behaviors.operator.event import OperatorEvent, is_checkpoint, named


@dataclass(frozen=True, slots=True)
class _Change(OperatorEvent):
    @property
    def change(self) -> tuple[str, str, Any]:
        """The parameter that it changes: target, key and value."""
        raise NotImplementedError


@named("parameter", "a target, a key and a value, such as [footsteps, reach, 0.4]")
@dataclass(frozen=True, slots=True)
class ChangeParameter(_Change):
    """Change a parameter.

    Attributes:
        target: a node's path, or a subject of the skills' parameters.
        key: the parameter.
        to: what it shall be: a number, a text, a truth value, or a tuple of them.
    """

    target: str
    key: str
    to: Any

    def __post_init__(self) -> None:
        are_texts = all(isinstance(text, str) and text for text in (self.target, self.key))
        self.require(are_texts and _is_scalar_or_tuple(self.to), (self.target, self.key, self.to))

    @property
    def value(self) -> Any:
        """Target, key and value."""
        return [self.target, self.key, _as(list, self.to)]

    @property
    def change(self) -> tuple[str, str, Any]:
        """The parameter that it changes: target, key and value."""
        return self.target, self.key, self.to

    @classmethod
    def of(cls, value: Any) -> Self:
        """From a list of target, key and value."""
        cls.require(isinstance(value, list | tuple) and len(value) == 3, value)
        return cls(value[0], value[1], _as(tuple, value[2]))


@named("review", "a checkpoint and true or false, such as [footsteps, false]")
@dataclass(frozen=True, slots=True)
class SwitchReview(_Change):
    """Let a checkpoint ask before it goes on, or go on by itself; also while it waits.

    Attributes:
        checkpoint: such as "body_path" or "footsteps".
        asks: whether it asks.
    """

    checkpoint: str
    asks: bool

    def __post_init__(self) -> None:
        self.require(is_checkpoint(self.checkpoint) and isinstance(self.asks, bool), (self.checkpoint, self.asks))

    @property
    def value(self) -> Any:
        """Checkpoint, and whether it asks."""
        return [self.checkpoint, self.asks]

    @property
    def change(self) -> tuple[str, str, Any]:
        """The parameter that it changes: target, key and value."""
        return "review", self.checkpoint, self.asks

    @classmethod
    def of(cls, value: Any) -> Self:
        """From a list of a checkpoint and a truth value."""
        cls.require(isinstance(value, list | tuple) and len(value) == 2, value)
        return cls(*value)


@named("impassability", "true or false")
@dataclass(frozen=True, slots=True)
class SwitchImpassability(_Change):
    """Let the robot halt for what stands in its way, or leave that to the operator.

    Attributes:
        halts: whether it halts.
    """

    halts: bool

    def __post_init__(self) -> None:
        self.require(isinstance(self.halts, bool), self.halts)

    @property
    def value(self) -> Any:
        """Whether it halts."""
        return self.halts

    @property
    def change(self) -> tuple[str, str, Any]:
        """The parameter that it changes: target, key and value."""
        return "impassability", "halts", self.halts

    @classmethod
    def of(cls, value: Any) -> Self:
        """From a truth value."""
        return cls(value)


def parameter_change(event: OperatorEvent) -> tuple[str, str, Any] | None:
    """The parameter that an event changes: target, key and value; None where it changes none."""
    return event.change if isinstance(event, _Change) else None


def _is_scalar_or_tuple(value: Any) -> bool:
    if isinstance(value, tuple):
        return all(_is_scalar_or_tuple(part) for part in value)
    return isinstance(value, bool | int | float | str)


def _as(kind: type[list] | type[tuple], value: Any) -> Any:
    """Lists as tuples, or tuples as lists, all the way down."""
    return kind(_as(kind, part) for part in value) if isinstance(value, list | tuple) else value
