"""Typed parameters: one frozen class is the source of default, unit, range and meaning.

Config files, `--set`, the editor schema and the documentation are made from the field metadata written here.
"""

import dataclasses
import math
from collections.abc import Sequence
from typing import Any, TypeVar, dataclass_transform

T = TypeVar("T")


class ParameterError(ValueError):
    """A parameter value that its class does not allow; `key` names it."""

    def __init__(self, key: str, message: str) -> None:
        super().__init__(f"{key}: {message}")
        self.key = key
        self.message = message


def parameter(
    default: Any,
    *,
    unit: str,
    meaning: str,
    minimum: float | None = None,
    maximum: float | None = None,
    choices: Sequence[str] | None = None,
) -> Any:
    """Declare one parameter with its default, unit ("1" where it has none), allowed range and one line of meaning."""
    metadata = {
        "unit": unit,
        "meaning": meaning,
        "minimum": minimum,
        "maximum": maximum,
        "choices": None if choices is None else tuple(choices),
    }
    return dataclasses.field(default=default, metadata=metadata)


@dataclass_transform(frozen_default=True, kw_only_default=True)
def parameters(cls: type[T]) -> type[T]:
    """Make a class of `parameter` fields into a frozen dataclass that refuses values out of range.

    Raises:
        ParameterError: on construction, where a value has the wrong type or lies out of range.
    """
    cls.__post_init__ = _validate  # type: ignore[attr-defined]
    return dataclasses.dataclass(frozen=True, kw_only=True, slots=True)(cls)


def _validate(instance: Any) -> None:
    for field in dataclasses.fields(instance):
        if field.metadata:
            check_value(field.name, getattr(instance, field.name), field.default, field.metadata)


def check_value(key: str, value: Any, default: Any, metadata: Any) -> None:
    """Check one value against the type of its default and the range in its metadata.

    A tuple is checked element by element and must have as many elements as its default; one of tuples, or of parameter
    classes, which check themselves, may have any number of them.

    Raises:
        ParameterError: where the value is not allowed; the message names the value and what is allowed.
    """
    if isinstance(default, tuple) and default and dataclasses.is_dataclass(default[0]):
        if not isinstance(value, tuple) or not all(isinstance(element, type(default[0])) for element in value):
            raise ParameterError(key, f"got {value!r}, needs a list of {type(default[0]).__name__}")
        return
    if isinstance(default, tuple) and default and isinstance(default[0], tuple):
        if not isinstance(value, tuple):
            raise ParameterError(key, f"got {value!r}, needs a list")
        for element in value:
            check_value(key, element, default[0], metadata)
        return
    if isinstance(default, tuple):
        if not isinstance(value, tuple) or len(value) != len(default):
            raise ParameterError(key, f"got {value!r}, needs {len(default)} values")
        for element, element_default in zip(value, default, strict=True):
            check_value(key, element, element_default, metadata)
        return
    if isinstance(default, bool) or isinstance(value, bool):
        if not (isinstance(default, bool) and isinstance(value, bool)):
            raise ParameterError(key, f"got {value!r}, needs {_type_name(default)}")
        return
    allowed_type = (int, float) if isinstance(default, float) else type(default)
    if not isinstance(value, allowed_type):
        raise ParameterError(key, f"got {value!r}, needs {_type_name(default)}")
    _check_range(key, value, metadata)


def _check_range(key: str, value: Any, metadata: Any) -> None:
    choices, minimum, maximum = metadata["choices"], metadata["minimum"], metadata["maximum"]
    if choices is not None and value not in choices:
        raise ParameterError(key, f"got {value!r}, allowed: {', '.join(choices)}")
    if isinstance(value, str):
        return
    if not math.isfinite(value):
        raise ParameterError(key, f"got {value!r}, needs a finite number")
    if (minimum is not None and value < minimum) or (maximum is not None and value > maximum):
        low = "-inf" if minimum is None else f"{minimum:g}"
        high = "inf" if maximum is None else f"{maximum:g}"
        unit = "" if metadata["unit"] == "1" else f" {metadata['unit']}"
        raise ParameterError(key, f"got {value!r}, allowed: {low} .. {high}{unit}")


def _type_name(default: Any) -> str:
    names = {bool: "true or false", int: "a whole number", float: "a number", str: "text"}
    return names.get(type(default), type(default).__name__)
