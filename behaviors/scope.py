"""Where a name of a tree file is looked up, and what an expanded tree reads and writes under which key."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

from behaviors.definition import Definition
from behaviors.spec import NodeSpec, Wire
from strict_yaml import Location, Node


@dataclass(frozen=True, slots=True)
class Use:
    """A port at the end of a key.

    Attributes:
        key: as the whole tree knows it.
        type: of the port.
        location: where the key is written.
        path: node that has the port.
        port: its name.
        unit, frame: as the port states them; "1" and empty where it does not.
    """

    key: str
    type: Any
    location: Location
    path: str
    port: str
    unit: str = "1"
    frame: str = ""


@dataclass(frozen=True, slots=True)
class Condition:
    """A condition over keys, whose types are not checked yet.

    Attributes:
        path: node that asks it.
        text: as it is written.
        wires: what its names stand for.
        node: where it is written.
    """

    path: str
    text: str
    wires: tuple[Wire, ...]
    node: Node


@dataclass(slots=True)
class Expansion:
    """What became of a definition.

    Attributes:
        definition: what was expanded.
        root, safe_stop: the trees; None where they could not be read or are not there.
        reads, writes: the ports of leaves, and those of subtrees, at the ends of all keys.
        handed_out: keys that come out of a subtree, where its use wires them.
        dropped: keys of subtrees' outputs that their use does not wire.
        conditions: all conditions over keys.
        doubtful: keys that something may write that could not be read; not known to be missing.
    """

    definition: Definition
    root: NodeSpec | None = None
    safe_stop: NodeSpec | None = None
    reads: list[Use] = field(default_factory=list)
    writes: list[Use] = field(default_factory=list)
    handed_out: list[Use] = field(default_factory=list)
    conditions: list[Condition] = field(default_factory=list)
    dropped: set[str] = field(default_factory=set)
    doubtful: set[str] = field(default_factory=set)

    def prefix(self, path: str) -> str:
        """What goes before the keys inside a subtree: its path without the name of the whole tree."""
        return path.removeprefix(f"/{self.definition.name}").lstrip("/") + "/"


@dataclass(frozen=True, slots=True)
class Scope:
    """Where a name is looked up.

    Attributes:
        definition: the tree around.
        prefix: what goes before a key that is no port, such as "recover/".
        ports: keys that the ports of the tree around are wired to, by port.
        stack: names of the trees around, the outermost first.
    """

    definition: Definition
    prefix: str = ""
    ports: dict[str, str] = field(default_factory=dict)
    stack: tuple[str, ...] = ()

    def key(self, name: str) -> str:
        """The key of a name as the whole tree knows it."""
        return self.ports.get(name, self.prefix + name)
