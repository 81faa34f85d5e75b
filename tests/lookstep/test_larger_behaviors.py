"""The larger trees that are shipped: they walk, wait for the operator, try again, and take the other route."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from behaviors import Outcome, Status, draw, load_tree
from behaviors.interchange import read_written, write_yaml
from behaviors.operator import Approve, MoveCarrot, Reject, SwitchReview
from lookstep.options import RunOptions
from lookstep.summary import Outcome as RunOutcome
from lookstep.walk import walk
from skills.body_path import Goal
from strict_yaml import shipped, shipped_folder

PAGE = (Path(__file__).parents[2] / "docs" / "behaviors.md").read_text(encoding="utf-8")
FAST: dict[str, Any] = {"course": "flat", "world": "kinematic", "preset": "fast"}
SMALL_CAMERA = "camera.resolution=0.5"
TREES = ("patrol", "inspect_and_return", "follow_carrot")


class Person:
    """An operator who acts on what the tree says, and remembers what became of it."""

    def __init__(self, act=lambda tree, time: None) -> None:
        self.act = act
        self.outcome = Outcome.RUNNING
        self.ended: list[tuple[str, Status]] = []
        self.reasons: list[str] = []

    def observe(self, moment) -> None:
        self.outcome = moment.tree.outcome
        ends = (Status.SUCCESS, Status.FAILURE)
        self.ended += [(change.path, change.after) for change in moment.tree.transitions if change.after in ends]
        self.reasons += [change.reason for change in moment.tree.transitions if change.reason]
        self.act(moment.tree, moment.time)


def test_patrol_walks_to_each_waypoint_in_turn():
    around = "/patrol/run_while/repeat/sequence"
    waypoints = [f"{around}/to_{name}.x={x}" for name, x in (("first", 0.5), ("second", 0.8), ("third", 1.1))]
    person = Person()
    summary = walk(RunOptions(tree="patrol", assignments=(SMALL_CAMERA, *waypoints), time_limit=20.0, **FAST), person)
    assert person.outcome is Outcome.SUCCESS, summary.reason
    assert 1.0 < summary.distance_m < 1.3
    visited = [
        path.removeprefix(f"{around}/") for path, _ in person.ended if path.startswith(around) and path.count("/") == 5
    ]
    assert visited == ["to_first", "first", "to_second", "second", "to_third", "third"]
    assert summary.outcome is RunOutcome.GOAL_REACHED, summary.reason


def test_follow_carrot_goes_where_the_operator_leads_and_waits_for_approval():
    approvals: list[int] = []

    def lead(tree, time: float) -> None:
        if time == pytest.approx(0.1):
            tree.send(MoveCarrot(Goal(0.6, 0.0, 0.0)))
        if time == pytest.approx(4.0):
            tree.send(MoveCarrot(Goal(1.2, 0.0, 0.0)))
            tree.send(SwitchReview("footsteps", asks=False))
        for request in tree.context.reviews:
            if time > 1.0 and request.item_id not in approvals:
                approvals.append(request.item_id)
                tree.send((Reject if request.item_id == 0 else Approve)("footsteps", request.item_id))
                tree.send(Approve("footsteps", request.item_id + 1))

    person = Person(lead)
    options = RunOptions(tree="follow_carrot", assignments=(SMALL_CAMERA,), time_limit=8.0, review=True, **FAST)
    summary = walk(options, person)
    assert person.outcome is Outcome.RUNNING
    assert "plan 0 is rejected by the operator" in person.reasons and "plan 1 is approved" in person.reasons
    assert "goes on without review" in person.reasons
    assert summary.first_step_after_s is not None and summary.first_step_after_s > 1.0
    assert 1.0 < summary.distance_m < 1.4


@pytest.mark.parametrize("name", TREES)
def test_the_page_shows_each_tree_as_it_is_drawn(name: str):
    drawings = re.findall(r"```text\n(.*?)```", PAGE, re.DOTALL)
    assert draw(load_tree(shipped("trees", f"{name}.yaml"))) + "\n" in drawings


@pytest.mark.parametrize("path", sorted(shipped_folder("trees").glob("*.yaml")), ids=lambda path: path.stem)
def test_shipped_trees_reuse_look_and_step_and_are_short(path: Path):
    text = path.read_text()
    assert write_yaml(read_written(text, str(path))) == text
    assert text.count("\n") < 150
    assert path.stem == "look_and_step" or "include: [look_and_step" in text
