"""A YAML mapping -> an instance of a dataclass, with every problem told at once and at its own place.

The class is the format: its fields are the keys, their type hints the allowed values, their defaults what may be left
out. A field's metadata may narrow it by `minimum`, `maximum`, `choices` and name its `unit`. After Drake's strict
`yaml_load_typed`: an unknown key is an error, and so is a missing required one.
"""

from __future__ import annotations

import dataclasses
import math
import types
from collections.abc import Mapping
from enum import Enum
from typing import Any, TypeVar, Union, get_args, get_origin, get_type_hints

from strict_yaml.node import Kind, Node
from strict_yaml.problem import Problem, nearest

T = TypeVar("T")

_NAMES: dict[type, str] = {bool: "true or false", int: "a whole number", float: "a number", str: "text"}


class _Unusable:
    """Stands for a value whose problem is already told."""


_UNUSABLE = _Unusable()


def read_dataclass(node: Node, cls: type[T], problems: list[Problem], path: str = "") -> T | None:
    """Read a mapping into a dataclass.

    Fields may be str, int, float, bool, None, an Enum (by value), tuples of fixed or any length, `X | None`, other
    dataclasses, or `Node` for a part that the caller reads itself.

    Args:
        node: the mapping.
        cls: a dataclass; its own checks in `__post_init__` may raise ValueError, whose `key` names the field.
        problems: every problem found is appended.
        path: name of the node in messages, such as `objects[3]`; may be empty.

    Returns:
        The instance, or None where a problem was appended.
    """
    if node.kind is not Kind.MAPPING:
        keys = ", ".join(field.name for field in _fields(cls))
        problems.append(Problem(node.location, f"got {node.describe()}, needs a mapping with the keys {keys}", path))
        return None
    count = len(problems)
    hints = get_type_hints(cls)
    fields = {field.name: field for field in _fields(cls)}
    values: dict[str, Any] = {}
    for key, location, value_node in node.entries:
        if key not in fields:
            allowed = ", ".join(fields)
            problems.append(Problem(location, f'unknown key "{key}"{nearest(key, fields)} (allowed: {allowed})', path))
            continue
        values[key] = _read(value_node, hints[key], fields[key].metadata, problems, _join(path, key))
    missing = [name for name, field in fields.items() if name not in values and _is_required(field)]
    for name in missing:
        problems.append(Problem(node.location, f'missing key "{name}"', path))
    if len(problems) > count:
        return None
    return _construct(node, cls, values, problems, path)


def _fields(cls: type) -> list[dataclasses.Field[Any]]:
    return [field for field in dataclasses.fields(cls) if field.init]  # type: ignore[arg-type]


def _is_required(field: dataclasses.Field[Any]) -> bool:
    return field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING


def _join(path: str, key: str) -> str:
    return f"{path}.{key}" if path else key


def _construct(node: Node, cls: type[T], values: dict[str, Any], problems: list[Problem], path: str) -> T | None:
    try:
        return cls(**values)
    except ValueError as error:
        key = getattr(error, "key", None)
        message = getattr(error, "message", str(error))
        culprit = node.get(key) if isinstance(key, str) else None
        if isinstance(key, str) and culprit is not None:
            problems.append(Problem(culprit.location, message, _join(path, key)))
        else:
            problems.append(Problem(node.location, str(error), path))
        return None


def _read(node: Node, hint: Any, metadata: Mapping[str, Any], problems: list[Problem], path: str) -> Any:
    """The value of a node after a type hint, or `_UNUSABLE` with its problem appended."""
    origin = get_origin(hint)
    if origin in (Union, types.UnionType):
        return _read_optional(node, hint, metadata, problems, path)
    if origin is tuple:
        return _read_tuple(node, get_args(hint), metadata, problems, path)
    if hint is Node:
        return node
    if dataclasses.is_dataclass(hint) and isinstance(hint, type):
        instance = read_dataclass(node, hint, problems, path)
        return _UNUSABLE if instance is None else instance
    if isinstance(hint, type) and issubclass(hint, Enum):
        return _read_enum(node, hint, problems, path)
    return _read_scalar(node, hint, metadata, problems, path)


