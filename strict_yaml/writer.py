"""A parameter class -> the text of its config file, one parameter a line with unit, range and meaning beside it."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Iterator
from enum import Enum
from typing import Any

from strict_yaml.document import parse_document

_INDENT = "  "


def dump_parameters(cls: type, instance: Any = None) -> str:
    """Write the values of an instance, or the defaults of its class, as commented YAML.

    `read_dataclass(parse_document(text), cls, ...)` gives the instance back.
    """
    values = cls() if instance is None else instance
    return "\n".join(_lines(values, indent="")) + "\n"


def _lines(values: Any, indent: str) -> Iterator[str]:
    fields = [field for field in dataclasses.fields(values) if field.init]
    heads: dict[str, str] = {}
    for field in fields:
        value = getattr(values, field.name)
        if _is_table(value):
            heads[field.name] = f"{indent}{field.name}:"
        elif not dataclasses.is_dataclass(value):
            heads[field.name] = f"{indent}{field.name}: {_text(value)}"
    width = max((len(head) for head in heads.values()), default=0)
    for field in fields:
        if field.name in heads:
            remark = _remark(field.metadata)
            yield f"{heads[field.name]:<{width}}  # {remark}" if remark else heads[field.name]
            if _is_table(value := getattr(values, field.name)):
                yield from (f"{indent}{_INDENT}- {_text(row)}" for row in value)
        else:
            yield f"{indent}{field.name}:"
            yield from _lines(getattr(values, field.name), indent + _INDENT)


def _is_table(value: Any) -> bool:
    """Whether a value is written as one row a line."""
    is_row = (
        [isinstance(row, tuple) or dataclasses.is_dataclass(row) for row in value] if isinstance(value, tuple) else []
    )
    return bool(is_row) and all(is_row)


def _remark(metadata: Any) -> str:
    unit = metadata.get("unit", "1")
    parts = [] if unit == "1" else [f"[{unit}]"]
    low, high, choices = metadata.get("minimum"), metadata.get("maximum"), metadata.get("choices")
    if choices is not None:
        parts.append(" | ".join(str(choice) for choice in choices))
    elif low is not None or high is not None:
        parts.append(f"{'-inf' if low is None else f'{low:g}'} .. {'inf' if high is None else f'{high:g}'}")
    head, meaning = " ".join(parts), " ".join(metadata.get("meaning", "").split())
    return f"{head}: {meaning}" if head and meaning else head or meaning


def _text(value: Any) -> str:
    if isinstance(value, tuple):
        return f"[{', '.join(_text(element) for element in value)}]"
    if dataclasses.is_dataclass(value):
        fields = [(field.name, getattr(value, field.name)) for field in dataclasses.fields(value)]
        return f"{{{', '.join(f'{name}: {_text(part)}' for name, part in fields)}}}"
    if isinstance(value, Enum):
        return _text(value.value)
    if value is None:
        return "null"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _text_of_str(value)
    return repr(float(value)) if isinstance(value, float) else repr(value)


def _text_of_str(value: str) -> str:
    """Plain where YAML reads it back as the same text within a list, quoted otherwise."""
    is_plain = value.replace("_", "").replace("/", "").isalnum() and parse_document(value).value == value
    return value if is_plain else json.dumps(value, ensure_ascii=False)
