"""A parameter class -> JSON Schema, so that editors complete, explain and check its YAML."""

from __future__ import annotations

import dataclasses
import types
from enum import Enum
from typing import Any, Union, get_args, get_origin, get_type_hints

Schema = dict[str, Any]

_TYPES: dict[Any, str] = {bool: "boolean", int: "integer", float: "number", str: "string"}


def dataclass_schema(cls: type, description: str = "") -> Schema:
    """The schema of a mapping that `read_dataclass` reads into a class."""
    fields = [field for field in dataclasses.fields(cls) if field.init]
    hints = get_type_hints(cls)
    properties = {field.name: property_schema(field, hints[field.name]) for field in fields}
    required = [
        field.name
        for field in fields
        if field.default is dataclasses.MISSING and field.default_factory is dataclasses.MISSING
    ]
    schema: Schema = {"type": "object", "properties": properties, "additionalProperties": False}
    if required:
        schema["required"] = required
    return {"description": description, **schema} if description else schema


def property_schema(field: dataclasses.Field[Any], hint: Any = None) -> Schema:
    """The schema of one field: type, range, choices, default, and its meaning with the unit.

    Args:
        field: of a dataclass.
        hint: its type; that of its default where None.
    """
    default = field.default
    schema = _of_type(type(default) if hint is None else hint, field.metadata)
    if default is not dataclasses.MISSING:
        schema["default"] = _plain(default)
    unit, meaning = field.metadata.get("unit", "1"), field.metadata.get("meaning", "")
    text = " ".join(part for part in ("" if unit == "1" else f"[{unit}]", meaning) if part)
    if text:
        schema |= {"description": text, "markdownDescription": text}
    return schema


def _of_type(hint: Any, metadata: Any) -> Schema:
    origin = get_origin(hint)
    if origin in (Union, types.UnionType):
        options = [_of_type(option, metadata) for option in get_args(hint) if option is not type(None)]
        return {"anyOf": [*options, {"type": "null"}]}
    if origin is tuple:
        hints = get_args(hint)
        if len(hints) == 2 and hints[1] is Ellipsis:
            return {"type": "array", "items": _of_type(hints[0], metadata)}
        items = [_of_type(element, metadata) for element in hints]
        return {"type": "array", "items": items, "minItems": len(items), "maxItems": len(items)}
    if isinstance(hint, type) and issubclass(hint, Enum):
        return {"enum": [member.value for member in hint]}
    if dataclasses.is_dataclass(hint) and isinstance(hint, type):
        return dataclass_schema(hint)
    if hint not in _TYPES:
        return {}
    schema: Schema = {"type": _TYPES[hint]}
    if metadata.get("choices") is not None:
        return {"enum": list(metadata["choices"])}
    if hint in (int, float):
        for key in ("minimum", "maximum"):
            if metadata.get(key) is not None:
                schema[key] = metadata[key]
    return schema


def _plain(value: Any) -> Any:
    if isinstance(value, tuple):
        return [_plain(element) for element in value]
    if isinstance(value, Enum):
        return value.value
    if dataclasses.is_dataclass(value):
        return {field.name: _plain(getattr(value, field.name)) for field in dataclasses.fields(value)}
    return value
