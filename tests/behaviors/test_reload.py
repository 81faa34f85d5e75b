"""A tree that takes over from another: what ran is stopped once, the run and its trace go on."""

from __future__ import annotations

from pathlib import Path

import pytest
from scripted import calls, leaf_of, make, run, toys

from behaviors import Outcome, Trace, parse_tree
from behaviors.operator import SendGoal
from behaviors.recorded_trace import RecordedTrace
from skills.body_path import Goal
from skills.parameters import ParameterError

FIRST = "{tree: t, root: {sequence: [GiveNumber: {out: [number]}, Scripted: {says: R}]}}"
SECOND = "{tree: t, root: {sequence: [GiveNumber: {out: [number]}, AddOne: {in: [number], out: [sum]}, Scripted: {name: last, says: R}]}}"  # noqa: E501


def test_what_runs_is_stopped_once_and_the_new_tree_begins(tmp_path: Path):
    path = "/t/give_number"
    tree, robot = make(FIRST, settings={path: {"value": 4.0}, "/t/scripted": {"says": "RR"}})
    tree.trace = Trace(tmp_path / "trace.jsonl")
    run(tree, robot, 3)
    old = leaf_of(tree, "/t/scripted")
    tree.send(SendGoal(Goal(1.0, 2.0, 0.5)))
    tree.reload(parse_tree(SECOND, toys))
    run(tree, robot, 2)
    assert old.calls.count("stop") == 1  # type: ignore[attr-defined]
    assert tree.outcome is Outcome.RUNNING and tree.blackboard["sum"] == 5.0
    assert calls(tree, "/t/last") == ["start", "tick", "tick"]
    tree.shutdown()

    trace = RecordedTrace(tmp_path / "trace.jsonl")
    ticks = list(trace.ticks())
    assert [tick.tick for tick in ticks] == [0, 1, 2, 3, 4] and len(trace) == 5
    assert [tick.taken_over is not None for tick in ticks] == [False, False, False, True, False]
    assert "/t/scripted" in ticks[2].status and "/t/scripted" not in ticks[3].status
    assert ticks[3].happened("operator") == [{"name": "goal", "value": [1.0, 2.0, 0.5]}]
    assert set(trace.nodes) == {"/t", "/t/give_number", "/t/scripted", "/t/add_one", "/t/last"}


def test_a_run_that_was_taken_over_has_another_hash():
    hashes = set()
    for taken_over in (False, True):
        tree, robot = make(FIRST)
        run(tree, robot, 2)
        if taken_over:
            tree.reload(parse_tree(FIRST, toys))
        run(tree, robot, 2)
        hashes.add(tree.trace.hash)
    assert len(hashes) == 2


def test_the_old_tree_stays_where_a_setting_does_not_fit_the_new_one():
    tree, robot = make("{tree: t, root: {sequence: [Scripted: {says: R, name: x}]}}", settings={"/t/x": {"says": "R"}})
    run(tree, robot, 1)
    with pytest.raises((ParameterError, ValueError)):
        tree.reload(parse_tree("{tree: t, root: {sequence: [GiveNumber: {out: [number], name: x}]}}", toys))
    run(tree, robot, 1)
    assert calls(tree, "/t/x") == ["start", "tick", "tick"]
