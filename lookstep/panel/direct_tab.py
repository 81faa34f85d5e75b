"""The tab "Direct": where the robot shall go, and whether it may go at all."""

from __future__ import annotations

from threading import RLock
from typing import Any

import numpy as np
import viser

from behaviors.operator import (
    MoveBox,
    MoveCarrot,
    PauseWalk,
    ResetBehavior,
    ResumeWalk,
    SendGoal,
    SendWaypoints,
    StopNow,
)
from lookstep.panel.desk import Desk
from lookstep.panel.messages import FASTEST, SetHalted, SetSpeed, StepOnce
from lookstep.panel.picking import Placing, box_under_click, ground_under_click
from lookstep.panel.snapshot import Snapshot
from skills.body_path import Goal
from skills.geometry import Pose

_AHEAD = 1.0  # where the carrot is held out first [m]
_LIFTED = np.array((0.0, 0.0, 0.05))  # over the ground, so that it is seen [m]


class DirectTab:
    """Widgets to lead the robot; made inside the tab's context.

    Args:
        desk: where they put what they say.
    """

    def __init__(self, desk: Desk) -> None:
        self._desk, self._gui = desk, desk.server.gui
        self._lock = RLock()
        self._placing: Placing | None = None
        self._for_waypoint = False
        self._waypoints: list[tuple[Goal, float]] = []
        self._click: Any = None
        self._gizmo: viser.TransformControlsHandle | None = None
        self._add_goal_widgets()
        self._add_walk_widgets()
        if desk.snapshot.stage.simulated:
            self._add_simulation_widgets()

    def update(self, snapshot: Snapshot) -> None:
        """Show how the walk stands."""
        self._pause.disabled = snapshot.paused
        self._resume.disabled = not snapshot.paused
        if snapshot.stage.simulated:
            halted = snapshot.pace.halted
            self._halt.visible, self._go.visible, self._step.disabled = not halted, halted, not halted

    def _add_goal_widgets(self) -> None:
        gui, desk = self._gui, self._desk
        hint = "Then click twice on the ground: where to stand, and a point to look at."
        self._place = gui.add_button("Place goal", hint=hint, color="green", icon=viser.Icon.MAP_PIN)
        self._cancel = gui.add_button("Cancel", visible=False, color="gray")
        self._help = gui.add_markdown("", visible=False)
        desk.on_click(self._place, lambda: self._begin_placing(for_waypoint=False))
        desk.on_click(self._cancel, self._end_clicking)
        with gui.add_folder("Waypoints", expand_by_default=False):
            add = gui.add_button("Add waypoint", hint="Two clicks, as for a goal; the robot visits them in turn.")
            send = gui.add_button("Send waypoints", color="green")
            clear = gui.add_button("Clear waypoints", color="gray")
        desk.on_click(add, lambda: self._begin_placing(for_waypoint=True))
        desk.on_click(send, self._send_waypoints)
        desk.on_click(clear, self._clear_waypoints)
        with gui.add_folder("Carrot", expand_by_default=False):
            hold = gui.add_button(
                "Hold out a carrot", hint="Drag it over the ground; a tree that follows goes after it."
            )
            drop = gui.add_button("Take it away", color="gray")
        desk.on_click(hold, self._hold_carrot)
        desk.on_click(drop, self._remove_gizmo)

    def _add_walk_widgets(self) -> None:
        gui, desk = self._gui, self._desk
        with gui.add_folder("Walk"):
            self._pause = gui.add_button("Pause", hint="Finish the step and stand; the goal stays.", color="yellow")
            self._resume = gui.add_button("Resume", color="green")
            reset = gui.add_button(
                "Reset", hint="Finish the step, stand, forget the goal and all plans.", color="orange"
            )
            stop = gui.add_button(
                "Stop now", hint="End the run: the tree's safe stop lets the robot stand.", color="red"
            )
        desk.on_click(self._pause, lambda: desk.send_event(PauseWalk()))
        desk.on_click(self._resume, lambda: desk.send_event(ResumeWalk()))
        desk.on_click(reset, self._reset)
        desk.on_click(stop, lambda: desk.send_event(StopNow()))

    def _add_simulation_widgets(self) -> None:
        gui, desk = self._gui, self._desk
        with gui.add_folder("Simulation", expand_by_default=False):
            speed = desk.snapshot.pace.speed or 1.0
            self._speed = gui.add_slider("Speed", 0.05, FASTEST, 0.05, min(speed, FASTEST), hint="Times real time.")
            self._halt = gui.add_button("Halt time", hint="The world stands still; the panel goes on.")
            self._go = gui.add_button("Let time run", visible=False, color="green")
            self._step = gui.add_button("Single step", hint="One tick of the tree.", disabled=True)
            move = gui.add_button("Move a block", hint="Click a block, then drag it; also while the robot walks.")
            done = gui.add_button("Let go of it", color="gray")
        desk.on_change(self._speed, lambda speed: desk.send(SetSpeed(float(speed))))
        desk.on_click(self._halt, lambda: desk.send(SetHalted(True)))
        desk.on_click(self._go, lambda: desk.send(SetHalted(False)))
        desk.on_click(self._step, lambda: desk.send(StepOnce()))
        desk.on_click(move, self._begin_moving)
        desk.on_click(done, self._remove_gizmo)

    def _begin_placing(self, *, for_waypoint: bool) -> None:
        with self._lock:
            self._end_clicking()
            self._placing, self._for_waypoint = Placing(), for_waypoint
            self._begin_clicking("**Click on the ground** where the robot shall stand.", self._place_clicked)

    def _place_clicked(self, event: viser.SceneClickEvent) -> None:
        with self._lock:
            if self._placing is None:
                return
            point = ground_under_click(np.array(event.ray_origin), np.array(event.ray_direction), self._desk.snapshot)
            if point is None:
                return
            before = self._placing.position_world
            self._placing, goal = self._placing.clicked(point)
            place = self._placing.position_world
            if goal is None or before is None:
                if place is not None:
                    self._desk.scene.mark_place(np.array(place) + _LIFTED, None)
                    self._help.content = "**Click where it shall look**, or cancel."
                return
            self._end_clicking()
            if self._for_waypoint:
                self._waypoints.append((goal, before[2] + float(_LIFTED[2])))
                self._desk.scene.mark_waypoints(self._waypoints)
            else:
                self._desk.send_event(SendGoal(goal))

    def _send_waypoints(self) -> None:
        with self._lock:
            if not self._waypoints:
                self._desk.notify("No waypoints", "Add some first.")
                return
            self._desk.send_event(SendWaypoints(tuple(goal for goal, _ in self._waypoints)))
            self._clear_waypoints()

    def _clear_waypoints(self) -> None:
        with self._lock:
            self._waypoints = []
            self._desk.scene.mark_waypoints([])

    def _hold_carrot(self) -> None:
        with self._lock:
            self._remove_gizmo()
            stance = self._desk.snapshot.state.stance
            ahead = np.array((np.cos(stance.yaw), np.sin(stance.yaw), 0.0))
            place = stance.mid_feet + _AHEAD * ahead + _LIFTED
            gizmo = self._desk.server.scene.add_transform_controls(
                "/carrot",
                scale=0.6,
                active_axes=(True, True, False),
                position=place,
                wxyz=Pose.from_xyz_rpy(place, (0.0, 0.0, stance.yaw)).quaternion_wxyz,
            )
            self._gizmo = gizmo
            self._follow(gizmo, self._send_carrot)
            self._send_carrot(gizmo)

    def _send_carrot(self, gizmo: viser.TransformControlsHandle) -> None:
        pose = Pose.from_quaternion_wxyz(gizmo.wxyz, gizmo.position)
        self._desk.send_event(MoveCarrot(Goal(float(pose.p[0]), float(pose.p[1]), pose.yaw)))

    def _begin_moving(self) -> None:
        with self._lock:
            self._end_clicking()
            self._begin_clicking("**Click on a block** of the course.", self._box_clicked)

    def _box_clicked(self, event: viser.SceneClickEvent) -> None:
        with self._lock:
            name = box_under_click(np.array(event.ray_origin), np.array(event.ray_direction), self._desk.snapshot)
            if name is None:
                return
            self._end_clicking()
            self._remove_gizmo()
            position, wxyz = self._desk.snapshot.boxes[name]
            gizmo = self._desk.server.scene.add_transform_controls(
                "/block", scale=0.5, position=np.array(position), wxyz=np.array(wxyz)
            )
            self._gizmo = gizmo
            self._follow(gizmo, lambda moved: self._send_box(name, moved))

    def _send_box(self, name: str, gizmo: viser.TransformControlsHandle) -> None:
        x, y, z = map(float, gizmo.position)
        qw, qx, qy, qz = map(float, np.asarray(gizmo.wxyz) / np.linalg.norm(gizmo.wxyz))
        self._desk.send_event(MoveBox(name, (x, y, z), (qw, qx, qy, qz)))

    def _follow(self, gizmo: viser.TransformControlsHandle, send: Any) -> None:
        @gizmo.on_update
        def _(event: viser.TransformControlsEvent) -> None:
            if event.client_id is not None and self._desk.authority.holds(event.client_id):
                send(event.target)

    def _reset(self) -> None:
        with self._lock:
            self._end_clicking()
            self._desk.send_event(ResetBehavior())

    def _begin_clicking(self, text: str, clicked: Any) -> None:
        self._help.content, self._help.visible, self._cancel.visible = text, True, True
        self._place.visible = False

        @self._desk.server.scene.on_click()
        def on_click(event: viser.SceneClickEvent) -> None:
            if self._desk.authority.holds(event.client_id):
                clicked(event)

        self._click = on_click

    def _end_clicking(self) -> None:
        with self._lock:
            if self._click is not None:
                self._desk.server.scene.remove_click_callback(self._click)
            self._click = self._placing = None
            self._desk.scene.clear_place()
            self._help.visible = self._cancel.visible = False
            self._place.visible = True

    def _remove_gizmo(self) -> None:
        with self._lock:
            if self._gizmo is not None:
                self._gizmo.remove()
            self._gizmo = None
