"""The panel's process as its clients meet it: strangers stay outside, watchers move nothing, nobody brings it down."""

from __future__ import annotations

import queue
import threading
import time
from collections.abc import Iterator
from typing import Any

import msgspec
import pytest
import viser
import zstandard
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect
from websockets.typing import Subprotocol

from behaviors.operator import PauseWalk
from lookstep.pace import Pace
from lookstep.panel.address import Address
from lookstep.panel.child import SERVER, Child, Mailbox
from lookstep.panel.messages import Beat, Message, Sent, Told

PATIENCE = 60.0
CAMERA = {
    "type": "ViewerCameraMessage",
    "wxyz": (1.0, 0.0, 0.0, 0.0),
    "position": (3.0, 3.0, 3.0),
    "fov": 1.3,
    "image_height": 700,
    "image_width": 1000,
    "near": 0.01,
    "far": 1000.0,
    "look_at": (0.0, 0.0, 0.0),
    "up_direction": (0.0, 0.0, 1.0),
}
NONSENSE = (
    *(b"", b"\xc1", b"\x00" * 1000, "text", b"\xff" * 300_000),
    msgspec.msgpack.encode({"type": "NoSuchMessage"}),
    msgspec.msgpack.encode({"type": "GuiUpdateMessage", "uuid": 3, "updates": []}),
    msgspec.msgpack.encode({"type": "GuiUpdateMessage", "uuid": "x", "updates": {"update_cb": 1}}),
    msgspec.msgpack.encode(CAMERA | {"position": "nowhere"}),
    msgspec.msgpack.encode({"type": "ShareUrlRequest"}),
)


class Client:
    """Somebody who has come, as a browser would: reads all that is sent, and keeps what widgets there are."""

    def __init__(self, url: str) -> None:
        protocol = Subprotocol(f"viser-v{viser.__version__}")
        self.socket = connect(url, subprotocols=[protocol], compression=None, max_size=None)
        self.widgets: dict[str, str] = {}
        self.changed = threading.Condition()
        threading.Thread(target=self._read, daemon=True).start()
        self.socket.send(msgspec.msgpack.encode(CAMERA))

    def __enter__(self) -> Client:
        return self

    def __exit__(self, *_: object) -> None:
        self.socket.close()

    def press(self, label: str) -> None:
        """Press a button, once it is there."""
        self.wait_for_widget(label)
        message = {"type": "GuiUpdateMessage", "uuid": self.widgets[label], "updates": {"value": True}}
        self.socket.send(msgspec.msgpack.encode(message))

    def wait_for_widget(self, label: str) -> None:
        """Wait until the server has told of a widget."""
        with self.changed:
            assert self.changed.wait_for(lambda: label in self.widgets, PATIENCE), self.widgets

    def _read(self) -> None:
        try:
            for data in self.socket:
                assert isinstance(data, bytes)
                packed = data[16 : 16 + int.from_bytes(data[8:16], "little")]
                for message in msgspec.msgpack.decode(zstandard.ZstdDecompressor().decompress(packed))["messages"]:
                    with self.changed:
                        self.widgets[str((message.get("props") or {}).get("label"))] = message.get("uuid", "")
                        self.changed.notify_all()
        except ConnectionClosed:
            pass


class Served:
    """A panel that shows one moment."""

    def __init__(self, snapshot: Any) -> None:
        self.heard: queue.SimpleQueue[Message] = queue.SimpleQueue()
        self.mailbox = Mailbox()
        self.child = Child(SERVER, Address(port=0), self.mailbox, Pace(1.0), self.heard.put)
        self.url = self.child.wait_ready().replace("http", "ws")
        self.mailbox.put(snapshot)

    def client(self) -> Client:
        """Somebody who has come."""
        return Client(self.url)

    def wait_for(self, holds: Any) -> Message:
        """The next message of a kind."""
        end, others = time.monotonic() + PATIENCE, []
        while time.monotonic() < end:
            message = self.heard.get(timeout=PATIENCE)
            if holds(message):
                return message
            if not isinstance(message, Beat):
                others.append(message)
        raise AssertionError(others)


@pytest.fixture(scope="module")
def served(album) -> Iterator[Served]:
    served = Served(album.snapshots[-1])
    try:
        yield served
    finally:
        served.child.close()


def told(text: str) -> Any:
    return lambda message: isinstance(message, Told) and text in message.text


def test_pages_of_others_do_not_come_in(served):
    for header in ({"Origin": "http://evil.example"}, {"Origin": "null"}):
        with pytest.raises(InvalidStatus, match="403"):
            connect(served.url, additional_headers=header)


def test_who_holds_control_commands_and_who_watches_does_not(served):
    with served.client() as leader:
        served.wait_for(told("has come and holds control"))
        with served.client() as watcher:
            served.wait_for(told("has come"))
            watcher.press("Pause")
            served.wait_for(told("refused: it does not hold control"))
            leader.press("Pause")
            assert served.wait_for(lambda message: isinstance(message, Sent)) == Sent(PauseWalk())
    served.wait_for(told("has gone, control is free"))


def test_nobody_brings_it_down_or_moves_anything(served):
    for i in range(50):
        try:
            with served.client() as client:
                client.socket.send(NONSENSE[i % len(NONSENSE)])
        except ConnectionClosed:
            pass
    with served.client() as client:
        client.wait_for_widget("Place goal")
    assert not served.child.ended
    while not served.heard.empty():
        assert not isinstance(served.heard.get(), Sent)
