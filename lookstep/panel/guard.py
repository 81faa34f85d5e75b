"""What clients may say: every message is looked at before viser takes it for good.

All widgets are shared, so a message of one client changes what all see; and viser sets any attribute of a widget that a
message names. So only values of widgets get through, only from the client that holds control, and only as many as a
person can make. Buttons by which a watcher asks for control are open to all.
"""

from __future__ import annotations

import time as wall
from collections import Counter
from collections.abc import Callable
from typing import Any

from viser import ViserServer, _messages

from lookstep.panel.authority import Authority

_OPEN = ("ViewerCameraMessage", "GetRenderResponseMessage")
_FOR_HOLDER = (
    "ScenePointerMessage",
    "SceneNodeClickMessage",
    "TransformControlsUpdateMessage",
    "TransformControlsDragStartMessage",
    "TransformControlsDragEndMessage",
)
_MOST_PER_SECOND = 200
_LONGEST_TEXT = 1000


class Guard:
    """Looks at messages.

    Args:
        authority: who holds control.
        tell: takes a line about what was refused.
        now: wall time [s].
    """

    def __init__(
        self, authority: Authority, tell: Callable[[str], object], now: Callable[[], float] = wall.monotonic
    ) -> None:
        self._authority, self._tell, self._now = authority, tell, now
        self._open_widgets: set[str] = set()
        self._second = 0
        self._counts: Counter[int] = Counter()
        self._told: dict[tuple[int, str], int] = {}

    def open_to_all(self, uuid: str) -> None:
        """Let every client press a button."""
        self._open_widgets.add(uuid)

    def lets_in(self, client: int, message: object) -> bool:
        """Whether a message may be taken; a reason is told once a second where not."""
        refusal = self._refusal(client, message)
        if refusal and self._told.get((client, refusal)) != self._second:
            self._told = {key: second for key, second in self._told.items() if second == self._second}
            self._told[(client, refusal)] = self._second
            self._tell(f"client {client} is refused: {refusal}")
        return not refusal

    def _refusal(self, client: int, message: object) -> str:
        second = int(self._now())
        if second != self._second:
            self._second, self._counts = second, Counter()
        self._counts[client] += 1
        if self._counts[client] > _MOST_PER_SECOND:
            return f"more than {_MOST_PER_SECOND} messages a second"
        kind = type(message).__name__
        if kind in _OPEN:
            return ""
        if kind == "GuiUpdateMessage":
            return self._refused_update(client, getattr(message, "uuid", None), getattr(message, "updates", None))
        if kind not in _FOR_HOLDER:
            return f"{kind} is nothing that the panel takes"
        return "" if self._authority.holds(client) else "it does not hold control"

    def _refused_update(self, client: int, uuid: Any, updates: Any) -> str:
        if not isinstance(updates, dict) or set(updates) != {"value"} or not _is_plain(updates["value"]):
            return "an update that is no value of a widget"
        return "" if self._authority.holds(client) or uuid in self._open_widgets else "it does not hold control"


def stand_guard(server: ViserServer, guard: Guard) -> None:
    """Let a guard look at every message before the server handles it; what a client changed in vain is put back."""
    websocket = server._websock_server
    handle = websocket._handle_incoming_message

    async def handle_guarded(client_id: Any, message: Any) -> None:
        if guard.lets_in(client_id, message):
            await handle(client_id, message)
        elif isinstance(message, _messages.GuiUpdateMessage):
            _put_back(server, client_id, message.uuid)

    websocket._handle_incoming_message = handle_guarded


def _put_back(server: ViserServer, client: int, uuid: str) -> None:
    widget, there = server.gui._gui_input_handle_from_uuid.get(uuid), server.get_clients().get(client)
    if widget is not None and there is not None:
        true = _messages.GuiUpdateMessage(uuid, {"value": widget._impl.value})
        there._websock_connection.queue_message(true)


def _is_plain(value: Any) -> bool:
    if isinstance(value, list | tuple):
        return len(value) <= 8 and all(isinstance(part, int | float) for part in value)
    return isinstance(value, bool | int | float) or (isinstance(value, str) and len(value) <= _LONGEST_TEXT)
