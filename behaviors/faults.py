"""Faults that are injected on purpose: what breaks, how, and when. A file lists them; without a file nothing breaks.

```yaml
faults:
  - {at: sensor:depth, mode: off, start: 3.0, duration: 2.0}
  - {at: /look_and_step/walk/sequence/go/walk_to/on_the_way/follow_path, mode: exception, start: 8.0}
  - {at: world:block_3, mode: wrong, start: 4.0, shift: [0, 0, -0.05]}
  - {at: operator, mode: off, start: 9.0}
```

What cannot be injected is refused when the file is read, never ignored.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from enum import Enum
from typing import Any

from strict_yaml import Kind, Location, Node, Problem, YamlError, nearest, read_dataclass


class FaultMode(Enum):
    """How something breaks.

    off: nothing new comes, the leaf fails, or the operator is silent. stuck: the old content comes again, or the leaf
    runs for ever. wrong: another content. slow: a computation takes longer. delayed: it comes later. intermittent: it
    comes sometimes. nan: a share of it is not a number. exception: reading or ticking raises. script: the leaf says
    what it is told. fallen, disabled: the robot says that it has fallen, or takes no steps.
    """

    OFF = "off"
    STUCK = "stuck"
    WRONG = "wrong"
    SLOW = "slow"
    DELAYED = "delayed"
    INTERMITTENT = "intermittent"
    NAN = "nan"
    EXCEPTION = "exception"
    SCRIPT = "script"
    FALLEN = "fallen"
    DISABLED = "disabled"


class InjectedFaultError(RuntimeError):
    """What an injected exception raises."""


_IMAGES = (
    FaultMode.OFF,
    FaultMode.STUCK,
    FaultMode.WRONG,
    FaultMode.DELAYED,
    FaultMode.INTERMITTENT,
    FaultMode.NAN,
    FaultMode.EXCEPTION,
)
# What can be broken how.
POSSIBLE: dict[str, tuple[FaultMode, ...]] = {
    "sensor:depth": _IMAGES,
    "sensor:lidar": _IMAGES,
    "sensor:state": (FaultMode.STUCK, FaultMode.WRONG, FaultMode.DELAYED, FaultMode.NAN, FaultMode.EXCEPTION),
    "sensor:status": (FaultMode.STUCK, FaultMode.DELAYED, FaultMode.EXCEPTION, FaultMode.FALLEN, FaultMode.DISABLED),
    "leaf": (
        FaultMode.OFF,
        FaultMode.STUCK,
        FaultMode.WRONG,
        FaultMode.SLOW,
        FaultMode.INTERMITTENT,
        FaultMode.EXCEPTION,
        FaultMode.SCRIPT,
    ),
    "world": (FaultMode.OFF, FaultMode.WRONG),
    "operator": (FaultMode.OFF, FaultMode.WRONG, FaultMode.DELAYED),
}


def _number(default: float, unit: str, meaning: str, minimum: float, maximum: float) -> Any:
    metadata = {"unit": unit, "meaning": meaning, "minimum": minimum, "maximum": maximum}
    return field(default=default, metadata=metadata)


@dataclass(frozen=True, slots=True)
class Fault:
    """One fault.

    Attributes:
        at: `sensor:NAME`, a leaf's path, `world:BLOCK`, or `operator`.
        mode: how it breaks.
        start: robot time at which it begins [s].
        duration: how long it lasts; for ever where 0 [s].
        by: delay, or how much slower [s].
        share: of frames or pixels that are lost, or of attempts that fail.
        scale: of a wrong image's distances.
        shift: of a wrong state or block, x, y, z in the world [m].
        says: what a scripted leaf says, one letter a tick: S, F or R; the last one repeats.
        seed: of what is lost by chance.
    """

    at: str
    mode: FaultMode
    start: float = _number(0.0, "s", "robot time at which it begins", 0.0, 86400.0)
    duration: float = _number(0.0, "s", "how long it lasts; 0: for ever", 0.0, 86400.0)
    by: float = _number(0.3, "s", "delay, or how much slower", 0.0, 60.0)
    share: float = _number(0.3, "1", "of frames, pixels or attempts", 0.0, 1.0)
    scale: float = _number(1.05, "1", "of a wrong image's distances", 0.1, 10.0)
    shift: tuple[float, float, float] = (0.0, 0.0, 0.0)
    says: str = "F"
    seed: int = 0

    @property
    def kind(self) -> str:
        """What it breaks: a key of `POSSIBLE`."""
        return "leaf" if self.at.startswith("/") else "world" if self.at.startswith("world:") else self.at

    @property
    def name(self) -> str:
        """Of the sensor or block."""
        return self.at.partition(":")[2]

    @property
    def end(self) -> float:
        """Robot time at which it ends [s]."""
        return self.start + self.duration if self.duration else math.inf

    def holds(self, time: float) -> bool:
        """Whether it is there at a robot time [s]."""
        return self.start - 1e-9 <= time < self.end - 1e-9


@dataclass(frozen=True, slots=True)
class PlacedFault:
    """A fault, and where it is written."""

    fault: Fault
    location: Location


def read_faults(document: Node) -> tuple[PlacedFault, ...]:
    """The faults of a file.

    Raises:
        YamlError: with every problem found; an injection that is not possible is one.
    """
    problems: list[Problem] = []
    listed = document.get("faults") if document.kind is Kind.MAPPING else None
    for entry in document.entries:
        if entry.key != "faults":
            problems.append(Problem(entry.location, f'unknown key "{entry.key}" (keys of a fault file: faults)'))
    if listed is None or listed.kind is not Kind.SEQUENCE:
        place = document if listed is None else listed
        problems.append(
            Problem(place.location, 'needs a list "faults", such as faults: [{at: sensor:depth, mode: off}]')
        )
        raise YamlError(problems)
    faults = []
    for index, element in enumerate(listed.elements):
        path = f"faults[{index}]"
        fault = read_dataclass(element, Fault, problems, path)
        if fault is not None:
            faults.append(PlacedFault(fault, element.location))
            _check(fault, element, path, problems)
    if problems:
        raise YamlError(problems)
    return tuple(faults)


def _check(fault: Fault, node: Node, path: str, problems: list[Problem]) -> None:
    at, mode = node.get("at"), node.get("mode")
    assert at is not None and mode is not None, "both are required"
    possible = POSSIBLE.get(fault.kind)
    if possible is None:
        allowed = (*(name for name in POSSIBLE if ":" in name), "world:BLOCK", "/path/of/a/leaf", "operator")
        hint = nearest(fault.at, POSSIBLE)
        message = f'nothing to break at "{fault.at}"{hint} (allowed: {", ".join(allowed)})'
        problems.append(Problem(at.location, message, f"{path}.at"))
    elif fault.mode not in possible:
        names = ", ".join(allowed.value for allowed in possible)
        message = f'"{fault.mode.value}" cannot be injected at {fault.at} (allowed there: {names})'
        problems.append(Problem(mode.location, message, f"{path}.mode"))
    if not fault.says or set(fault.says) - set("SFR"):
        place = node.get("says") or node
        problems.append(Problem(place.location, f'got "{fault.says}", needs letters S, F and R', f"{path}.says"))
