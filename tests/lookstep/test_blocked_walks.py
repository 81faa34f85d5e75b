"""Walks on which something comes in the way: the robot halts for it by name, and goes on when it is gone."""

from __future__ import annotations

import pytest

from lookstep.options import RunOptions
from lookstep.summary import Outcome, Summary
from lookstep.walk import walk

SMALL_CAMERA = "camera.resolution=0.3125"


class Listener:
    """Hears what the robot says of its halts, and sees how near it comes to a box."""

    def __init__(self, box: str) -> None:
        self._box = box
        self.halts: list[str] = []
        self.nearest = float("inf")

    def observe(self, moment) -> None:
        (x, _, z), _ = moment.world.box_poses()[self._box]
        if z > 0.0:
            self.nearest = min(self.nearest, x - moment.state.stance.mid_feet[0])
        self.halts += [line.text for line in moment.log if line.text.startswith(("halted: ", "goes on"))]


def walked(course: str, box: str, seconds: float, *assignments: str) -> tuple[Summary, Listener]:
    listener = Listener(box)
    options = RunOptions(
        course=course,
        world="kinematic",
        preset="fast",
        assignments=(SMALL_CAMERA, *assignments),
        time_limit=seconds,
    )
    return walk(options, listener), listener


@pytest.mark.parametrize(("course", "box"), [("crossing_person", "person"), ("blocked_path", "wall")])
def test_it_halts_for_what_comes_in_the_way_and_goes_on_when_it_is_gone(course: str, box: str):
    summary, listener = walked(course, box, 45.0)
    assert summary.outcome is Outcome.GOAL_REACHED, summary.reason
    assert any(text.startswith("halted: path blocked: something") for text in listener.halts)
    assert listener.halts[-1].startswith("goes on after ")
    assert set(summary.pauses.causes) == {"blocked"}
    assert listener.nearest > 0.4
