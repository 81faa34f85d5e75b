"""The panel's process and the two threads of the robot's that talk with it, each through a pipe of its own."""

from __future__ import annotations

import dataclasses
import json
import os
import subprocess
import sys
import time as wall
from collections.abc import Callable, Sequence
from multiprocessing.connection import Connection
from queue import Empty, SimpleQueue
from threading import Condition, Thread

from lookstep.errors import UserError
from lookstep.pace import Pace
from lookstep.panel.address import Address
from lookstep.panel.messages import LARGEST, Message, MessageError, Ready, Told, read_message
from lookstep.panel.snapshot import Snapshot, SnapshotWriter

SERVER = (sys.executable, "-m", "lookstep.panel.process")

_START_PATIENCE = 120.0  # until the panel is served [s]
_END_PATIENCE = 3.0
_REPEAT = 0.5  # a snapshot is sent again after so long without a newer one [s]
_AT_ONCE, _REST = 50, 0.1  # so many messages, then the reader rests [s]


class Mailbox:
    """Holds the newest snapshot until somebody takes it; older ones are dropped."""

    def __init__(self) -> None:
        self._changed = Condition()
        self._snapshot: Snapshot | None = None
        self._number = 0

    def put(self, snapshot: Snapshot) -> None:
        """Replace what is there; never waits."""
        with self._changed:
            self._snapshot, self._number = snapshot, self._number + 1
            self._changed.notify_all()

    def newest(self, after: int, patience: float) -> tuple[int, Snapshot | None]:
        """The newest with its number, once it has a higher one than `after` or patience ends [s]."""
        with self._changed:
            self._changed.wait_for(lambda: self._number > after, patience)
            return self._number, self._snapshot


class Child:
    """A process that serves the panel.

    Args:
        command: starts it; the numbers of its two pipes are appended.
        address: where it serves.
        mailbox: what it is shown.
        pace: of the simulation.
        take: is called with each message, by a thread of its own.
    """

    def __init__(
        self,
        command: Sequence[str],
        address: Address,
        mailbox: Mailbox,
        pace: Pace,
        take: Callable[[Message], None],
    ) -> None:
        ours_read, theirs_write = os.pipe()
        theirs_read, ours_write = os.pipe()
        try:
            # A session of its own: the terminal's interrupt is for the robot's process, which ends this one.
            self._process = subprocess.Popen(
                (*command, str(theirs_read), str(theirs_write)),
                pass_fds=(theirs_read, theirs_write),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                start_new_session=True,
            )
        finally:
            os.close(theirs_read)
            os.close(theirs_write)
        self._in = Connection(ours_read, writable=False)
        self._out = Connection(ours_write, readable=False)
        self._address, self._mailbox, self._pace, self._take = address, mailbox, pace, take
        self._ready: SimpleQueue[Ready] = SimpleQueue()
        self._threads = [Thread(target=target, daemon=True) for target in (self._write, self._read)]
        for thread in self._threads:
            thread.start()

    @property
    def status(self) -> int | None:
        """Its exit status; None while it runs."""
        return self._process.poll()

    @property
    def ended(self) -> bool:
        """Whether it has ended."""
        return self.status is not None

    def wait_ready(self) -> str:
        """Wait until the panel is served; returns where.

        Raises:
            UserError: where it ends instead, or takes too long.
        """
        begun = wall.monotonic()
        while wall.monotonic() - begun < _START_PATIENCE:
            try:
                return self._ready.get(timeout=0.1).url
            except Empty:
                if self.ended:
                    raise UserError(f"the panel's process has ended with exit status {self.status}") from None
        self.close()
        raise UserError(f"the panel is not served after {_START_PATIENCE:g} s")

    def close(self) -> None:
        """End the process."""
        self._process.terminate()
        try:
            self._process.wait(_END_PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def _write(self) -> None:
        """Send the newest snapshot, and how the simulation is paced, until the process ends."""
        writer, number = SnapshotWriter(), 0
        try:
            self._out.send_bytes(json.dumps(dataclasses.asdict(self._address)).encode())
            while not self.ended:
                number, snapshot = self._mailbox.newest(number, _REPEAT)
                if snapshot is not None:
                    pace = self._pace.state
                    same = pace == snapshot.pace
                    self._out.send_bytes(writer.write(snapshot if same else dataclasses.replace(snapshot, pace=pace)))
        except OSError:
            pass  # The process has ended.
        finally:
            self._out.close()

    def _read(self) -> None:
        """Hand on what the process says, until it ends; a flood is held back in the pipe."""
        since, count = wall.monotonic(), 0
        try:
            while True:
                self._hand_on(self._in.recv_bytes(LARGEST))
                count += 1
                if count >= _AT_ONCE:
                    wall.sleep(max(0.0, _REST - (wall.monotonic() - since)))
                    since, count = wall.monotonic(), 0
        except (EOFError, OSError):
            pass  # The process has ended, or what it says cannot be told apart any more.
        finally:
            self._in.close()
            self._process.kill()

    def _hand_on(self, data: bytes) -> None:
        try:
            message = read_message(data)
        except MessageError as error:
            self._take(Told(f"refused: {error}"))
            return
        if isinstance(message, Ready):
            self._ready.put(message)
        self._take(message)
