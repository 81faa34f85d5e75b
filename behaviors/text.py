"""Leaves in words, for documentation, hover texts and the palettes of other editors."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from typing import Any

from behaviors.blackboard import type_name
from behaviors.leaf import Leaf
from behaviors.ports import InputPort, Output, declared_inputs, declared_outputs
from behaviors.registry import Registry


def first_line(cls: type) -> str:
    """The first line of a class's docstring."""
    return (cls.__doc__ or "").strip().splitlines()[0]


def port_text(port: InputPort[Any] | Output[Any]) -> str:
    """A port in one line: type, unit and frame where it states them, meaning, and whether it may be left out."""
    unit = "" if port.unit == "1" else f" [{port.unit}]"
    frame = f" in frame {port.frame}" if port.frame else ""
    may = " (may be left unwired)" if isinstance(port, InputPort) and not port.required else ""
    return f"{type_name(port.type)}{unit}{frame}: {port.meaning}{may}"


def leaf_table(registry: Registry) -> str:
    """All leaves of a registry as a Markdown table."""
    lines = ["| leaf | does | in | out | parameters |", "|---|---|---|---|---|"]
    return "\n".join((*lines, *map(_row, registry.classes))) + "\n"


def _row(cls: type[Leaf]) -> str:
    ports = [
        ", ".join(f"`{name}: {type_name(port.type)}`" for name, port in declared(cls).items())
        for declared in (declared_inputs, declared_outputs)
    ]
    parameters = ", ".join(
        f"`{field.name}` {default_text(field)}{_unit(field)}" for field in dataclasses.fields(cls.Parameters)
    )
    return f"| `{cls.__name__}` | {first_line(cls)} | {ports[0]} | {ports[1]} | {parameters} |"


def leaf_page(cls: type[Leaf]) -> str:
    """All that a leaf says about itself, as text for a terminal."""
    return "\n".join(_page_lines(cls))


def _page_lines(cls: type[Leaf]) -> Iterator[str]:
    yield f"{cls.__name__}: {first_line(cls)}"
    for title, ports in (("in", declared_inputs(cls)), ("out", declared_outputs(cls))):
        for name, port in ports.items():
            yield f"  {title:<4}{name:<16}{port_text(port)}"
    for field in dataclasses.fields(cls.Parameters):
        low, high = field.metadata["minimum"], field.metadata["maximum"]
        bounds = "" if low is None and high is None else f", {_bound(low)} .. {_bound(high)}"
        choices = field.metadata["choices"]
        allowed = f", one of {', '.join(choices)}" if choices else bounds
        value = f"{default_text(field)}{_unit(field)}"
        yield f"  set {field.name:<16}{value}{allowed}: {field.metadata['meaning']}"


def default_text(field: dataclasses.Field[Any]) -> str:
    """The default of a parameter as a tree file writes it."""
    default = field.default
    if isinstance(default, bool):
        return str(default).lower()
    return f"{default:g}" if isinstance(default, int | float) else f'"{default}"'


def _unit(field: dataclasses.Field[Any]) -> str:
    unit = field.metadata["unit"]
    return "" if unit == "1" else f" {unit}"


def _bound(value: float | None) -> str:
    return "any" if value is None else f"{value:g}"
