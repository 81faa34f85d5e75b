"""Where events of the operator wait for the next tick: put there by any thread, taken out by the tree's alone."""

from __future__ import annotations

from threading import Lock

from behaviors.operator.event import OperatorEvent


class OperatorInbox:
    """A queue of events; its order is that in which they came."""

    def __init__(self) -> None:
        self._lock = Lock()
        self._waiting: list[OperatorEvent] = []

    def put(self, event: OperatorEvent) -> None:
        """Let an event take effect at the next border between two ticks; from any thread.

        Raises:
            TypeError: where it is no event.
        """
        if not isinstance(event, OperatorEvent):
            raise TypeError(f"got {event!r}, needs an event of the operator, such as SendGoal(Goal(4.0, 0.0, 0.0))")
        with self._lock:
            self._waiting.append(event)

    @property
    def waiting(self) -> tuple[OperatorEvent, ...]:
        """What the next tick will take."""
        with self._lock:
            return tuple(self._waiting)

    def drain(self, time: float) -> tuple[OperatorEvent, ...]:
        """Take all that waits, for the tick at a robot time [s]."""
        with self._lock:
            taken, self._waiting = tuple(self._waiting), []
        return taken
