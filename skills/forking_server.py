"""Computes outside of our process: one forked child a request, from a server that has loaded what it takes.

For libraries that keep all threads of a process from getting on, or that give the same answer only once a process. A
child that dies is told by how it died.
"""

from __future__ import annotations

import os
import pickle
import struct
import subprocess
import sys
import threading
from collections.abc import Callable, Sequence
from typing import IO, Any

_LENGTH = struct.Struct("<Q")


class ServerError(RuntimeError):
    """A child or the server died, or the computation raised; the message says what happened."""


class ForkingServer:
    """Starts with the first request, and again with the next after it has died; one request at a time.

    Args:
        command: what starts the server: a process that calls `serve`.
    """

    def __init__(self, command: Sequence[str]) -> None:
        self._command = tuple(command)
        self._lock = threading.Lock()
        self._process: subprocess.Popen[bytes] | None = None

    def ask(self, request: Any) -> Any:
        """What a child answers to a request.

        Raises:
            ServerError: where the child or the server dies, or the computation raises.
        """
        with self._lock:
            process = self._running()
            assert process.stdin is not None and process.stdout is not None
            try:
                _send(process.stdin, pickle.dumps(request, protocol=pickle.HIGHEST_PROTOCOL))
                answer = _receive(process.stdout)
            except OSError:
                answer = None
            if answer is None:
                self._process = None
                raise ServerError(f"the server has ended with code {process.wait()}")
        failure, result = pickle.loads(answer)
        if failure:
            raise ServerError(failure)
        return result

    def close(self) -> None:
        """End the server."""
        with self._lock:
            if self._process is not None and self._process.stdin is not None:
                self._process.stdin.close()
                self._process.wait()
            self._process = None

    def _running(self) -> subprocess.Popen[bytes]:
        if self._process is None or self._process.poll() is not None:
            self._process = subprocess.Popen(self._command, stdin=subprocess.PIPE, stdout=subprocess.PIPE)
        return self._process


def serve(compute: Callable[[Any], Any]) -> None:
    """Answer requests from standard input on standard output until there are no more, each in a forked child."""
    requests, answers = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # What a library prints is no answer.
    while (request := _receive(requests)) is not None:
        read_end, write_end = os.pipe()
        child = os.fork()
        if child == 0:
            os.close(read_end)
            _answer(compute, request, write_end)
        os.close(write_end)
        with os.fdopen(read_end, "rb") as pipe:
            answer = pipe.read()
        code = os.waitstatus_to_exitcode(os.waitpid(child, 0)[1])
        if code != 0:
            how = f"was killed by signal {-code}" if code < 0 else f"has ended with code {code}"
            answer = pickle.dumps((f"the process of this request {how}", None))
        _send(answers, answer)


def _answer(compute: Callable[[Any], Any], request: bytes, pipe: int) -> None:
    """In the child: compute, write, and end without what a process does at its end."""
    try:
        answer = ("", compute(pickle.loads(request)))
    except Exception as error:
        answer = (f"{type(error).__name__}: {error}", None)
    with os.fdopen(pipe, "wb") as file:
        file.write(pickle.dumps(answer))
    os._exit(0)


def _send(file: IO[bytes], message: bytes) -> None:
    file.write(_LENGTH.pack(len(message)))
    file.write(message)
    file.flush()


def _receive(file: IO[bytes]) -> bytes | None:
    head = file.read(_LENGTH.size)
    if len(head) < _LENGTH.size:
        return None
    return file.read(_LENGTH.unpack(head)[0])
