"""Makes the pictures of docs/panel.md: `./run python tests/lookstep/panel/screenshot.py docs/images`.

A few seconds of a walk over the rough course, approved by this program, until a plan waits; then the panel is
opened in a browser beside that moment.
"""

from __future__ import annotations

import sys
import threading
import time
from pathlib import Path

from browser import browser

from behaviors import OperatorInbox
from behaviors.operator import Approve, SendGoal, StopNow
from lookstep.configuration import load_configuration
from lookstep.options import RunOptions
from lookstep.pace import Pace
from lookstep.panel.address import Address
from lookstep.panel.child import SERVER, Child, Mailbox
from lookstep.panel.photographer import Photographer
from lookstep.panel.snapshot import Snapshot
from lookstep.walk import walk
from skills.body_path import Goal

APPROVED_UNTIL = 4.0  # robot time [s]
SIZE = {"width": 1500, "height": 900}
SETTLED = 9_000.0  # until a browser without a graphics card has drawn it all [ms]


class Album:
    """Approves until a while has passed, then keeps the moment in which a plan waits and ends the run."""

    def __init__(self) -> None:
        self.pace = Pace(None)
        self.photographer = Photographer("lead on rough", load_configuration().robot, self.pace, "runs/plans")
        self.snapshots: list[Snapshot] = []

    def observe(self, moment) -> None:
        """Take a snapshot of each tenth of a second, and of the end."""
        self.photographer.notice(moment)
        waits = moment.tree.context.reviews
        ends = bool(waits) and moment.time > APPROVED_UNTIL and moment.status.phase.value == "standing"
        if moment.tree.context.tick % 5 == 0 or ends:
            self.snapshots.append(self.photographer.take(moment, link_lost=False))
        for request in waits:
            if moment.time <= APPROVED_UNTIL:
                moment.tree.send(Approve(request.checkpoint, request.item_id))
        if ends:
            moment.tree.send(StopNow())


def main(folder: Path) -> None:
    """Walk, then take the pictures."""
    album, inbox = Album(), OperatorInbox()
    inbox.put(SendGoal(Goal(6.5, 0.0, 0.0)))
    options = RunOptions(tree="lead", course="rough", seed=4, world="kinematic", review=True, time_limit=12.0)
    walk(options, album, inbox=inbox, pace=album.pace)
    shown = next(snapshot for snapshot in reversed(album.snapshots) if snapshot.reviews)
    mailbox, done = Mailbox(), threading.Event()
    child = Child(SERVER, Address(port=0), mailbox, album.pace, lambda message: None)
    try:
        url = child.wait_ready()
        mailbox.put(album.snapshots[0])
        time.sleep(2.0)
        threading.Thread(target=_repeat, args=(mailbox, shown, done), daemon=True).start()
        _take(url, shown, folder)
    finally:
        done.set()
        child.close()


def _repeat(mailbox: Mailbox, shown: Snapshot, done: threading.Event) -> None:
    while not done.wait(0.2):
        mailbox.put(shown)


def _take(url: str, shown: Snapshot, folder: Path) -> None:
    x, y, z = shown.state.T_world_pelvis.p
    camera = f"?initialCameraPosition={x - 1.3:.2f},{y - 2.5:.2f},{z + 1.1:.2f}"
    look_at = f"&initialCameraLookAt={x + 0.7:.2f},{y:.2f},{z - 0.55:.2f}"
    with browser() as opened:
        page = opened.new_page(viewport=SIZE)
        page.set_default_timeout(60_000.0)
        page.goto(url + camera + look_at)
        page.locator(".mantine-Notification-closeButton").click()  # That there is no graphics card.
        page.get_by_role("tab", name="Review").click()
        page.get_by_text("Footstep plan").wait_for()
        page.wait_for_timeout(SETTLED)
        page.screenshot(path=folder / "panel.jpg", type="jpeg", quality=82)
        page.get_by_role("tab", name="State").click()
        page.get_by_role("tab", name="Tree").click()
        page.wait_for_timeout(SETTLED / 2)
        page.screenshot(path=folder / "panel_state.jpg", type="jpeg", quality=75)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
