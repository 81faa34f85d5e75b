"""A value -> canonical bytes: equal bits give equal bytes, and any other bit gives others.

Encodes None, truth values, numbers, text, enums, numpy arrays (type, shape, content), tuples, lists, sets, dicts
(sorted by their keys' bytes) and dataclasses (class and fields). Every part tells its kind and length, so that no two
values share an encoding; of a large array the content is replaced by its hash. Also finds out whether a value can
change: only an immutable one may be hashed once.
"""

from __future__ import annotations

import dataclasses
import struct
from collections.abc import Callable
from enum import Enum
from functools import lru_cache
from hashlib import blake2b, sha256
from typing import Any

import numpy as np

DIGEST_BYTES = 16
_BULK_BYTES = 4096

_FLOAT = struct.Struct("<cd")
_LENGTH = struct.Struct("<cQ")


class CanonicalError(TypeError):
    """A value of a type that has no canonical encoding."""


def encode(value: Any) -> bytes:
    """The canonical bytes of a value.

    Raises:
        CanonicalError: where the value or a part of it is of a type that has none.
    """
    out = bytearray()
    _append(out, value)
    return bytes(out)


def digest(value: Any) -> tuple[bytes, bool]:
    """A hash of a value's canonical bytes, and whether the value is immutable.

    Raises:
        CanonicalError: as `encode`.
    """
    out = bytearray()
    immutable = _append(out, value)
    return blake2b(out, digest_size=DIGEST_BYTES).digest(), immutable


def _append(out: bytearray, value: Any) -> bool:
    """Append the encoding of a value; returns whether it is immutable."""
    append = _ENCODERS.get(type(value))
    if append is None:
        append = _ENCODERS[type(value)] = _encoder(type(value))
    return append(out, value)


def _append_none(out: bytearray, value: None) -> bool:
    out += b"N"
    return True


def _append_bool(out: bytearray, value: bool) -> bool:
    out += b"T" if value else b"F"
    return True


def _append_int(out: bytearray, value: int) -> bool:
    digits = value.to_bytes((value.bit_length() + 8) // 8, "little", signed=True)
    out += _LENGTH.pack(b"i", len(digits))
    out += digits
    return True


def _append_float(out: bytearray, value: float) -> bool:
    out += _FLOAT.pack(b"f", value)
    return True


def _append_text(out: bytearray, value: str) -> bool:
    data = value.encode()
    out += _LENGTH.pack(b"s", len(data))
    out += data
    return True


def _append_bytes(out: bytearray, value: bytes) -> bool:
    out += _LENGTH.pack(b"b", len(value))
    out += value
    return True


def _append_array(out: bytearray, value: np.ndarray) -> bool:
    out += _array_head(value.dtype, value.shape)
    # An image is hashed where it lies, by the hash for which processors have instructions.
    out += value.tobytes() if value.nbytes <= _BULK_BYTES else sha256(np.ascontiguousarray(value).data).digest()
    return not value.flags.writeable


@lru_cache(maxsize=1024)
def _array_head(dtype: np.dtype[Any], shape: tuple[int, ...]) -> bytes:
    if dtype.hasobject:
        raise CanonicalError("an array of Python objects has no canonical bytes")
    kind = dtype.str.encode()
    return struct.pack(f"<cB{len(kind)}sB{len(shape)}Q", b"a", len(kind), kind, len(shape), *shape)


def _append_number(out: bytearray, value: np.generic) -> bool:
    _append_array(out, np.asarray(value))
    return True


def _append_tuple(out: bytearray, value: tuple[Any, ...]) -> bool:
    out += _LENGTH.pack(b"t", len(value))
    immutable = True
    for element in value:
        immutable &= _append(out, element)
    return immutable


def _append_list(out: bytearray, value: list[Any]) -> bool:
    out += _LENGTH.pack(b"l", len(value))
    for element in value:
        _append(out, element)
    return False


def _append_set(out: bytearray, value: set[Any] | frozenset[Any]) -> bool:
    out += _LENGTH.pack(b"u", len(value))
    for data in sorted(encode(element) for element in value):
        out += data
    return isinstance(value, frozenset)


def _append_dict(out: bytearray, value: dict[Any, Any]) -> bool:
    out += _LENGTH.pack(b"d", len(value))
    for key, element in sorted((encode(key), element) for key, element in value.items()):
        out += key
        _append(out, element)
    return False


def _encoder(cls: type) -> Callable[[bytearray, Any], bool]:
    """How values of a class are encoded."""
    if issubclass(cls, Enum):
        return _enum_encoder(cls)
    if dataclasses.is_dataclass(cls):
        return _dataclass_encoder(cls)
    for base, append in _BASES:
        if issubclass(cls, base):
            return append
    raise CanonicalError(f"{cls.__module__}.{cls.__qualname__} has no canonical bytes; use a frozen dataclass")


def _enum_encoder(cls: type[Enum]) -> Callable[[bytearray, Any], bool]:
    members = {member: _head(b"e", cls, member.name) for member in cls}

    def append(out: bytearray, value: Any) -> bool:
        out += members[value]
        return True

    return append


def _dataclass_encoder(cls: Any) -> Callable[[bytearray, Any], bool]:
    names = tuple(field.name for field in dataclasses.fields(cls))
    head = _head(b"c", cls, ",".join(names))
    frozen = cls.__dataclass_params__.frozen

    def append(out: bytearray, value: Any) -> bool:
        out += head
        immutable = frozen
        for name in names:
            immutable &= _append(out, getattr(value, name))
        return immutable

    return append


def _head(tag: bytes, cls: type, rest: str) -> bytes:
    data = f"{cls.__module__}.{cls.__qualname__}:{rest}".encode()
    return _LENGTH.pack(tag, len(data)) + data


_BASES: tuple[tuple[type, Callable[[bytearray, Any], bool]], ...] = (
    (type(None), _append_none),
    (bool, _append_bool),
    (int, _append_int),
    (float, _append_float),
    (str, _append_text),
    (bytes, _append_bytes),
    (np.ndarray, _append_array),
    (np.generic, _append_number),
    (tuple, _append_tuple),
    (list, _append_list),
    (set, _append_set),
    (frozenset, _append_set),
    (dict, _append_dict),
)
_ENCODERS: dict[type, Callable[[bytearray, Any], bool]] = {
    base: append for base, append in _BASES if base is not np.generic
}
