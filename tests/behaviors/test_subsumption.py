"""Suppressor, inhibitor and reset: what a signal does to a module that runs."""

from __future__ import annotations

from scripted import calls, letters, make, run

from behaviors import Outcome

SIGNAL = "condition: {Scripted: {name: signal, says: %s}}"


def test_suppress_stops_its_child_and_waits_with_the_signals_reason():
    tree, robot = make(f"{{tree: t, root: {{suppress: {{{SIGNAL % 'FSF'}, Scripted: {{name: work, says: R}}}}}}}}")
    run(tree, robot, 2)
    assert calls(tree, "/t/work") == ["start", "tick", "stop"]
    assert tree.root.reason == "suppressed: said S"
    run(tree, robot, 1)
    assert calls(tree, "/t/work") == ["start", "tick", "stop", "start", "tick"]


def test_suppression_outlasts_the_signal_by_the_hold_time():
    tree, robot = make(f"{{tree: t, root: {{suppress: {{hold: 0.1, {SIGNAL % 'SF'}, Scripted: {{name: work}}}}}}}}")
    run(tree, robot, 5)
    assert tree.outcome is Outcome.RUNNING
    run(tree, robot, 1)
    assert tree.outcome is Outcome.SUCCESS


def test_inhibit_lets_its_child_run_but_holds_back_what_it_gives():
    tree, robot = make(
        f"{{tree: t, root: {{loop_forever: {{inhibit: {{{SIGNAL % 'SSF'}, GiveNumber: {{out: [number]}}}}}}}}}}"
    )
    run(tree, robot, 2)
    assert letters(tree.nodes)[-1] == "S"
    assert tree.blackboard["number"] is None
    assert tree.node("/t/inhibit").reason == "inhibited: said S"
    run(tree, robot, 1)
    assert tree.blackboard["number"] == 1.0


def test_reset_begins_anew_once_a_signal():
    tree, robot = make(
        f"{{tree: t, root: {{reset: {{{SIGNAL % 'FFSSF'}, sequence: [Scripted, Scripted: {{name: work, says: R}}]}}}}}}"
    )
    run(tree, robot, 5)
    assert calls(tree, "/t/sequence/work") == ["start", "tick", "tick", "stop", "start", "tick", "tick", "tick"]
    assert calls(tree, "/t/sequence/scripted").count("start") == 2
