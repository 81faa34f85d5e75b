"""What the tabs share: the server, the newest snapshot, and the way to the robot, open to who holds control."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import viser

from behaviors.operator import OperatorEvent
from lookstep.panel.authority import Authority
from lookstep.panel.messages import Message, Sent, Told
from lookstep.panel.robot_side import RobotSide
from lookstep.panel.scene import Scene
from lookstep.panel.snapshot import Snapshot


class Desk:
    """Where the tabs put what their widgets say.

    Attributes:
        server: of the widgets.
        scene: what is drawn.
        authority: who holds control.
        snapshot: the newest.
    """

    def __init__(
        self, server: viser.ViserServer, scene: Scene, authority: Authority, robot: RobotSide, first: Snapshot
    ) -> None:
        self.server, self.scene, self.authority = server, scene, authority
        self.snapshot = first
        self._robot = robot

    def send(self, message: Message) -> None:
        """Say something to the robot."""
        if not self._robot.send(message):
            self.notify("Not sent", "Too much waits to be sent to the robot.")

    def send_event(self, event: OperatorEvent) -> None:
        """Send an event of the operator."""
        self.send(Sent(event))

    def tell(self, text: str) -> None:
        """Put a line into the history of the run."""
        self.send(Told(text))

    def notify(self, title: str, body: str) -> None:
        """Show a note to all clients for a while."""
        for client in self.server.get_clients().values():
            client.add_notification(title=title, body=body, auto_close=5000)

    def on_click(self, button: Any, do: Callable[[], None]) -> None:
        """Let the operator who holds control press a button."""

        @button.on_click
        def _(event: Any) -> None:
            if event.client_id is not None and self.authority.holds(event.client_id):
                do()

    def on_change(self, widget: Any, do: Callable[[Any], None]) -> None:
        """Let the operator who holds control change a widget; `do` takes its new value."""

        @widget.on_update
        def _(event: Any) -> None:
            if event.client_id is not None and self.authority.holds(event.client_id):
                do(event.target.value)
