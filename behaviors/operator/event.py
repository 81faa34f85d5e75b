"""What an operator can say to a running tree: one family of frozen events, each of which refuses what makes no sense.

A panel, a terminal, a file and a test send the same events. As plain data, for JSON and YAML, an event is a name and a
value: `read_event(event.name, event.value) == event` for every event.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, Self, TypeVar

from strict_yaml import nearest

_NAME = re.compile(r"[a-z][a-z0-9_]*")
_Event = TypeVar("_Event", bound="type[OperatorEvent]")


class OperatorEventError(ValueError):
    """An event that makes no sense; the message says what was given and what is allowed."""


@dataclass(frozen=True, slots=True)
class OperatorEvent:
    """Something a person did, or a program in a person's place.

    Attributes:
        name: of the kind of event, in plain data.
        form: what its value looks like in plain data.
    """

    name: ClassVar[str] = ""
    form: ClassVar[str] = "nothing"

    @property
    def value(self) -> Any:
        """What belongs to it, as JSON takes it; None where nothing does."""
        return None

    @classmethod
    def of(cls, value: Any) -> Self:
        """The event with a value of plain data.

        Raises:
            OperatorEventError: where the value is none of this event's.
        """
        cls.require(value is None, value)
        return cls()

    @classmethod
    def require(cls, holds: bool, value: Any) -> None:
        """Refuse a value unless something holds.

        Raises:
            OperatorEventError: where it does not.
        """
        if not holds:
            raise OperatorEventError(f"{cls.name}: got {value!r}, needs {cls.form}")


EVENTS: dict[str, type[OperatorEvent]] = {}


def named(name: str, form: str = OperatorEvent.form) -> Callable[[_Event], _Event]:
    """Enter a class of events under its name in plain data."""

    def enter(cls: _Event) -> _Event:
        cls.name, cls.form = name, form
        EVENTS[name] = cls
        return cls

    return enter


def read_event(name: str, value: Any = None) -> OperatorEvent:
    """The event that plain data describe.

    Raises:
        OperatorEventError: where there is no event of this name, or it has no such value.
    """
    if name not in EVENTS:
        raise OperatorEventError(f'no event "{name}"{nearest(str(name), EVENTS)} (events: {", ".join(EVENTS)})')
    return EVENTS[name].of(value)


def is_checkpoint(value: Any) -> bool:
    """Whether a value may name a checkpoint."""
    return isinstance(value, str) and _NAME.fullmatch(value) is not None
