"""Parameters that the use of a subtree sets inside it: `set: {plan/plan_footsteps.latency: 0.3}`."""

from __future__ import annotations

import dataclasses

from behaviors.spec import NodeSpec
from strict_yaml import Entry, Kind, Node, Problem, nearest, read_dataclass


def override(spec: NodeSpec, node: Node | None, problems: list[Problem]) -> NodeSpec:
    """The root of a subtree with the parameters replaced that its use sets; problems are appended.

    Args:
        spec: root of the subtree.
        node: mapping of `path.parameter` to value, with paths from below the root; a parameter alone is the root's.
        problems: every problem found is appended.
    """
    if node is None:
        return spec
    if node.kind is not Kind.MAPPING:
        message = f"got {node.describe()}, needs a mapping such as {{plan/plan_footsteps.latency: 0.3}}"
        problems.append(Problem(node.location, message, spec.path))
        return spec
    for entry in node.entries:
        below, _, key = entry.key.rpartition(".")
        path = f"{spec.path}/{below}" if below else spec.path
        paths = {found.path: found for found in spec}
        if path not in paths:
            relative = [found.removeprefix(spec.path + "/") for found in paths if found != spec.path]
            message = f'no node "{below}" below {spec.path}{nearest(below, relative)}'
            problems.append(Problem(entry.location, message, spec.path))
            continue
        replaced = _replaced(paths[path], key, entry, problems)
        if replaced is not None:
            spec = _with(spec, replaced)
    return spec


def _replaced(spec: NodeSpec, key: str, entry: Entry, problems: list[Problem]) -> NodeSpec | None:
    single = Node(Kind.MAPPING, entry.location, (Entry(key, entry.location, entry.node),))
    read = read_dataclass(single, type(spec.parameters), problems, spec.path)
    if read is None:
        return None
    parameters = dataclasses.replace(spec.parameters, **{key: getattr(read, key)})
    given = spec.given if key in spec.given else (*spec.given, key)
    return dataclasses.replace(spec, parameters=parameters, given=given)


def _with(spec: NodeSpec, replaced: NodeSpec) -> NodeSpec:
    """A tree with the node of one path replaced."""
    if spec.path == replaced.path:
        return replaced
    if not replaced.path.startswith(spec.path + "/"):
        return spec
    return dataclasses.replace(spec, children=tuple(_with(child, replaced) for child in spec.children))
