"""Ports: what a leaf takes from the blackboard and gives to it, declared once with a type and one line of meaning.

A port is a class attribute of a leaf. Reading `self.regions` gives the value that is wired to it now; assigning
`self.plan = plan` hands a value on. One port carries one object: values are immutable and handed on as they are.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Generic, TypeVar, overload

from py_trees.common import Status

if TYPE_CHECKING:
    from behaviors.leaf import Leaf

T = TypeVar("T")


class InputPort(Generic[T]):
    """What both kinds of inputs declare.

    Attributes:
        type: what the leaf can take.
        meaning: one line for the operator and the documentation.
        unit: of a number, or of the numbers inside; "1" where there is none.
        frame: in which the coordinates inside are given; empty where there are none, or the value itself says it.
        default: stands in while nothing is wired or written.
        required: whether it must be wired, and the leaf waits for a value.
        when_missing: status of the leaf while a required value is missing: RUNNING waits, FAILURE gives up.
    """

    def __init__(
        self,
        type: type[T],
        meaning: str,
        unit: str,
        frame: str,
        default: T | None,
        required: bool,
        when_missing: Status,
    ) -> None:
        self.type = type
        self.meaning = meaning
        self.unit = unit
        self.frame = frame
        self.default = default
        self.required = required
        self.when_missing = when_missing
        self.name = ""

    def __set_name__(self, owner: Any, name: str) -> None:
        self.name = name

    def __set__(self, leaf: Leaf, value: Any) -> None:
        raise AttributeError(f"input {self.name!r} cannot be written; declare an Output")

    def _read(self, leaf: Leaf) -> T | None:
        slot = leaf.ports.get(self.name)
        return self.default if slot is None or slot.value is None else slot.value


class Input(InputPort[T]):
    """A value that a leaf needs; with a default, it need be neither wired nor written."""

    def __init__(
        self,
        type: type[T],
        meaning: str,
        *,
        unit: str = "1",
        frame: str = "",
        default: T | None = None,
        when_missing: Status = Status.RUNNING,
    ) -> None:
        super().__init__(type, meaning, unit, frame, default, default is None, when_missing)

    @overload
    def __get__(self, leaf: None, owner: Any) -> Input[T]: ...
    @overload
    def __get__(self, leaf: Leaf, owner: Any) -> T: ...
    def __get__(self, leaf: Leaf | None, owner: Any) -> Any:
        return self if leaf is None else self._read(leaf)


class OptionalInput(InputPort[T]):
    """A value that a leaf can do without: reading gives None where nothing is wired or written."""

    def __init__(self, type: type[T], meaning: str, *, unit: str = "1", frame: str = "") -> None:
        super().__init__(type, meaning, unit, frame, None, False, Status.RUNNING)

    @overload
    def __get__(self, leaf: None, owner: Any) -> OptionalInput[T]: ...
    @overload
    def __get__(self, leaf: Leaf, owner: Any) -> T | None: ...
    def __get__(self, leaf: Leaf | None, owner: Any) -> Any:
        return self if leaf is None else self._read(leaf)


class Output(Generic[T]):
    """A value that a leaf gives; assigning None takes it back.

    Attributes:
        type: what the leaf gives.
        meaning: one line for the operator and the documentation.
        unit: of a number, or of the numbers inside; "1" where there is none.
        frame: in which the coordinates inside are given; empty where there are none, or the value itself says it.
    """

    def __init__(self, type: type[T], meaning: str, *, unit: str = "1", frame: str = "") -> None:
        self.type = type
        self.meaning = meaning
        self.unit = unit
        self.frame = frame
        self.name = ""

    def __set_name__(self, owner: Any, name: str) -> None:
        self.name = name

    @overload
    def __get__(self, leaf: None, owner: Any) -> Output[T]: ...
    @overload
    def __get__(self, leaf: Leaf, owner: Any) -> T | None: ...
    def __get__(self, leaf: Leaf | None, owner: Any) -> Any:
        return self if leaf is None else leaf.ports[self.name].value

    def __set__(self, leaf: Leaf, value: T | None) -> None:
        if not leaf.inhibitors:
            leaf.ports[self.name].write(value)


def declared_inputs(cls: type) -> dict[str, InputPort[Any]]:
    """The inputs of a leaf class by name, in order of declaration, base classes first."""
    return {name: port for name, port in _declared(cls).items() if isinstance(port, InputPort)}


def declared_outputs(cls: type) -> dict[str, Output[Any]]:
    """The outputs of a leaf class by name, in order of declaration, base classes first."""
    return {name: port for name, port in _declared(cls).items() if isinstance(port, Output)}


def _declared(cls: type) -> dict[str, Any]:
    ports: dict[str, Any] = {}
    for base in reversed(cls.__mro__):
        ports.update({name: value for name, value in vars(base).items() if isinstance(value, InputPort | Output)})
    return ports
