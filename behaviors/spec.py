"""A tree as its file describes it: checked, immutable, and independent of any robot."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

from behaviors.leaf import Leaf
from behaviors.node import Node
from strict_yaml import Location, Problem


@dataclass(frozen=True, slots=True)
class Wire:
    """What one port of a leaf is connected to.

    Attributes:
        port: name of the port.
        key: key on the blackboard of the tree, with the subtree's path before it.
    """

    port: str
    key: str


@dataclass(frozen=True, slots=True)
class NodeSpec:
    """One node with all below it.

    Attributes:
        cls: class of the leaf, composite or decorator.
        kind: as the file names it, such as "sequence" or "PlanFootsteps".
        name: as the file names it, or made from the kind.
        path: from the tree's name down; unique in a tree.
        location: where the file says so.
        parameters: an instance of `cls.Parameters`.
        given: names of the parameters that the file itself sets.
        inputs, outputs: wires of a leaf.
        children: nodes below; of a decorator with a condition, the condition comes first.
        subtree: name of the tree whose root this is; empty elsewhere.
    """

    cls: type[Node] | type[Leaf]
    kind: str
    name: str
    path: str
    location: Location
    parameters: Any
    given: tuple[str, ...] = ()
    inputs: tuple[Wire, ...] = ()
    outputs: tuple[Wire, ...] = ()
    children: tuple[NodeSpec, ...] = ()
    subtree: str = ""

    @property
    def is_leaf(self) -> bool:
        """Whether it is a leaf."""
        return issubclass(self.cls, Leaf)

    def __iter__(self) -> Iterator[NodeSpec]:
        yield self
        for child in self.children:
            yield from child


@dataclass(frozen=True, slots=True)
class TreeSpec:
    """A whole tree.

    Attributes:
        name: the tree's name.
        about: one line for people; may be empty.
        file: where it was read from.
        inputs: type of each key that comes from outside, by key.
        outputs: type of each key that the tree promises to write, by key.
        keys: type of every key on the blackboard.
        root: the tree.
        safe_stop: ticked after a fault; None where there is none.
        remarks: what may be meant but looks like a mistake, such as a value that nobody reads.
        sources: texts of the files that it was read from, by path.
    """

    name: str
    about: str
    file: str
    inputs: dict[str, Any]
    outputs: dict[str, Any]
    keys: dict[str, Any]
    root: NodeSpec
    safe_stop: NodeSpec | None = None
    remarks: tuple[Problem, ...] = ()
    sources: Mapping[str, str] = field(default_factory=dict)

    def __iter__(self) -> Iterator[NodeSpec]:
        yield from self.root
        if self.safe_stop is not None:
            yield from self.safe_stop
