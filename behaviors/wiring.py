"""Wires as a file writes them: `{port: key}`, or a list of ports whose keys have the same names."""

from __future__ import annotations

from collections.abc import Iterable

from behaviors.definition import KEY
from behaviors.spec import Wire
from strict_yaml import Entry, Kind, Location, Node, Problem, nearest


def read_wires(
    node: Node | None, ports: Iterable[str], direction: str, path: str, problems: list[Problem]
) -> list[tuple[Wire, Location]]:
    """The wires under `in` or `out`, and where each key is written; problems are appended.

    Args:
        node: what is written there; None where nothing is.
        ports: names of the ports that may be wired.
        direction: "in" or "out".
        path: of the node that has the ports.
        problems: every problem found is appended.
    """
    if node is None:
        return []
    if node.kind is Kind.SCALAR:
        message = f"got {node.describe()}, needs a list of ports or a mapping of ports to keys"
        problems.append(Problem(node.location, message, path))
        return []
    what = {"in": "input", "out": "output"}[direction]
    wires = []
    for port, location, key in _entries(node):
        if port not in ports:
            allowed = ", ".join(ports) or "none"
            message = f'unknown {what} "{port}"{nearest(port, ports)} ({what}s: {allowed})'
            problems.append(Problem(location, message, path))
        elif not isinstance(key.value, str) or not KEY.fullmatch(key.value):
            message = f'got {key.describe()}; a key is named in small letters, digits and "_"'
            problems.append(Problem(key.location, message, path))
        else:
            wires.append((Wire(port, key.value), key.location))
    return wires


def named_ports(node: Node | None) -> tuple[str, ...]:
    """The ports that `in` or `out` names, rightly or not."""
    if node is None:
        return ()
    return (str(node.value),) if node.kind is Kind.SCALAR else tuple(entry.key for entry in _entries(node))


def written_keys(node: Node | None) -> tuple[str, ...]:
    """The keys that `in` or `out` names, rightly or not."""
    if node is None or node.kind is Kind.SCALAR:
        return ()
    return tuple(str(entry.node.value) for entry in _entries(node))


def _entries(node: Node) -> Iterable[Entry]:
    if node.kind is Kind.MAPPING:
        return node.entries
    return [Entry(str(element.value), element.location, element) for element in node.elements]
