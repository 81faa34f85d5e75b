"""Names of nodes: those that a file gives, which differ among siblings, and for the others one made from the kind."""

from __future__ import annotations

import re
from collections.abc import Sequence

from behaviors.bodies import get
from strict_yaml import Entry, Location, Problem

NODE_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_ -]*")


def sibling_names(heads: Sequence[Entry], path: str, problems: list[Problem]) -> list[str]:
    """Names for the children of one node, in order; problems are appended.

    Args:
        heads: kind and body of each child.
        path: of the node above.
        problems: every problem found is appended.
    """
    taken: dict[str, Location] = {}
    names = [_given_name(head, taken, path, problems) for head in heads]
    for index, head in enumerate(heads):
        if not names[index]:
            names[index] = _free_name(_made_name(head), taken)
            taken[slug(names[index])] = head.location
    return names


def slug(name: str) -> str:
    """A name as a part of a path."""
    return name.replace(" ", "_").lower()


def snake_case(kind: str) -> str:
    """The name of a node that has none of its own, such as `plan_footsteps` of a `PlanFootsteps`."""
    return re.sub(r"(?<=[a-z0-9])(?=[A-Z])", "_", kind).lower()


def _given_name(head: Entry, taken: dict[str, Location], path: str, problems: list[Problem]) -> str:
    node = get(head.node, "name")
    if node is None:
        return ""
    name = node.value
    if not isinstance(name, str) or not NODE_NAME.fullmatch(name):
        message = f'got {node.describe()}; a name is letters, digits, spaces, "_" and "-"'
        problems.append(Problem(node.location, message, path))
        return ""
    first = taken.setdefault(slug(name), node.location)
    if first is not node.location:
        message = f'two siblings are named "{name}", the first on line {first.line}'
        problems.append(Problem(node.location, message, path))
    return name


def _made_name(head: Entry) -> str:
    if head.key == "subtree":
        tree = get(head.node, "tree")
        return str(tree.value).rpartition("/")[2] if tree is not None else "subtree"
    return snake_case(head.key)


def _free_name(name: str, taken: dict[str, Location]) -> str:
    count, free = 1, name
    while slug(free) in taken:
        count += 1
        free = f"{name}_{count}"
    return free
