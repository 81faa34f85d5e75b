"""Whatever the panel's process does, the robot walks as it would without; and a lost operator is noticed."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from behaviors import OperatorInbox
from behaviors.operator import PauseWalk
from lookstep.configuration import load_configuration
from lookstep.options import RunOptions
from lookstep.pace import Pace
from lookstep.panel.address import Address
from lookstep.panel.link import PanelLink
from lookstep.panel.photographer import Photographer
from lookstep.summary import Summary
from lookstep.walk import walk

FAKE = Path(__file__).with_name("fake_panel.py")
OPTIONS = RunOptions(
    tree="lead",
    course="flat",
    world="kinematic",
    preset="fast",
    goal=(1.0, 0.0, 0.0),
    time_limit=1.5,
    assignments=("camera.resolution=0.3125", "operator_link.patience=0.4"),
)


class Ears:
    """Hears what is said, and sees whether the walk is paused."""

    def __init__(self) -> None:
        self.said: list[str] = []
        self.events: list[object] = []

    def observe(self, moment) -> None:
        self.said += [line.text for line in moment.log]
        self.events += moment.tree.context.operator_events


def walk_beside(*behavior: str) -> tuple[Summary, Ears]:
    ears, inbox, pace = Ears(), OperatorInbox(), Pace(None)
    photographer = Photographer("a test", load_configuration().robot, pace)
    link = PanelLink(inbox, pace, photographer, Address(), command=(sys.executable, str(FAKE), *behavior))
    try:
        assert link.start() == "nowhere"
        return walk(OPTIONS, link, ears, inbox=inbox, pace=pace), ears
    finally:
        link.close()


@pytest.fixture(scope="module")
def alone() -> Summary:
    return walk(OPTIONS)


def test_a_panel_that_raves_changes_nothing_for_the_robot(alone):
    summary, ears = walk_beside("raves")
    assert summary.trace_hash == alone.trace_hash
    refused = [text for text in ears.said if text.startswith("panel: refused: ")]
    assert any("needs JSON" in text for text in refused) and any("needs a speed" in text for text in refused)


def test_a_panel_that_hangs_changes_nothing_for_the_robot(alone):
    assert walk_beside("hangs")[0].trace_hash == alone.trace_hash


def test_a_panel_that_breaks_the_pipe_is_started_again(alone, tmp_path):
    summary, ears = walk_beside("breaks", str(tmp_path / "once"))
    assert summary.trace_hash == alone.trace_hash
    assert any("started again" in text for text in ears.said)


def test_a_panel_that_dies_in_mid_walk_lets_the_robot_hold_and_say_so(tmp_path):
    _, ears = walk_beside("leaves", str(tmp_path / "once"))
    assert PauseWalk() in ears.events
    assert any("link is lost" in text and "finishes its step" in text for text in ears.said)
    assert any("started again" in text for text in ears.said)
