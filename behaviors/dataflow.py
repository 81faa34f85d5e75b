"""Checks what flows between the ports of an expanded tree, before anything runs.

Every key that is read is written, and all ports at its ends agree on type, unit and frame. A value that nobody reads,
and a key of a subtree that has the name of one around it, are remarks: they can be meant.
"""

from __future__ import annotations

from typing import Any

from behaviors.blackboard import type_name
from behaviors.expansion import place_in
from behaviors.expression import ExpressionError, parse_expression
from behaviors.scope import Condition, Expansion, Use
from strict_yaml import Problem, nearest


def check_dataflow(expansion: Expansion, problems: list[Problem], remarks: list[Problem]) -> dict[str, Any]:
    """The type of every key; problems and remarks are appended.

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
    for condition in expansion.conditions:
        _check_condition(condition, types, problems)
    _check_units(expansion, problems)
    _remark_unread(expansion, types, remarks)
    _remark_shadowed(expansion, types, remarks)
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


def _check_condition(condition: Condition, types: dict[str, Any], problems: list[Problem]) -> None:
    known = {wire.port: types[wire.key] for wire in condition.wires if wire.key in types}
    if len(known) < len(condition.wires):
        return
    try:
        parse_expression(condition.text).compile(known)
    except ExpressionError as error:
        problems.append(Problem(place_in(condition.node, error.offset), error.message, condition.path))


def _check_units(expansion: Expansion, problems: list[Problem]) -> None:
    """Where two ports on a key state unit or frame, they must state the same."""
    inputs = expansion.definition.inputs
    outside = [Use(port.name, port.type, port.location, "outside", port.name, port.unit, port.frame) for port in inputs]
    for what, silence in (("unit", "1"), ("frame", "")):
        stated: dict[str, Use] = {}
        for use in (*outside, *expansion.writes, *expansion.handed_out, *expansion.reads):
            said = getattr(use, what)
            if said == silence:
                continue
            first = stated.setdefault(use.key, use)
            if getattr(first, what) != said:
                message = (
                    f'"{use.port}" has {what} "{said}", but "{use.key}" has {what} "{getattr(first, what)}" '
                    f"by {_who(first)}"
                )
                problems.append(Problem(use.location, message, use.path))


def _who(use: Use) -> str:
    return f'"{use.port}" of {use.path}' if use.path.startswith("/") else "the tree's input"


def _remark_unread(expansion: Expansion, types: dict[str, Any], remarks: list[Problem]) -> None:
    """A value that is written for nobody; told once, where the outermost wire of its key is written."""
    read = {use.key for use in expansion.reads} | {port.name for port in expansion.definition.outputs}
    outermost: dict[str, Use] = {}
    for use in (*expansion.handed_out, *expansion.writes):
        if use.key in types and use.key not in read | expansion.dropped:
            outermost.setdefault(use.key, use)
    for use in outermost.values():
        name = use.key.rpartition("/")[2]
        message = f'nobody reads "{name}"; leave it unwired, or make it an output of the tree if people look at it'
        remarks.append(Problem(use.location, message, use.path))


def _remark_shadowed(expansion: Expansion, types: dict[str, Any], remarks: list[Problem]) -> None:
    """A key of a subtree that has the name of a key around it: easily a wire that was forgotten."""
    first: dict[str, Use] = {}
    for use in (*expansion.writes, *expansion.reads):
        first.setdefault(use.key, use)
    for key, use in first.items():
        prefix, _, name = key.rpartition("/")
        parts = prefix.split("/") if prefix else []
        around = ["/".join((*parts[:count], name)) for count in range(len(parts))]
        if any(outer in types for outer in around) and key not in expansion.dropped:
            message = f'"{name}" is a key of this subtree alone, the tree around has another: wire it, or rename it'
            remarks.append(Problem(use.location, message, use.path))
