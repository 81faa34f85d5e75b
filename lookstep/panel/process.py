"""The panel's process: `python -m lookstep.panel.process READ WRITE`, started by the robot's (`child`)."""

from __future__ import annotations

import os
import sys
import time as wall
from threading import Thread

import viser

from lookstep.panel.authority import Authority
from lookstep.panel.door import guarded_door
from lookstep.panel.guard import Guard, stand_guard
from lookstep.panel.messages import Beat, Ready, Told
from lookstep.panel.panel import Panel
from lookstep.panel.robot_side import RobotSide

_NICE = 5  # The robot's process comes first.
_BEAT_PERIOD = 0.25
_DRAW_PERIOD = 1.0 / 15.0


def main(read: int, write: int) -> None:
    """Serve until the robot's process ends."""
    os.nice(_NICE)
    robot, authority = RobotSide(read, write), Authority()
    address = robot.address
    with guarded_door(address):
        server = viser.ViserServer(host=address.host, port=address.port, label="lookstep", verbose=False)
    # Before there is any widget that a client could use.
    guard = Guard(authority, lambda text: robot.send(Told(text)))
    stand_guard(server, guard)
    robot.send(Ready(f"http://{address.host}:{server.get_port()}/"))
    Thread(target=_beat, args=(robot, authority), daemon=True).start()
    number, first = 0, None
    while first is None and not robot.ended.is_set():
        number, first = robot.newest(number, _DRAW_PERIOD)
    if first is not None:
        _show(robot, Panel(server, robot, authority, guard, first), number)
    server.stop()


def _show(robot: RobotSide, panel: Panel, number: int) -> None:
    """Draw the newest snapshot again and again, until there will be none any more."""
    came = wall.monotonic()
    while not robot.ended.is_set():
        begun = wall.monotonic()
        before, (number, snapshot) = number, robot.newest(number, _DRAW_PERIOD)
        if number != before:
            came = wall.monotonic()
        if snapshot is not None:
            panel.update(snapshot, wall.monotonic() - came)
        wall.sleep(max(0.0, _DRAW_PERIOD - (wall.monotonic() - begun)))


def _beat(robot: RobotSide, authority: Authority) -> None:
    while not robot.ended.wait(_BEAT_PERIOD):
        robot.send(Beat(authority.state.holder is not None))


if __name__ == "__main__":
    main(int(sys.argv[1]), int(sys.argv[2]))
