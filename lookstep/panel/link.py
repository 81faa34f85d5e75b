"""The robot's side of the panel: starts its process, sends it snapshots, and takes what it says.

The loop of the robot never waits for the panel. A snapshot is handed to a thread that keeps only the newest; one that
reads puts events where the next tick takes them, and reads no faster than a person can act. Both end when the panel's
process does, and the robot notices by the silence (`OperatorLink`).
"""

from __future__ import annotations

import time as wall
from collections import deque
from collections.abc import Callable, Sequence

from behaviors import OperatorInbox
from behaviors.operator import StopNow
from lookstep.moment import Moment
from lookstep.operator_link import OperatorLink
from lookstep.pace import Pace
from lookstep.panel.address import Address
from lookstep.panel.child import SERVER, Child, Mailbox
from lookstep.panel.messages import Beat, Message, Ready, Sent, SetHalted, SetSpeed, StepOnce, Told
from lookstep.panel.photographer import Photographer

_PERIOD = 0.05  # wall time between two snapshots [s]
_MOST_WAITING = 64  # events that wait for a tick
_RESTART_PERIOD = 5.0
_LINES_KEPT = 100


class PanelLink:
    """An observer that keeps the panel's process up to date and does what its operators ask for.

    Args:
        inbox: takes events for the tree.
        pace: of the simulation.
        photographer: makes the snapshots.
        address: where the panel is served.
        command: starts the process; numbers of pipes are appended.
    """

    def __init__(
        self,
        inbox: OperatorInbox,
        pace: Pace,
        photographer: Photographer,
        address: Address,
        command: Sequence[str] = SERVER,
    ) -> None:
        self._inbox, self._pace, self._photographer, self._address = inbox, pace, photographer, address
        self._command = tuple(command)
        self._link = OperatorLink()
        self._messages: deque[Beat | Told] = deque(maxlen=_LINES_KEPT)
        self._mailbox = Mailbox()
        self._next_snapshot = 0.0
        self._last: Moment | None = None
        self._child: Child | None = None
        self._next_start = 0.0

    def start(self) -> str:
        """Start the panel's process; returns where it is served.

        Raises:
            UserError: where it cannot serve; the message says why.
        """
        self._child = self._started()
        return self._child.wait_ready()

    @property
    def child(self) -> Child:
        """The panel's process.

        Raises:
            RuntimeError: where it has not been started.
        """
        if self._child is None:
            raise RuntimeError("the panel has not been started")
        return self._child

    def observe(self, moment: Moment) -> None:
        """Once a tick: take what came, watch the operator's link, and show the newest moment."""
        log, parameters = moment.tree.context.log, moment.tree.context.parameters["operator_link"]
        self._last = moment
        heard = False
        while self._messages:
            message = self._messages.popleft()
            if isinstance(message, Beat):
                heard = heard or message.led
            else:
                log(f"panel: {message.text}")
        change = self._link.watch(moment.time, heard, parameters)
        if change is not None:
            log(change.text, level="warning")
            if change.event is not None:
                self._inbox.put(change.event)
        self._restart_where_ended(log)
        self._photographer.notice(moment)
        now = wall.monotonic()
        if now >= self._next_snapshot:
            self._next_snapshot = now + _PERIOD
            self._mailbox.put(self._photographer.take(moment, link_lost=self._link.lost))

    def end(self, outcome: str) -> None:
        """Show how the run has ended."""
        if self._last is not None:
            self._mailbox.put(self._photographer.take(self._last, link_lost=self._link.lost, outcome=outcome))

    def close(self) -> None:
        """End the panel's process."""
        if self._child is not None:
            self._child.close()

    def _restart_where_ended(self, tell: Callable[[str], None]) -> None:
        if not self.child.ended or wall.monotonic() < self._next_start:
            return
        self._next_start = wall.monotonic() + _RESTART_PERIOD
        tell(f"the panel's process has ended, exit status {self.child.status}; it is started again")
        self.child.close()
        self._child = self._started()

    def _started(self) -> Child:
        return Child(self._command, self._address, self._mailbox, self._pace, self._take)

    def _take(self, message: Message) -> None:
        """Do what an operator asks for; called by the reading thread."""
        match message:
            case Sent(event):
                if len(self._inbox.waiting) >= _MOST_WAITING:
                    self._messages.append(Told(f'"{event.name}" is refused: {_MOST_WAITING} events wait for a tick'))
                    return
                self._inbox.put(event)
                if isinstance(event, StopNow):
                    self._pace.go()  # It takes a tick to stop.
            case SetSpeed(speed):
                self._pace.set_speed(speed)
                self._messages.append(Told(f"the simulation runs at {speed:g} times real time"))
            case SetHalted(True):
                self._pace.halt()
                self._messages.append(Told("the simulation stands still"))
            case SetHalted():
                self._pace.go()
                self._messages.append(Told("the simulation runs"))
            case StepOnce():
                self._pace.step()
            case Beat() | Told():
                self._messages.append(message)
            case Ready(url):
                self._messages.append(Told(f"served at {url}"))
