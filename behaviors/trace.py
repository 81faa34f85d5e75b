"""The trace of a run: what happened at every tick, in bits, so that runs are the same if and only if hashes are.

A tick holds every node's status, a hash of every value on the blackboard, the robot's state, the commands sent to it,
the events of its steps and of the operator, and the parameters that changed. It holds no wall time. Hashes are
compared within one machine, and not kept as expectations.
"""

from __future__ import annotations

from dataclasses import dataclass
from hashlib import blake2b
from pathlib import Path
from typing import TYPE_CHECKING, Any

from py_trees.common import Status

from behaviors.blackboard import Slot
from behaviors.canonical import DIGEST_BYTES, digest, encode
from behaviors.node import Node
from behaviors.operator import OperatorEvent
from behaviors.robot_view import RobotView
from behaviors.trace_file import TraceFile

if TYPE_CHECKING:
    from behaviors.spec import TreeSpec

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


@dataclass(frozen=True, slots=True)
class Unrecorded:
    """Stands on the blackboard for a recorded value that was too large for the trace, of which its hash is known."""

    hashed: bytes


@dataclass(frozen=True, slots=True)
class Happened:
    """What came to a tree from outside in one tick.

    Attributes:
        operator: what the operator did.
        changes: parameters that were changed.
        inputs: values that were given to the tree from outside, by key.
        delivered: nodes whose computations ended, in order.
    """

    operator: tuple[OperatorEvent, ...] = ()
    changes: tuple[ParameterChange, ...] = ()
    inputs: tuple[tuple[str, Any], ...] = ()
    delivered: tuple[str, ...] = ()


class Trace:
    """Hashes a run tick by tick and, where a path is given, writes it to a file (`trace_file.py`)."""

    def __init__(self, path: str | Path | None = None) -> None:
        self._running = blake2b(digest_size=DIGEST_BYTES)
        self._file = None if path is None else TraceFile(path)
        self._cache: dict[str, tuple[Any, bytes]] = {}
        self._primed: dict[int, tuple[Any, bytes]] = {}

    @property
    def hash(self) -> str:
        """Hash of all ticks so far, in hexadecimal digits."""
        return self._running.hexdigest()

    def prime(self, value: Any, hashed: bytes) -> None:
        """Tell the hash of an immutable value that the next tick may find on the blackboard."""
        self._primed[id(value)] = (value, hashed)

    def begin(self, spec: TreeSpec, rate: float, nodes: tuple[Node, ...], slots: tuple[Slot, ...]) -> None:
        """Take the tree that the ticks to come belong to."""
        self._running.update(encode((tuple(node.path for node in nodes), tuple(slot.key for slot in slots))))
        if self._file is not None:
            self._file.begin(spec, rate, nodes)

    def record(
        self,
        tick: int,
        time: float,
        nodes: tuple[Node, ...],
        slots: tuple[Slot, ...],
        robot: RobotView,
        happened: Happened,
    ) -> None:
        """Take one tick.

        Raises:
            CanonicalError: where a value cannot be hashed.
        """
        update = self._running.update
        ports = {slot.key: self._digest(slot.key, slot.value) for slot in slots}
        update(encode((tick, time)))
        update(bytes([_STATUS_BYTES[node.status] for node in nodes]))
        update(b"".join(ports.values()))
        self._primed.clear()
        state = self._digest("state of the robot", robot.state()) + self._digest("status of the robot", robot.status())
        update(state)
        if robot.commands or robot.events or happened.operator or happened.changes or happened.inputs:
            commands = tuple((command.name, command.steps) for command in robot.commands)
            update(encode((commands, robot.events, happened.operator, happened.changes, happened.inputs)))
        if self._file is not None:
            head = {"tick": tick, "time": time, "hash": self.hash, "robot": blake2b(state, digest_size=8).hexdigest()}
            self._file.write(head, nodes, slots, ports, robot, happened)

    def close(self) -> None:
        """End the file."""
        if self._file is not None:
            self._file.close()
            self._file = None

    def _digest(self, key: str, value: Any) -> bytes:
        """The hash of a value; of an immutable one that is still there, the hash made before."""
        if value is None:
            return _EMPTY
        if isinstance(value, Unrecorded):
            return value.hashed
        known = self._cache.get(key)
        if known is not None and known[0] is value:
            return known[1]
        primed = self._primed.get(id(value))
        hashed, immutable = digest(value) if primed is None else (primed[1], True)
        if immutable:
            self._cache[key] = (value, hashed)
        return hashed
