"""A process in place of the panel's, which speaks through the same pipes and behaves as its first argument says.

`leaves FILE`: an operator is there once, then the process ends; started again, nobody is there.
`raves`: an operator is there, and says what makes no sense, as fast as it can.
`breaks FILE`: writes bytes that are no messages at all.
`hangs`: never reads a snapshot.
"""

from __future__ import annotations

import os
import sys
import time
from multiprocessing.connection import Connection
from pathlib import Path

from lookstep.panel.messages import Beat, Ready, write_message

NONSENSE = (
    b"",
    b"{",
    b"\xff" * 50,
    b'{"do": "event", "name": "goal", "value": [NaN, 0, 0]}',
    b'{"do": "speed", "value": -3}',
)


def main(behavior: str, *rest: str) -> None:
    """Behave."""
    *marks, read, write = rest
    snapshots, out = Connection(int(read), writable=False), Connection(int(write), readable=False)
    out.send_bytes(write_message(Ready("nowhere")))
    match behavior:
        case "leaves":
            if not Path(marks[0]).exists():
                Path(marks[0]).touch()
                out.send_bytes(write_message(Beat(True)))
            else:
                wait(snapshots)
        case "raves":
            while True:
                out.send_bytes(write_message(Beat(True)))
                for nonsense in NONSENSE:
                    out.send_bytes(nonsense)
        case "breaks":
            if not Path(marks[0]).exists():
                Path(marks[0]).touch()
                os.write(int(write), b"\x7f" * 1000)
            wait(snapshots)
        case "hangs":
            while os.getppid() != 1:
                time.sleep(0.1)


def wait(snapshots: Connection) -> None:
    """Read until there is nothing any more."""
    try:
        while True:
            snapshots.recv_bytes()
    except (EOFError, OSError):
        pass


if __name__ == "__main__":
    main(*sys.argv[1:])
