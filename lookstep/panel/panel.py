"""The panel: a scene, a headline, tabs to direct, review, see and tune, and the rule of who may."""

from __future__ import annotations

import time as wall

import viser

from lookstep.panel import words
from lookstep.panel.authority import Authority
from lookstep.panel.desk import Desk
from lookstep.panel.direct_tab import DirectTab
from lookstep.panel.guard import Guard
from lookstep.panel.parameter_tab import ParameterTab
from lookstep.panel.review_tab import ReviewTab
from lookstep.panel.robot_side import RobotSide
from lookstep.panel.scene import Scene
from lookstep.panel.snapshot import Snapshot
from lookstep.panel.state_tab import StateTab
from lookstep.panel.views import SceneSwitches, SensorView, TreeView

_TEXT_PERIOD, _TREE_PERIOD = 0.2, 0.4  # between two updates of what is read [s]
_BLUE = (42, 120, 214)


class Panel:
    """All that clients see.

    Args:
        server: shows it.
        robot: the robot's process.
        authority: who holds control.
        guard: looks at messages of clients.
        first: the first snapshot.
    """

    def __init__(
        self, server: viser.ViserServer, robot: RobotSide, authority: Authority, guard: Guard, first: Snapshot
    ) -> None:
        server.gui.configure_theme(show_logo=False, show_share_button=False, brand_color=_BLUE)
        server.gui.set_panel_label("lookstep")
        self._authority = authority
        self._desk = desk = Desk(server, Scene(server, first), authority, robot, first)
        gui = server.gui
        gui.main_panel.dock_right()
        self._headline = gui.add_markdown("")
        self._ask = gui.add_button(
            "Take control", hint="Where another holds it, asks for it.", icon=viser.Icon.HAND_STOP
        )
        self._hand_over = gui.add_button(
            "Hand control over", hint="To the first who asks; or give it up.", color="gray"
        )
        guard.open_to_all(self._ask._impl.uuid)
        self._connect_authority()
        tabs = gui.add_tab_group()
        with tabs.add_tab("Direct", viser.Icon.MAP_PIN):
            self._direct = DirectTab(desk)
        with tabs.add_tab("Review", viser.Icon.CHECKBOX):
            self._review = ReviewTab(desk)
        with tabs.add_tab("State", viser.Icon.CHART_LINE):
            self._state = StateTab(desk)
        with tabs.add_tab("Parameters", viser.Icon.ADJUSTMENTS):
            self._parameters = ParameterTab(desk)
        with tabs.add_tab("Scene", viser.Icon.EYE):
            SceneSwitches(desk)
        beside = gui.add_panel()
        with beside.add_tab("Sensors"):
            self._sensors = SensorView(desk)
        with beside.add_tab("Tree"):
            self._tree = TreeView(desk)
        beside.dock_left()
        self._next_text = self._next_tree = 0.0

    def update(self, snapshot: Snapshot, silence: float) -> None:
        """Show a moment, so long after it came [s]."""
        self._desk.snapshot = snapshot
        self._desk.scene.draw(snapshot)
        self._sensors.update(snapshot)
        now = wall.monotonic()
        if now >= self._next_text:
            self._next_text = now + _TEXT_PERIOD
            self._headline.content = words.headline(snapshot, silence, self._authority.state)
            self._show_authority()
            for tab in (self._direct, self._review, self._state, self._parameters):
                tab.update(snapshot)
        if now >= self._next_tree:
            self._next_tree = now + _TREE_PERIOD
            self._tree.update(snapshot)

    def _connect_authority(self) -> None:
        authority, desk, server = self._authority, self._desk, self._desk.server

        @server.on_client_connect
        async def _(client: viser.ClientHandle) -> None:
            authority.connect(client.client_id)
            desk.tell(f"client {client.client_id} has come{self._and_leads(client.client_id)}")

        @server.on_client_disconnect
        async def _(client: viser.ClientHandle) -> None:
            led = self._and_leads(client.client_id)
            authority.disconnect(client.client_id)
            desk.tell(f"client {client.client_id} has gone{', control is free' if led else ''}")

        @self._ask.on_click
        def _(event: viser.GuiEvent) -> None:
            if event.client_id is not None:
                self._say(authority.ask(event.client_id))

        @self._hand_over.on_click
        def _(event: viser.GuiEvent) -> None:
            if event.client_id is not None:
                self._say(authority.hand_over(event.client_id))

    def _say(self, text: str) -> None:
        if text:
            self._desk.tell(text)
            self._desk.notify("Control", text)

    def _and_leads(self, client: int) -> str:
        return " and holds control" if self._authority.holds(client) else ""

    def _show_authority(self) -> None:
        state = self._authority.state
        asking = f" to client {state.asking[0]}" if state.asking else ""
        self._hand_over.label = f"Hand control over{asking}"
        self._hand_over.visible = state.holder is not None
        self._ask.visible = state.holder is None or len(state.clients) > 1
        self._ask.label = "Take control" if state.holder is None else "Ask for control"