def _read_optional(node: Node, hint: Any, metadata: Mapping[str, Any], problems: list[Problem], path: str) -> Any:
    options = [option for option in get_args(hint) if option is not type(None)]
    if len(options) != 1 or len(get_args(hint)) != 2:
        raise TypeError(f"{path}: cannot read {hint} from YAML; a union may only add None")
    if node.kind is Kind.SCALAR and node.value is None:
        return None
    return _read(node, options[0], metadata, problems, path)


def _read_tuple(
    node: Node, hints: tuple[Any, ...], metadata: Mapping[str, Any], problems: list[Problem], path: str
) -> Any:
    any_length = len(hints) == 2 and hints[1] is Ellipsis
    needs = "a list" if any_length else f"a list of {len(hints)} values"
    if node.kind is not Kind.SEQUENCE:
        problems.append(Problem(node.location, f"got {node.describe()}, needs {needs}", path))
        return _UNUSABLE
    if not any_length and len(node.elements) != len(hints):
        problems.append(Problem(node.location, f"got a list of {len(node.elements)} values, needs {needs}", path))
        return _UNUSABLE
    element_hints = [hints[0]] * len(node.elements) if any_length else hints
    values = tuple(
        _read(element, hint, metadata, problems, f"{path}[{index}]")
        for index, (element, hint) in enumerate(zip(node.elements, element_hints, strict=True))
    )
    return _UNUSABLE if any(value is _UNUSABLE for value in values) else values


def _read_enum(node: Node, cls: type[Enum], problems: list[Problem], path: str) -> Any:
    if node.kind is Kind.SCALAR:
        for member in cls:
            if member.value == node.value and type(member.value) is type(node.value):
                return member
    names = [str(member.value) for member in cls]
    hint = nearest(node.value, names) if isinstance(node.value, str) else ""
    problems.append(Problem(node.location, f"got {node.describe()}{hint} (allowed: {', '.join(names)})", path))
    return _UNUSABLE


def _read_scalar(node: Node, hint: Any, metadata: Mapping[str, Any], problems: list[Problem], path: str) -> Any:
    if hint not in _NAMES:
        raise TypeError(f"{path}: cannot read {hint} from YAML")
    value = node.value
    fits = type(value) is hint or (hint is float and type(value) is int)
    if node.kind is not Kind.SCALAR or not fits:
        problems.append(
            Problem(node.location, f"got {node.describe()}, needs {_NAMES[hint]}{_quote_hint(node, hint)}", path)
        )
        return _UNUSABLE
    refusal = _out_of_range(node, metadata)
    if refusal:
        problems.append(Problem(node.location, refusal, path))
        return _UNUSABLE
    return float(value) if hint is float else value  # type: ignore[arg-type]


def _quote_hint(node: Node, hint: type) -> str:
    is_plain_value = node.kind is Kind.SCALAR and node.value is not None
    return " (quote it)" if hint is str and is_plain_value else ""


def _out_of_range(node: Node, metadata: Mapping[str, Any]) -> str:
    """Why the metadata of a field refuses a value; empty where it allows it."""
    value, choices = node.value, metadata.get("choices")
    if choices is not None and value not in choices:
        hint = nearest(value, choices) if isinstance(value, str) else ""
        return f"got {node.describe()}{hint} (allowed: {', '.join(str(choice) for choice in choices)})"
    if isinstance(value, bool) or not isinstance(value, int | float):
        return ""
    if isinstance(value, float) and not math.isfinite(value):
        return f"got {node.describe()}, needs a finite number"
    low, high = metadata.get("minimum"), metadata.get("maximum")
    if (low is None or value >= low) and (high is None or value <= high):
        return ""
    unit = metadata.get("unit", "1")
    bounds = f"{'-inf' if low is None else f'{low:g}'} .. {'inf' if high is None else f'{high:g}'}"
    return f"got {node.describe()}, allowed: {bounds}{'' if unit == '1' else f' {unit}'}"
