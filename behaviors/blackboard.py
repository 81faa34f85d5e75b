"""The blackboard of one tree: typed slots by key, and nothing that another tree could see.

A key of the root tree is a plain name, such as `plan`. A key inside a subtree begins with the path of the subtree
below the root, such as `recover/plan`, so that two uses of a subtree share nothing but what is wired to their ports.
"""

from __future__ import annotations

import types
from collections.abc import Iterator
from typing import Any, get_origin


class PortTypeError(TypeError):
    """A value of a type that its port does not take."""


class Slot:
    """The place of one value.

    Attributes:
        key: name on the blackboard.
        type: what may be written.
        value: what was written last; None where there is nothing.
    """

    __slots__ = ("_check", "key", "type", "value")

    def __init__(self, key: str, type: Any) -> None:
        self.key = key
        self.type = type
        self.value: Any = None
        self._check = runtime_type(type)

    def write(self, value: Any) -> None:
        """Replace the value; None empties the slot.

        Raises:
            PortTypeError: where the value is not of the slot's type.
        """
        self.check(value)
        self.value = value

    def check(self, value: Any) -> None:
        """Refuse what may not be written.

        Raises:
            PortTypeError: where the value is not of the slot's type.
        """
        if value is not None and not isinstance(value, self._check):
            raise PortTypeError(f'"{self.key}" takes {type_name(self.type)}, got {type(value).__name__}')


class Blackboard:
    """All slots of one tree."""

    def __init__(self) -> None:
        self._slots: dict[str, Slot] = {}

    def slot(self, key: str, type: Any) -> Slot:
        """The slot of a key; made at its first mention."""
        return self._slots.setdefault(key, Slot(key, type))

    @property
    def slots(self) -> tuple[Slot, ...]:
        """All slots, sorted by key."""
        return tuple(self._slots[key] for key in sorted(self._slots))

    def __getitem__(self, key: str) -> Any:
        return self._slots[key].value

    def __contains__(self, key: str) -> bool:
        return key in self._slots

    def __iter__(self) -> Iterator[str]:
        return iter(sorted(self._slots))

    def __len__(self) -> int:
        return len(self._slots)

    def values(self) -> dict[str, Any]:
        """What is there, by key; empty slots are left out."""
        return {slot.key: slot.value for slot in self.slots if slot.value is not None}


def runtime_type(declared: Any) -> Any:
    """What `isinstance` can check of a declared type."""
    if declared is float:
        return (float, int)
    if declared is Any:
        return object
    return get_origin(declared) or declared


def type_name(declared: Any) -> str:
    """The name of a port type as a tree file writes it."""
    if declared is Any:
        return "anything"
    if isinstance(declared, type) and not isinstance(declared, types.GenericAlias):
        return declared.__name__
    return str(declared).replace("typing.", "")
