"""The trace of a run: what happened at every tick, in bits, so that runs are the same if and only if hashes are.

A tick holds every node's status, a hash of every value on the blackboard, the robot's state, the commands sent to it,
the events of its steps and of the operator, and the parameters that changed. It holds no wall time. Hashes are
compared within one machine, and not kept as expectations.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from hashlib import blake2b
from pathlib import Path
from typing import Any, TextIO

from py_trees.common import Status

from behaviors.blackboard import Slot
from behaviors.canonical import DIGEST_BYTES, digest, encode
from behaviors.context import OperatorEvent
from behaviors.node import Node
from behaviors.robot_view import RobotView

_EMPTY = bytes(DIGEST_BYTES)
_STATUS_BYTES = {Status.INVALID: 0, Status.RUNNING: 1, Status.SUCCESS: 2, Status.FAILURE: 3}


@dataclass(frozen=True, slots=True)
class ParameterChange:
    """A parameter that was changed while the tree runs.

    Attributes:
        target: a node's path, or a subject such as "footsteps".
        key: the parameter.
        value: what it is now.
    """

    target: str
    key: str
    value: Any


class Trace:
    """Hashes a run tick by tick and, where a file is given, writes one line of JSON a tick.

    A line holds `tick`, `time`, `hash` of the run so far and, where there are any changes, `status` and `reason` by
    node path, `ports` (hash by key; null for an emptied one), `commands`, `events`, `operator` and `parameters`.
    """

    def __init__(self, path: str | Path | None = None) -> None:
        self._running = blake2b(digest_size=DIGEST_BYTES)
        self._file: TextIO | None = None if path is None else open(path, "w", encoding="utf-8")  # noqa: SIM115 (closed with the trace)
        self._cache: dict[str, tuple[Any, bytes]] = {}
        self._primed: dict[int, tuple[Any, bytes]] = {}
        self._statuses: dict[str, Status] = {}
        self._reasons: dict[str, str] = {}
        self._ports: dict[str, bytes] = {}

    @property
    def hash(self) -> str:
        """Hash of all ticks so far, in hexadecimal digits."""
        return self._running.hexdigest()

    def prime(self, value: Any, hashed: bytes) -> None:
        """Tell the hash of an immutable value that the next tick may find on the blackboard."""
        self._primed[id(value)] = (value, hashed)

    def record(
        self,
        tick: int,
        time: float,
        nodes: tuple[Node, ...],
        slots: tuple[Slot, ...],
        robot: RobotView,
        operator: tuple[OperatorEvent, ...],
        changes: tuple[ParameterChange, ...],
    ) -> None:
        """Take one tick.

        Raises:
            CanonicalError: where a value cannot be hashed.
        """
        update = self._running.update
        if tick == 0:
            update(encode((tuple(node.path for node in nodes), tuple(slot.key for slot in slots))))
        ports = {slot.key: self._digest(slot.key, slot.value) for slot in slots}
        update(encode((tick, time)))
        update(bytes([_STATUS_BYTES[node.status] for node in nodes]))
        update(b"".join(ports.values()))
        self._primed.clear()
        update(self._digest("state of the robot", robot.state()))
        update(self._digest("status of the robot", robot.status()))
        if robot.commands or robot.events or operator or changes:
            update(encode((tuple(robot.commands), robot.events, operator, changes)))
        if self._file is not None:
            self._write(tick, time, nodes, ports, robot, operator, changes)

    def close(self) -> None:
        """End the file."""
        if self._file is not None:
            self._file.close()
            self._file = None

    def _digest(self, key: str, value: Any) -> bytes:
        """The hash of a value; of an immutable one that is still there, the hash made before."""
        if value is None:
            return _EMPTY
        known = self._cache.get(key)
        if known is not None and known[0] is value:
            return known[1]
        primed = self._primed.get(id(value))
        hashed, immutable = digest(value) if primed is None else (primed[1], True)
        if immutable:
            self._cache[key] = (value, hashed)
        return hashed

    def _write(
        self,
        tick: int,
        time: float,
        nodes: tuple[Node, ...],
        ports: dict[str, bytes],
        robot: RobotView,
        operator: tuple[OperatorEvent, ...],
        changes: tuple[ParameterChange, ...],
    ) -> None:
        statuses = {node.path: node.status for node in nodes}
        reasons = {node.path: node.reason for node in nodes}
        line: dict[str, Any] = {"tick": tick, "time": time, "hash": self.hash}
        parts = {
            "status": {path: status.name for path, status in _changed(self._statuses, statuses)},
            "reason": dict(_changed(self._reasons, reasons)),
            "ports": {key: None if data == _EMPTY else data.hex() for key, data in _changed(self._ports, ports)},
            "commands": [{"name": name, "steps": len(steps)} for name, steps in robot.commands],
            "events": [{"kind": event.kind.value, "step": event.step.sequence_id} for event in robot.events],
            "operator": [{"name": event.name, "value": repr(event.value)} for event in operator],
            "parameters": [
                {"target": change.target, "key": change.key, "value": repr(change.value)} for change in changes
            ],
        }
        line.update({name: part for name, part in parts.items() if part})
        self._statuses, self._reasons, self._ports = statuses, reasons, ports
        assert self._file is not None
        self._file.write(json.dumps(line, separators=(",", ":")) + "\n")


def _changed(before: dict[str, Any], after: dict[str, Any]) -> list[tuple[str, Any]]:
    return [(key, value) for key, value in after.items() if before.get(key) != value]
