"""The leaves that a tree file may name."""

from __future__ import annotations

import re
from typing import TypeVar

from behaviors.leaf import Leaf, declared_ports

L = TypeVar("L", bound=type[Leaf])

RESERVED_KEYS = ("name", "in", "out", "child", "children", "condition")
OWN_NAMES = ("context", "inhibitors", "node_path", "ports", "reason", *(name for name in vars(Leaf) if name[0] != "_"))
_NAME = re.compile(r"[A-Z][A-Za-z0-9]*")


class RegistrationError(ValueError):
    """A leaf class that cannot be registered."""


class Registry:
    """Leaf classes by name; `leaf` is the registry that everything shipped is in."""

    def __init__(self) -> None:
        self._leaves: dict[str, type[Leaf]] = {}

    def __call__(self, cls: L) -> L:
        """Register a leaf class under its own name; for use as a decorator.

        Raises:
            RegistrationError: where name, ports or parameters would not be understood in a tree file.
        """
        name = cls.__name__
        if not _NAME.fullmatch(name):
            raise RegistrationError(f"{name}: a leaf is named in CamelCase")
        if name in self._leaves:
            raise RegistrationError(f"{name}: already registered by {self._leaves[name].__module__}")
        if not (cls.__doc__ or "").strip():
            raise RegistrationError(f"{name}: a leaf needs a docstring, its first line is shown to operators")
        for port in declared_ports(cls):
            if port in OWN_NAMES:
                raise RegistrationError(f"{name}.{port}: this name belongs to every leaf")
        for key in getattr(cls.Parameters, "__dataclass_fields__", {}):
            if key in RESERVED_KEYS:
                raise RegistrationError(f"{name}.{key}: a parameter may not be named {', '.join(RESERVED_KEYS)}")
        self._leaves[name] = cls
        return cls

    def get(self, name: str) -> type[Leaf] | None:
        """The class of a name; None where there is none."""
        return self._leaves.get(name)

    @property
    def names(self) -> tuple[str, ...]:
        """All names, sorted."""
        return tuple(sorted(self._leaves))

    @property
    def classes(self) -> tuple[type[Leaf], ...]:
        """All classes, sorted by name."""
        return tuple(self._leaves[name] for name in self.names)


leaf = Registry()
