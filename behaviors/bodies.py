"""The body of a node: what stands after its kind, with structural keys, parameters, and short forms."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from behaviors.kinds import is_kind
from behaviors.registry import Registry
from strict_yaml import Entry, Kind, Node, Problem, nearest, read_dataclass


def get(body: Node, key: str) -> Node | None:
    """What a body has under a key; None where it is no mapping."""
    return body.get(key) if body.kind is Kind.MAPPING else None


def is_scalar(body: Node) -> bool:
    """Whether a body is a plain value, which no node takes; `kind:` alone is none."""
    return body.kind is Kind.SCALAR and body.value is not None


def check_keys(head: Entry, allowed: tuple[str, ...], path: str, problems: list[Problem]) -> bool:
    """Whether a body can have keys at all; unknown ones are appended to the problems."""
    body = head.node
    if body.kind is Kind.SEQUENCE or is_scalar(body):
        message = f"got {body.describe()}, {head.key} takes a mapping of {', '.join(allowed)}"
        problems.append(Problem(body.location, message, path))
        return False
    for entry in body.entries:
        if entry.key not in allowed:
            hint = nearest(entry.key, allowed)
            message = f'unknown key "{entry.key}"{hint} ({head.key}: {", ".join(allowed)})'
            problems.append(Problem(entry.location, message, path))
    return True


def read_parameters(
    cls: type[Any], head: Entry, structural: tuple[str, ...], path: str, problems: list[Problem]
) -> tuple[Any, tuple[str, ...]]:
    """The parameters in a body, which are all its keys that are not structural, and the names of those given.

    Args:
        cls: class of the parameters.
        head: kind and body of the node.
        structural: the keys with another meaning.
        path: of the node.
        problems: every problem found is appended.
    """
    fields = tuple(cls.__dataclass_fields__)
    if not check_keys(head, (*structural, *fields), path, problems):
        return None, ()
    entries = tuple(entry for entry in head.node.entries if entry.key in fields)
    parameters = read_dataclass(Node(Kind.MAPPING, head.node.location, entries), cls, problems, path)
    return parameters, tuple(entry.key for entry in entries)


def with_child(head: Entry, registry: Registry, path: str, problems: list[Problem]) -> Node:
    """A decorator's body with the child under `child`, also where it is written in short: beside the parameters."""
    body = head.node
    if body.kind is Kind.SCALAR and isinstance(body.value, str):
        return Node(Kind.MAPPING, body.location, (Entry("child", body.location, body),))
    inline = [entry for entry in body.entries if is_kind(entry.key, registry)]
    if not inline:
        return body
    first = inline[0]
    for entry in inline[1:]:
        problems.append(Problem(entry.location, f"{head.key} has one child, which is {first.key} already", path))
    if body.get("child") is not None:
        problems.append(Problem(first.location, f"{head.key} has one child, which is given already", path))
    child = Entry("child", first.location, Node(Kind.MAPPING, first.location, (first,)))
    return Node(Kind.MAPPING, body.location, (*(entry for entry in body.entries if entry not in inline), child))


def seen_below(body: Node, registry: Registry) -> Sequence[Node]:
    """What seems to be below a node of unknown kind, so that its problems can be told as well."""
    if body.kind is Kind.SEQUENCE:
        return body.elements
    listed = get(body, "children")
    single = [entry.node for entry in body.entries if entry.key in ("condition", "child")]
    inline = [Node(Kind.MAPPING, entry.location, (entry,)) for entry in body.entries if is_kind(entry.key, registry)]
    return (*(listed.elements if listed is not None else ()), *single, *inline)
