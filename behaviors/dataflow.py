"""Checks what flows between the ports of an expanded tree: every key that is read is written, and by one type only."""

from __future__ import annotations

from typing import Any

from behaviors.blackboard import type_name
from behaviors.expansion import Expansion, Use
from strict_yaml import Problem, nearest


def check_dataflow(expansion: Expansion, problems: list[Problem]) -> dict[str, Any]:
    """The type of every key; problems are appended.

    The type of a key is that which comes from outside, or else that of the first port that writes it.
    """
    definition = expansion.definition
    types: dict[str, Any] = {port.name: port.type for port in definition.inputs}
    origin = {port.name: f"comes from outside as {type_name(port.type)}" for port in definition.inputs}
    for use in expansion.writes:
        if use.key not in types:
            types[use.key] = use.type
            origin[use.key] = f"is {type_name(use.type)} of {use.path}"
        elif not fits(use.type, types[use.key]):
            problems.append(_mismatch(use, "gives", origin[use.key]))
    for use in expansion.reads:
        if use.key not in types and use.key in expansion.doubtful:
            continue
        if use.key not in types:
            message = f'nothing writes "{use.key}"{nearest(use.key, types)}'
            problems.append(Problem(use.location, message, use.path))
        elif not fits(types[use.key], use.type):
            problems.append(_mismatch(use, "takes", origin[use.key]))
    for port in definition.outputs:
        if port.name not in types and port.name in expansion.doubtful:
            continue
        if port.name not in types:
            problems.append(Problem(port.location, f'nothing writes the output "{port.name}"'))
        elif not fits(types[port.name], port.type):
            message = f'output "{port.name}" is {type_name(port.type)}, but the key {origin[port.name]}'
            problems.append(Problem(port.location, message))
    return types


def fits(given: Any, taken: Any) -> bool:
    """Whether a value of one declared type may go where another is taken."""
    if given == taken or taken is Any:
        return True
    if isinstance(given, type) and isinstance(taken, type):
        return issubclass(given, taken) or (taken is float and given is int)
    return False


def _mismatch(use: Use, verb: str, origin: str) -> Problem:
    message = f'"{use.port}" {verb} {type_name(use.type)}, but "{use.key}" {origin}'
    return Problem(use.location, message, use.path)
