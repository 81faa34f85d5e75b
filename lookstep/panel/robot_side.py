"""The panel's side of the two pipes: snapshots come in, messages go out, and neither ever holds the other up."""

from __future__ import annotations

import json
from collections import OrderedDict
from multiprocessing.connection import Connection
from threading import Condition, Event, Thread
from typing import Any

from behaviors.operator import ChangeParameter, MoveBox, MoveCarrot
from lookstep.panel.address import Address
from lookstep.panel.messages import Beat, Message, Sent, SetSpeed, write_message
from lookstep.panel.snapshot import Snapshot, SnapshotReader

_MOST_WAITING = 200


class RobotSide:
    """What the panel knows of the robot's process.

    Args:
        read, write: numbers of the two pipes.
    """

    def __init__(self, read: int, write: int) -> None:
        self._in, self._out = Connection(read, writable=False), Connection(write, readable=False)
        self.address = Address(**json.loads(self._in.recv_bytes()))
        self.ended = Event()
        self._changed = Condition()
        self._snapshot: Snapshot | None = None
        self._number = 0
        self._waiting: OrderedDict[Any, Message] = OrderedDict()
        Thread(target=self._read, daemon=True).start()
        Thread(target=self._write, daemon=True).start()

    def newest(self, after: int, patience: float) -> tuple[int, Snapshot | None]:
        """The newest snapshot with its number, once it has a higher one than `after` or patience ends [s]."""
        with self._changed:
            self._changed.wait_for(lambda: self._number > after or self.ended.is_set(), patience)
            return self._number, self._snapshot

    def send(self, message: Message) -> bool:
        """Let a message go out; False where so many wait that it is dropped.

        Of a slider, a carrot or a block that is moved on while an older message waits, only the newest place goes out.
        """
        with self._changed:
            key = _key(message) or object()
            if key not in self._waiting and len(self._waiting) >= _MOST_WAITING:
                return False
            self._waiting[key] = message
            self._changed.notify_all()
            return True

    def _read(self) -> None:
        reader = SnapshotReader()
        try:
            while True:
                snapshot = reader.read(self._in.recv_bytes())
                with self._changed:
                    self._snapshot, self._number = snapshot, self._number + 1
                    self._changed.notify_all()
        except (EOFError, OSError):
            self._end()

    def _write(self) -> None:
        try:
            while not self.ended.is_set():
                with self._changed:
                    self._changed.wait_for(lambda: bool(self._waiting) or self.ended.is_set())
                    message = self._waiting.popitem(last=False)[1] if self._waiting else None
                if message is not None:
                    self._out.send_bytes(write_message(message))
        except OSError:
            self._end()

    def _end(self) -> None:
        with self._changed:
            self.ended.set()
            self._changed.notify_all()


def _key(message: Message) -> Any:
    """What a newer message takes the place of; None where every one counts."""
    match message:
        case Sent(ChangeParameter(target, key, _)):
            return "parameter", target, key
        case Sent(MoveBox(box, _, _)):
            return "box", box
        case Sent(MoveCarrot()):
            return "carrot"
        case Beat():
            return "beat"
        case SetSpeed():
            return "speed"
    return None
