"""An inbox whose operator breaks as he is told to: says nothing, answers late, or rejects what he should approve."""

from __future__ import annotations

from collections.abc import Sequence

from behaviors.faults import Fault, FaultMode
from behaviors.operator import Approve, OperatorEvent, OperatorInbox, Reject


class FaultyInbox(OperatorInbox):
    """Wraps any inbox.

    Args:
        inbox: where events arrive.
        faults: those of the operator.
    """

    def __init__(self, inbox: OperatorInbox, faults: Sequence[Fault]) -> None:
        super().__init__()
        self._inbox = inbox
        self._faults = faults
        self._late: list[tuple[float, OperatorEvent]] = []

    def put(self, event: OperatorEvent) -> None:
        """That of the inbox."""
        self._inbox.put(event)

    @property
    def waiting(self) -> tuple[OperatorEvent, ...]:
        """That of the inbox."""
        return self._inbox.waiting

    def drain(self, time: float) -> tuple[OperatorEvent, ...]:
        """What gets through."""
        fault = next((fault for fault in self._faults if fault.holds(time)), None)
        arrived = self._inbox.drain(time)
        mode = None if fault is None else fault.mode
        if fault is not None and mode is FaultMode.DELAYED:
            self._late += [(time + fault.by, event) for event in arrived]
        due = tuple(event for when, event in self._late if when <= time + 1e-9)
        self._late = [late for late in self._late if late[0] > time + 1e-9]
        if mode is FaultMode.WRONG:
            return (*due, *map(_rejected, arrived))
        return due if mode in (FaultMode.OFF, FaultMode.DELAYED) else (*due, *arrived)


def _rejected(event: OperatorEvent) -> OperatorEvent:
    return Reject(event.checkpoint, event.item_id) if isinstance(event, Approve) else event
