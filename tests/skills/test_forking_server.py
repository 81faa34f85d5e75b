"""One forked child a request; whatever dies is told, and the next request is answered."""

from __future__ import annotations

import sys

import pytest

from skills.forking_server import ForkingServer, ServerError

WORK = """
import os, signal
from skills.forking_server import serve

calls = 0

def work(request):
    global calls
    calls += 1
    print("this is no answer")
    match request:
        case "kill": os.kill(os.getpid(), signal.SIGKILL)
        case "exit": os._exit(3)
        case "raise": return 1 / 0
        case "end": os.kill(os.getppid(), signal.SIGTERM)
    return request, calls

serve(work)
"""


@pytest.fixture
def server():
    server = ForkingServer((sys.executable, "-c", WORK))
    yield server
    server.close()


def test_each_request_finds_the_server_as_it_started(server):
    assert server.ask("a") == ("a", 1)
    assert server.ask(["b"]) == (["b"], 1)


def test_what_dies_is_told_and_the_next_request_is_answered(server):
    for request, told in (
        ("kill", "the process of this request was killed by signal 9"),
        ("exit", "the process of this request has ended with code 3"),
        ("raise", "ZeroDivisionError: division by zero"),
        ("end", "the server has ended with code -15"),
    ):
        with pytest.raises(ServerError) as error:
            server.ask(request)
        assert str(error.value) == told
        assert server.ask("again") == ("again", 1)
