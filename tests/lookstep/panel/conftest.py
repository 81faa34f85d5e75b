"""A short walk whose snapshots several tests look at."""

from __future__ import annotations

import pytest

from behaviors import OperatorInbox
from behaviors.operator import Approve, ReviewRequest
from lookstep.configuration import load_configuration
from lookstep.options import RunOptions
from lookstep.pace import Pace
from lookstep.panel.photographer import Photographer
from lookstep.panel.snapshot import Snapshot
from lookstep.walk import walk


class Album:
    """Takes a snapshot every fifth tick, and approves all that waits."""

    def __init__(self) -> None:
        self.photographer = Photographer("lead on flat", load_configuration().robot, Pace(None), "plans")
        self.snapshots: list[Snapshot] = []
        self.asked: list[ReviewRequest] = []

    def observe(self, moment) -> None:
        self.photographer.notice(moment)
        for request in moment.tree.context.reviews:
            self.asked.append(request)
            moment.tree.send(Approve(request.checkpoint, request.item_id))
        if moment.tree.context.tick % 5 == 0:
            self.snapshots.append(self.photographer.take(moment, link_lost=False))


@pytest.fixture(scope="session")
def album() -> Album:
    album = Album()
    options = RunOptions(
        tree="lead",
        course="flat",
        world="kinematic",
        preset="fast",
        goal=(1.0, 0.0, 0.0),
        time_limit=1.5,
        assignments=("camera.resolution=0.3125",),
        review=True,
    )
    walk(options, album, inbox=OperatorInbox())
    return album
