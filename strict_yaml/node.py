"""A YAML document as plain values that remember where they were written."""

from __future__ import annotations

from dataclasses import dataclass, field
from enum import StrEnum
from typing import NamedTuple

from strict_yaml.problem import Location

Scalar = str | int | float | bool | None


class Kind(StrEnum):
    """The three kinds of YAML nodes."""

    MAPPING = "mapping"
    SEQUENCE = "sequence"
    SCALAR = "scalar"


class Entry(NamedTuple):
    """One `key: node` of a mapping."""

    key: str
    location: Location
    node: Node


@dataclass(frozen=True, slots=True)
class Node:
    """A mapping, a sequence or a scalar, and where it is written.

    Attributes:
        kind: which of the three it is.
        location: its first character; for an alias, the place of the anchored node.
        entries: of a mapping, in the order of the file; empty otherwise.
        elements: of a sequence; empty otherwise.
        value: of a scalar; None otherwise.
        text_column: column of the first character of a scalar's text on the line of `location`, behind a quote; 0
            where the text begins on another line or is none.
    """

    kind: Kind
    location: Location
    entries: tuple[Entry, ...] = ()
    elements: tuple[Node, ...] = ()
    value: Scalar = None
    text_column: int = field(default=0, compare=False)

    @property
    def keys(self) -> tuple[str, ...]:
        """The keys of a mapping, in the order of the file."""
        return tuple(entry.key for entry in self.entries)

    def get(self, key: str) -> Node | None:
        """The node under a key of a mapping; None where the key is absent."""
        return next((entry.node for entry in self.entries if entry.key == key), None)

    def describe(self) -> str:
        """The node in the words of an error message: a scalar as written in YAML, or its kind."""
        if self.kind is not Kind.SCALAR:
            return f"a {self.kind}"
        if isinstance(self.value, str):
            text = self.value if len(self.value) <= 40 else self.value[:37] + "..."
            return '"' + text.encode("unicode_escape").decode() + '"' if not text.isprintable() else f'"{text}"'
        if self.value is None:
            return "nothing"
        if isinstance(self.value, bool):
            return "true" if self.value else "false"
        return repr(self.value)
