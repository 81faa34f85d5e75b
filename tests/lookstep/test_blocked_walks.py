"""Walks on which something comes in the way: the robot halts for it by name, and goes on when it is gone."""

from __future__ import annotations

import pytest

from lookstep.options import RunOptions
from lookstep.walk import walk
from skills.walking import StepEventKind


class Listener:
    """Hears what the robot says of its halts, counts the steps after them, and sees how near it comes to a box."""

    def __init__(self, box: str) -> None:
        self._box = box
        self.halts: list[str] = []
        self.steps_after = 0
        self.nearest = float("inf")

    def observe(self, moment) -> None:
        (x, y, z), _ = moment.world.box_poses()[self._box]
        if z > 0.0 and abs(y) < 0.5:
            self.nearest = min(self.nearest, x - moment.state.stance.mid_feet[0])
        self.halts += [line.text for line in moment.log if line.text.startswith(("halted: ", "goes on"))]
        if self.halts and self.halts[-1].startswith("goes on"):
            self.steps_after += sum(event.kind is StepEventKind.COMPLETED for event in moment.events)


@pytest.mark.parametrize(
    ("course", "box", "seconds"),
    [
        pytest.param("crossing_person", "person", 15.0, marks=pytest.mark.sweep),
        ("blocked_path", "wall", 15.5),
    ],
)
def test_it_halts_for_what_comes_in_the_way_and_goes_on_when_it_is_gone(course: str, box: str, seconds: float):
    listener = Listener(box)
    options = RunOptions(
        course=course,
        world="kinematic",
        preset="fast",
        assignments=("camera.resolution=0.3125",),
        time_limit=seconds,
    )
    summary = walk(options, listener)
    halted, gone_on = listener.halts
    assert halted.startswith("halted: path blocked: something ") and gone_on.startswith("goes on after ")
    assert summary.pauses.causes == {"blocked": 1}
    assert listener.nearest > 0.6 and listener.steps_after >= 1
