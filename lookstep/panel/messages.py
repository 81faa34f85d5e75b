"""What the panel may say to the robot's process: one JSON object a message, read with mistrust.

The panel's process faces the network, so nothing that comes from it is unpickled or taken on trust: a message is one of
the classes below or it is refused.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any

from behaviors.operator import OperatorEvent, OperatorEventError, read_event

LARGEST = 64 * 1024  # of one message [bytes]
LONGEST_LINE = 300
FASTEST, SLOWEST = 4.0, 0.05  # a speed that an operator may ask for


class MessageError(ValueError):
    """A message that makes no sense; the text says what was given and what is allowed."""


@dataclass(frozen=True, slots=True)
class Ready:
    """The panel is served.

    Attributes:
        url: where.
    """

    url: str


@dataclass(frozen=True, slots=True)
class Beat:
    """A sign of life, several times a second.

    Attributes:
        led: whether a client that is connected holds control.
    """

    led: bool


@dataclass(frozen=True, slots=True)
class Told:
    """A line for the history: of clients that come and go, of what was refused.

    Attributes:
        text: the line.
    """

    text: str


@dataclass(frozen=True, slots=True)
class Sent:
    """An event of the operator.

    Attributes:
        event: the event.
    """

    event: OperatorEvent


@dataclass(frozen=True, slots=True)
class SetSpeed:
    """Pace the simulation.

    Attributes:
        speed: robot time per wall time.
    """

    speed: float


@dataclass(frozen=True, slots=True)
class SetHalted:
    """Let the simulation stand still, or run again.

    Attributes:
        halted: whether it stands still.
    """

    halted: bool


@dataclass(frozen=True, slots=True)
class StepOnce:
    """Let one tick of a simulation pass that stands still."""


Message = Ready | Beat | Told | Sent | SetSpeed | SetHalted | StepOnce


def write_message(message: Message) -> bytes:
    """As JSON."""
    match message:
        case Sent(event):
            plain: dict[str, Any] = {"do": "event", "name": event.name, "value": event.value}
        case Ready(url):
            plain = {"do": "ready", "value": url}
        case Beat(led):
            plain = {"do": "beat", "value": led}
        case Told(text):
            plain = {"do": "tell", "value": text[:LONGEST_LINE]}
        case SetSpeed(speed):
            plain = {"do": "speed", "value": speed}
        case SetHalted(halted):
            plain = {"do": "halt", "value": halted}
        case StepOnce():
            plain = {"do": "step"}
    return json.dumps(plain).encode()


def read_message(data: bytes) -> Message:
    """From JSON.

    Raises:
        MessageError: where the bytes are no such message.
    """
    if len(data) > LARGEST:
        raise MessageError(f"got a message of {len(data)} bytes, at most {LARGEST} are read")
    try:
        plain = json.loads(data)
    except (ValueError, RecursionError) as error:
        raise MessageError(f"got {_short(data)}, needs JSON") from error
    if not isinstance(plain, dict):
        raise MessageError(f"got {_short(plain)}, needs an object")
    try:
        return _read(plain.get("do"), plain)
    except (OperatorEventError, OverflowError, RecursionError) as error:
        raise MessageError(_short(error)) from error


def _read(do: Any, plain: dict[str, Any]) -> Message:
    value = plain.get("value")
    match do:
        case "event":
            name = plain.get("name")
            _require(isinstance(name, str), plain, "an event's name")
            return Sent(read_event(str(name), value))
        case "ready" | "tell":
            _require(isinstance(value, str) and len(value) <= LONGEST_LINE, plain, "a line of text")
            return Ready(str(value)) if do == "ready" else Told(str(value))
        case "beat" | "halt":
            _require(isinstance(value, bool), plain, "true or false")
            return Beat(bool(value)) if do == "beat" else SetHalted(bool(value))
        case "speed":
            speed = float(value) if isinstance(value, int | float) and not isinstance(value, bool) else 0.0
            _require(SLOWEST <= speed <= FASTEST, plain, f"a speed from {SLOWEST:g} to {FASTEST:g}")
            return SetSpeed(speed)
        case "step":
            return StepOnce()
    raise MessageError(f"got {_short(plain)}, which is nothing that the robot can do")


def _require(holds: bool, plain: Any, needed: str) -> None:
    if not holds:
        raise MessageError(f"got {_short(plain)}, needs {needed}")


def _short(what: Any) -> str:
    text = str(what) if isinstance(what, Exception) else repr(what)
    return text if len(text) <= LONGEST_LINE // 2 else text[: LONGEST_LINE // 2] + " ..."
