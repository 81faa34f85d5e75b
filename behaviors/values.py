"""A value <-> plain JSON, exactly: what is read back has the same bits, and so the same canonical hash.

Numbers, texts and None stand for themselves; all else is a mapping with one key that begins with `$`. A class is named
by module and name, and only dataclasses and enums of modules that are loaded already are ever made, so that reading a
trace runs nobody's code.
"""

from __future__ import annotations

import base64
import dataclasses
import math
import sys
from enum import Enum
from typing import Any

import numpy as np


class ValueFormatError(ValueError):
    """JSON that no value was written as, or a value that has no JSON."""


def to_json(value: Any) -> Any:
    """What `json.dumps` takes.

    Raises:
        ValueFormatError: where the value or a part of it is of another type than those that ports carry.
    """
    match value:
        case None | bool() | str():
            return value
        case Enum():
            return {"$enum": _class_name(type(value)), "name": value.name}
        case np.ndarray() | np.generic():
            array = np.ascontiguousarray(value)
            if array.dtype.hasobject:
                raise ValueFormatError("an array of Python objects cannot be written")
            data = base64.b64encode(array.tobytes()).decode()
            kind = "$array" if isinstance(value, np.ndarray) else "$number"
            return {kind: value.dtype.str, "shape": list(value.shape), "data": data}
        case int():
            return value
        case float():
            return value if math.isfinite(value) else {"$float": repr(value)}
        case bytes():
            return {"$bytes": base64.b64encode(value).decode()}
        case tuple():
            return {"$tuple": [to_json(element) for element in value]}
        case list():
            return [to_json(element) for element in value]
        case set() | frozenset():
            ordered = sorted(value, key=repr)
            return {"$set": [to_json(element) for element in ordered], "frozen": isinstance(value, frozenset)}
        case dict():
            return {"$dict": [[to_json(key), to_json(element)] for key, element in value.items()]}
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        fields = {field.name: to_json(getattr(value, field.name)) for field in dataclasses.fields(value)}
        return {"$class": _class_name(type(value)), "fields": fields}
    raise ValueFormatError(f"{type(value).__module__}.{type(value).__qualname__} cannot be written; use a dataclass")


def from_json(data: Any) -> Any:
    """The value that `to_json` wrote.

    Raises:
        ValueFormatError: where it did not, or a class is not loaded.
    """
    if isinstance(data, list):
        return [from_json(element) for element in data]
    if not isinstance(data, dict):
        return data
    try:
        return _special(data)
    except ValueFormatError:
        raise
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise ValueFormatError(f"not a value of a trace: {error}") from error


def _special(data: dict[str, Any]) -> Any:
    match next(iter(data), ""):
        case "$float":
            return float(data["$float"])
        case "$bytes":
            return base64.b64decode(data["$bytes"])
        case "$tuple":
            return tuple(from_json(element) for element in data["$tuple"])
        case "$set":
            return (frozenset if data["frozen"] else set)(from_json(element) for element in data["$set"])
        case "$dict":
            return {from_json(key): from_json(element) for key, element in data["$dict"]}
        case "$array":
            return _array(data["$array"], data)
        case "$number":
            return _array(data["$number"], data)[()]
        case "$enum":
            cls = _find_class(data["$enum"])
            if not issubclass(cls, Enum):
                raise ValueFormatError(f"{data['$enum']} is no enum")
            return cls[data["name"]]
        case "$class":
            return _instance(_find_class(data["$class"]), data["fields"])
    raise ValueFormatError(f"not a value of a trace: a mapping with the keys {', '.join(data)}")


def _array(dtype: str, data: dict[str, Any]) -> np.ndarray:
    kind = np.dtype(dtype)
    if kind.hasobject:
        raise ValueFormatError("an array of Python objects cannot be read")
    array = np.frombuffer(base64.b64decode(data["data"]), kind).reshape(data["shape"])
    array.flags.writeable = False
    return array


def _instance(cls: type, fields: dict[str, Any]) -> Any:
    if not dataclasses.is_dataclass(cls):
        raise ValueFormatError(f"{cls.__qualname__} is no dataclass")
    values = {name: from_json(value) for name, value in fields.items()}
    made = cls(**{field.name: values.pop(field.name) for field in dataclasses.fields(cls) if field.init})
    return made


def _class_name(cls: type) -> str:
    return f"{cls.__module__}:{cls.__qualname__}"


def _find_class(name: str) -> type:
    module, _, path = name.partition(":")
    if module not in sys.modules:
        raise ValueFormatError(f"class {name} is not loaded; import what it belongs to first")
    found: Any = sys.modules[module]
    for part in path.split("."):
        found = getattr(found, part)
    if not isinstance(found, type):
        raise ValueFormatError(f"{name} is no class")
    return found


def is_small(value: Any, limit: int) -> bool:
    """Whether a value takes fewer than so many bytes, roughly; stops looking where it does not."""
    return _rest(value, limit) > 0


def _rest(value: Any, rest: int) -> int:
    """What is left of so many bytes after a value; negative or zero where it does not fit."""
    rest -= 8
    if rest <= 0 or value is None or isinstance(value, bool | int | float | Enum):
        return rest
    if isinstance(value, np.ndarray):
        return rest - value.nbytes
    if isinstance(value, str | bytes):
        return rest - len(value)
    parts: Any = ()
    if isinstance(value, tuple | list | set | frozenset):
        parts = value
    elif isinstance(value, dict):
        parts = (part for item in value.items() for part in item)
    elif dataclasses.is_dataclass(value):
        parts = (getattr(value, field.name) for field in dataclasses.fields(value))
    for part in parts:
        rest = _rest(part, rest)
        if rest <= 0:
            return rest
    return rest
