"""Who leads the robot: one client holds control, the others watch and may ask for it."""

from __future__ import annotations

from dataclasses import dataclass
from threading import Lock


@dataclass(frozen=True, slots=True)
class AuthorityState:
    """How control stands.

    Attributes:
        holder: the client that holds control; None where it is free.
        asking: clients that ask for it, in the order in which they came.
        clients: all that are connected, in the order in which they came.
    """

    holder: int | None
    asking: tuple[int, ...]
    clients: tuple[int, ...]


class Authority:
    """Gives control to one client at a time; for use by any thread.

    The first client gets control. It stays with a client until that hands it over, gives it up, or goes. Where several
    are left, nobody inherits it: somebody has to take it.
    """

    def __init__(self) -> None:
        self._lock = Lock()
        self._holder: int | None = None
        self._clients: list[int] = []
        self._asking: list[int] = []

    @property
    def state(self) -> AuthorityState:
        """How control stands."""
        with self._lock:
            return AuthorityState(self._holder, tuple(self._asking), tuple(self._clients))

    def holds(self, client: int) -> bool:
        """Whether a client may command."""
        with self._lock:
            return self._holder == client

    def connect(self, client: int) -> None:
        """A client has come; alone, it takes control."""
        with self._lock:
            if client in self._clients:
                return
            self._clients.append(client)
            if self._holder is None and len(self._clients) == 1:
                self._holder = client

    def disconnect(self, client: int) -> None:
        """A client has gone, with its control and its wishes."""
        with self._lock:
            self._clients = [other for other in self._clients if other != client]
            self._asking = [other for other in self._asking if other != client]
            if self._holder == client:
                self._holder = None

    def ask(self, client: int) -> str:
        """Take control where it is free, otherwise ask for it; returns what to tell."""
        with self._lock:
            if client not in self._clients or self._holder == client:
                return ""
            if self._holder is None:
                self._give(client)
                return f"client {client} takes control"
            if client in self._asking:
                return ""
            self._asking.append(client)
            return f"client {client} asks client {self._holder} for control"

    def hand_over(self, client: int) -> str:
        """The holder gives control to the first who asks, or up; returns what to tell."""
        with self._lock:
            if self._holder != client:
                return ""
            if not self._asking:
                self._holder = None
                return f"client {client} gives control up"
            self._give(self._asking[0])
            return f"client {client} hands control over to client {self._holder}"

    def _give(self, client: int) -> None:
        self._holder = client
        self._asking = [other for other in self._asking if other != client]
