"""The operator's port: events refuse what makes no sense, are the same as plain data, and take effect between ticks."""

from __future__ import annotations

import json
import re
import threading
from pathlib import Path

import pytest
from scripted import ScriptedRobot, make, run

from behaviors import Outcome
from behaviors.operator import (
    EVENTS,
    Approve,
    ChangeParameter,
    MoveBox,
    MoveCarrot,
    OperatorEventError,
    OperatorInbox,
    PauseWalk,
    Reject,
    ResetBehavior,
    ResumeWalk,
    SendGoal,
    SendWaypoints,
    StopNow,
    SwitchImpassability,
    SwitchReview,
    read_event,
)
from skills.body_path import Goal

ONE_OF_EVERYTHING = (
    SendGoal(Goal(4.0, 0.1, -0.5)),
    MoveCarrot(Goal(1.5, 0.2, 0.0)),
    SendWaypoints((Goal(1.0, 0.0, 0.0), Goal(2.0, 1.0, 1.57))),
    Approve("body_path", 0),
    Reject("footsteps", 12),
    SwitchReview("footsteps", asks=False),
    ChangeParameter("footsteps", "reach", 0.4),
    ChangeParameter("/t/leaf", "offsets", (1.0, (2, True), "text")),
    SwitchImpassability(halts=True),
    MoveBox("block_3", (1.0, 0.0, 0.2), (1.0, 0.0, 0.0, 0.0)),
    PauseWalk(),
    ResumeWalk(),
    ResetBehavior(),
    StopNow(),
)
PAGE = (Path(__file__).parents[2] / "docs" / "operator.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("event", ONE_OF_EVERYTHING, ids=lambda event: event.name)
def test_an_event_is_the_same_after_a_way_through_json(event):
    name, value = json.loads(json.dumps([event.name, event.value]))
    assert read_event(name, value) == event
    assert hash(read_event(name, value)) == hash(event)


def test_every_kind_of_event_is_tried_and_stands_on_the_page_with_a_value_that_is_one():
    assert {event.name for event in ONE_OF_EVERYTHING} == set(EVENTS)
    rows = re.findall(r"^\| `(\w+)` \| `(.+?)` \| `(\w+)` \|", PAGE, re.MULTILINE)
    assert [(name, EVENTS[name].__name__) for name, _, _ in rows] == [(name, cls) for name, _, cls in rows]
    assert {name for name, _, _ in rows} == set(EVENTS)
    for name, value, _ in rows:
        read_event(name, json.loads(value))


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("aprove", None, r'no event "aprove"; did you mean "approve"\? \(events: goal, carrot, '),
        ("goal", [1.0, 2.0], r"goal: got \[1.0, 2.0\], needs three numbers, x and y in m and the heading in rad"),
        ("goal", [1.0, 2.0, True], "goal: got .* needs three numbers"),
        ("goal", [1.0, 2.0, float("nan")], "goal: got goal .*, needs finite numbers"),
        ("goal", None, "goal: got None, needs three numbers"),
        ("waypoints", [], r"waypoints: got \(\), needs a list of places"),
        ("waypoints", [[1.0, 2.0, 0.0], [1.0]], r"waypoints: got \[1.0\]"),
        ("approve", 12, "approve: got 12, needs a checkpoint and the id"),
        ("approve", ["footsteps", -1], r"approve: got \('footsteps', -1\)"),
        ("approve", ["footsteps", 1.0], r"approve: got \('footsteps', 1.0\)"),
        ("reject", ["", 1], r"reject: got \('', 1\), needs a checkpoint and the id of what is rejected"),
        ("review", ["footsteps", 1], r"review: got \('footsteps', 1\), needs a checkpoint and true or false"),
        ("parameter", ["footsteps", "reach"], "parameter: got .*, needs a target, a key and a value"),
        ("parameter", ["footsteps", "reach", None], "parameter: got .*None"),
        ("impassability", "off", "impassability: got 'off', needs true or false"),
        ("box", ["a", [0.0, 0.0], [1.0, 0.0, 0.0, 0.0]], "box: got .*, needs a box of the course"),
        ("box", ["a", [0.0, 0.0, 0.0], [2.0, 0.0, 0.0, 0.0]], "box: got .*, needs a box of the course"),
        ("pause", 1, "pause: got 1, needs nothing"),
    ],
)
def test_what_makes_no_sense_is_refused_with_what_is_allowed(name: str, value: object, message: str):
    with pytest.raises(OperatorEventError, match=message):
        read_event(name, value)


