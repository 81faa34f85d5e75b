"""Draws a tree for a terminal: one line a node, with what it is, its parameters, and what flows in and out of it."""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, fields
from typing import Any

from behaviors.blackboard import type_name
from behaviors.check_leaf import Check
from behaviors.decorators import Decorator
from behaviors.naming import snake_case
from behaviors.spec import NodeSpec, TreeSpec, Wire


@dataclass(frozen=True, slots=True)
class DrawnLine:
    """One line of a drawing, in parts that a screen may colour.

    Attributes:
        path: the node on the line; empty for a headline.
        branch: the lines that lead to it.
        name: what it is called.
        kind: what it is, where its name does not say so already.
        details: parameters that the file sets, inputs and outputs.
    """

    path: str
    branch: str
    name: str
    kind: str = ""
    details: tuple[str, ...] = ()

    def __str__(self) -> str:
        words = (self.name, f"({self.kind})" if self.kind else "", *self.details)
        return self.branch + "  ".join(word for word in words if word)


def draw(tree: TreeSpec) -> str:
    """A drawing of a tree as text."""
    return "\n".join(str(line) for line in drawn_lines(tree))


def drawn_lines(tree: TreeSpec) -> Iterator[DrawnLine]:
    """A drawing of a tree, line by line."""
    if tree.about:
        yield DrawnLine("", "", tree.about)
    for mark, ports in (("←", tree.inputs), ("→", tree.outputs)):
        if ports:
            listed = ", ".join(f"{key}: {type_name(declared)}" for key, declared in ports.items())
            yield DrawnLine("", "", f"{mark} {listed}")
    yield from _drawn_node(tree.root, "", "")
    if tree.safe_stop is not None:
        yield from _drawn_node(tree.safe_stop, "", "")


def _drawn_node(node: NodeSpec, branch: str, below: str, role: str = "") -> Iterator[DrawnLine]:
    """A node whose own line begins with `branch`, and those of its children with `below`."""
    is_named = re.sub(r"_\d+$", "", node.name) != snake_case(node.kind)
    kind = f"{node.kind} of tree {node.subtree}" if node.subtree else node.kind if is_named else ""
    name = node.name if is_named or node.subtree else node.kind
    yield DrawnLine(node.path, branch, f"{role}: {name}" if role else name, kind, tuple(_details(node)))
    roles = node.cls.slots if issubclass(node.cls, Decorator) and len(node.cls.slots) > 1 else ()
    for index, child in enumerate(node.children):
        is_last = index == len(node.children) - 1
        role = "condition" if roles and roles[index] == "condition" else ""
        yield from _drawn_node(
            child, below + ("╰─ " if is_last else "├─ "), below + ("   " if is_last else "│  "), role
        )


def _details(node: NodeSpec) -> Iterator[str]:
    if node.kind == Check.kind:
        yield node.parameters.that
        return
    if node.given:
        units = {field.name: field.metadata["unit"] for field in fields(node.parameters)}
        yield ", ".join(_setting(key, getattr(node.parameters, key), units[key]) for key in node.given)
    if node.inputs:
        yield "← " + ", ".join(map(_wire, node.inputs))
    if node.outputs:
        yield "→ " + ", ".join(map(_wire, node.outputs))


def _setting(key: str, value: Any, unit: str) -> str:
    return f"{key} {value}" + ("" if unit == "1" else f" {unit}")


def _wire(wire: Wire) -> str:
    key = wire.key.rpartition("/")[2]
    return key if key == wire.port else f"{wire.port}: {key}"
