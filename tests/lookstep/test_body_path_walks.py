"""Walks along planned paths: when the first step begins, a new goal on the way, a goal where nobody can stand."""

from __future__ import annotations

from pathlib import Path

from behaviors.operator import SendGoal
from lookstep.options import RunOptions
from lookstep.summary import Outcome
from lookstep.walk import walk
from skills.body_path import Goal, PathEnd
from skills.walking import WalkingPhase

SMALL_CAMERA = "camera.resolution=0.3125"
WALK_TO = "/look_and_step/walk/sequence/go/walk_to"
GIVES_UP = (
    f"{WALK_TO}/on_the_way/follow_path/selector/no_way_on.attempts=2",
    f"{WALK_TO}/not_blocked/no_way_on.attempts=2",
)


class Sends:
    """An operator who sends another goal on the way, and sees when the first weight shifts."""

    def __init__(self, time: float, goal: Goal) -> None:
        self.time, self.goal = time, goal
        self.first_transfer: float | None = None

    def observe(self, moment) -> None:
        if self.first_transfer is None and moment.status.phase is WalkingPhase.TRANSFER:
            self.first_transfer = moment.time
        if self.time <= moment.time < self.time + 0.02:
            moment.tree.send(SendGoal(self.goal))


def test_the_first_transfer_begins_soon_and_a_new_goal_is_taken_without_a_pause():
    operator = Sends(1.6, Goal(1.3, 0.45, 0.5))
    options = RunOptions(
        course="flat", world="kinematic", preset="fast", time_limit=20.0, assignments=(SMALL_CAMERA,), goal=(3.0, 0, 0)
    )
    summary = walk(options, operator)
    assert summary.outcome is Outcome.GOAL_REACHED, summary.reason
    assert operator.first_transfer is not None and operator.first_transfer < 0.5
    assert 1.2 < summary.distance_m < 1.6
    assert summary.pauses.count == 0


def test_a_goal_inside_a_block_ends_beside_it_and_says_so(tmp_path: Path):
    course = tmp_path / "occupied.yaml"
    course.write_text(
        "start: {x: 0, y: 0}\ngoal: {x: 1.6, y: 0}\nobjects:\n"
        "  - {name: floor, size: [4.0, 2.4, 0.2], top: [1.0, 0, 0]}\n"
        "  - {name: block, size: [0.6, 0.6, 1.0], top: [1.6, 0, 1.0]}\n"
    )
    options = RunOptions(
        course=str(course), world="kinematic", preset="fast", time_limit=20.0, assignments=(SMALL_CAMERA, *GIVES_UP)
    )
    summary = walk(options)
    assert summary.outcome is Outcome.BLOCKED, summary.reason
    assert summary.reason.endswith(f"the last: the path ends here, {PathEnd.GOAL_OCCUPIED.value}")
    assert 0.6 < summary.distance_m < 1.2