def test_events_of_many_threads_all_arrive_each_threads_in_order():
    inbox = OperatorInbox()

    def send(checkpoint: str) -> None:
        for item_id in range(200):
            inbox.put(Approve(checkpoint, item_id))

    threads = [threading.Thread(target=send, args=(name,)) for name in ("a", "b", "c")]
    for thread in threads:
        thread.start()
    taken: list[Approve] = []
    while any(thread.is_alive() for thread in threads) or inbox.waiting:
        taken += inbox.drain(0.0)  # type: ignore[arg-type]
    assert len(taken) == 600
    for name in ("a", "b", "c"):
        assert [event.item_id for event in taken if event.checkpoint == name] == list(range(200))
    with pytest.raises(TypeError, match="got 'approve', needs an event of the operator"):
        inbox.put("approve")  # type: ignore[arg-type]


def test_a_changed_parameter_takes_effect_at_the_next_tick_and_one_that_is_refused_is_told():
    tree, robot = make("{tree: t, root: {loop_forever: {GiveNumber: {out: [number]}}}}", parameters={"walking": 1})
    tree._fixed = ("walking",)
    run(tree, robot, 1)
    path = "/t/give_number"
    tree.send(ChangeParameter(path, "value", 3))
    assert tree.node(path).parameters.value == 1.0
    tree.send(ChangeParameter(path, "valu", 3))
    tree.send(ChangeParameter(path, "value", 99))
    tree.send(ChangeParameter("walking", "speed", 2.0))
    run(tree, robot, 1)
    assert tree.blackboard["number"] == 3.0
    assert tree.context.operator_events == ()
    refusals = [line.text for line in tree.drain_log() if line.level == "warning"]
    assert [text.split(": ", 1)[0] for text in refusals] == ['"parameter" is refused'] * 3
    assert 'no parameter "valu"' in refusals[0] and "allowed: -10 .. 10 m" in refusals[1]
    assert "walking is taken when a run begins" in refusals[2]


def test_a_pause_lasts_until_it_is_resumed_or_reset():
    tree, robot = make("{tree: t, root: {Scripted: {says: R}}}")
    seen = []
    for event in (None, PauseWalk(), None, ResumeWalk(), PauseWalk(), ResetBehavior()):
        if event is not None:
            tree.send(event)
        run(tree, robot, 1)
        seen.append(tree.context.paused)
    assert seen == [False, True, True, False, True, False]


def test_stop_now_stops_what_runs_in_the_same_tick_lets_the_robot_stand_and_nothing_resumes():
    robot = ScriptedRobot()
    tree, _ = make("{tree: t, root: {Scripted: {says: R}}}", robot)
    run(tree, robot, 2)
    tree.send(StopNow())
    run(tree, robot, 1)
    assert (tree.outcome, tree.reason) == (Outcome.STOPPED, "stopped by the operator")
    assert robot.commands == [("pause_walking", pytest.approx(0.04))]
    assert tree.node("/t").leaf.calls.count("stop") == 1  # type: ignore[attr-defined]
    tree.send(SendGoal(Goal(1.0, 0.0, 0.0)))
    run(tree, robot, 5)
    assert tree.outcome is Outcome.STOPPED and len(robot.commands) == 1


def test_an_id_is_given_once_whoever_asks():
    tree, _ = make("{tree: t, root: Scripted}")
    assert [tree.context.new_id(kind) for kind in ("plan", "plan", "path", "plan")] == [0, 1, 0, 2]
