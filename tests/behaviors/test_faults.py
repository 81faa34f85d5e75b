"""An exception in any hook of any leaf: recorded, others stopped once, safe stop ticked in the same cycle."""

from __future__ import annotations

import pytest
from scripted import ScriptedRobot, calls, leaf_of, letters, make, run

from behaviors import Outcome, Status

COMPOSITES = ["sequence", "reactive_sequence", "selector", "reactive_selector", "parallel", "reactive_parallel"]
DECORATORS = ["inverter", "retry", "timeout", "rate_limit", "loop_forever", "force_success"]

# The broken leaf runs beside another; from the third tick on, a guard preempts both.
TREE = """
tree: t
safe_stop: PauseWalking
root:
  reactive_sequence:
    - Scripted: {{name: guard, says: SSF}}
    - parallel:
        - Scripted: {{name: before, says: R}}
        - {around}: {{{broken}}}
        - Scripted: {{name: after, says: R}}
"""
FAULT_TICK = {"setup": 1, "start": 1, "tick": 1, "stop": 3}


def broken(around: str, hook: str) -> str:
    leaf = f"Scripted: {{name: broken, says: R, breaks: {hook}}}"
    return f"children: [{leaf}]" if around in COMPOSITES else f"child: {{{leaf}}}"


@pytest.mark.parametrize("hook", ["setup", "start", "tick", "stop"])
@pytest.mark.parametrize("around", COMPOSITES + DECORATORS)
def test_a_fault_stops_the_others_once_and_ticks_the_safe_stop_in_the_same_cycle(around: str, hook: str):
    tree, robot = make(TREE.format(around=around, broken=broken(around, hook)))
    run(tree, robot, FAULT_TICK[hook])

    assert tree.outcome is Outcome.ERROR
    assert robot.commands == [("pause_walking", robot.time)]
    path = f"/t/parallel/{around}/broken"
    assert tree.reason == f"{path}: RuntimeError in {hook}: broken {hook}"
    fault = tree.faults[0]
    assert (fault.path, fault.phase, fault.type, fault.time) == (path, hook, "RuntimeError", robot.time)
    assert "broken" in fault.traceback and "scripted.py" in fault.traceback
    assert any(line.level == "error" and "Traceback" in line.text for line in tree.drain_log())
    for name in ("before", "after"):
        hooks = calls(tree, f"/t/parallel/{name}")
        assert hooks.count("stop") == hooks.count("start")
    assert all(node.status is Status.INVALID for node in tree.root.nodes)

    run(tree, robot, 3)
    tree.shutdown()
    assert len(robot.commands) == 1
    for name in ("before", "after"):
        hooks = calls(tree, f"/t/parallel/{name}")
        assert hooks.count("stop") == hooks.count("start")


@pytest.mark.parametrize(("hook", "stops"), [("start", 0), ("tick", 1), ("stop", 1)])
def test_a_broken_leaf_is_stopped_only_where_it_had_started(hook: str, stops: int):
    tree, robot = make(TREE.format(around="sequence", broken=broken("sequence", hook)))
    run(tree, robot, 4)
    assert calls(tree, "/t/parallel/sequence/broken").count("stop") == stops


def test_every_leaf_is_set_up_although_one_breaks():
    tree, robot = make("{tree: t, root: {sequence: [Scripted: {breaks: setup}, Scripted: {breaks: setup}, Scripted]}}")
    tree.setup()
    assert [fault.path for fault in tree.faults] == ["/t/scripted", "/t/scripted_2"]
    run(tree, robot, 1)
    assert tree.outcome is Outcome.ERROR
    assert calls(tree, "/t/scripted_3") == []


def test_a_status_that_is_none_is_a_fault(monkeypatch: pytest.MonkeyPatch):
    tree, robot = make("{tree: t, root: Scripted}")
    leaf = leaf_of(tree, "/t")
    monkeypatch.setattr(leaf, "tick", lambda: None)
    run(tree, robot, 1)
    assert tree.reason == "/t: TypeError in tick: tick() returned None, needs SUCCESS, FAILURE or RUNNING"


def test_a_safe_stop_that_takes_long_is_ticked_until_it_is_done():
    tree, robot = make(
        "{tree: t, root: {Scripted: {breaks: tick}}, safe_stop: {sequence: [Scripted: {says: RRS}, PauseWalking]}}"
    )
    run(tree, robot, 5)
    assert [command for command, _ in robot.commands] == ["pause_walking"]
    assert robot.commands[0][1] == pytest.approx(0.04)


@pytest.mark.parametrize("safe_stop", ["", ", safe_stop: {Scripted: {breaks: tick}}"])
def test_the_robot_pauses_where_no_safe_stop_works(safe_stop: str):
    tree, robot = make(f"{{tree: t, root: {{Scripted: {{breaks: tick}}}}{safe_stop}}}")
    run(tree, robot, 3)
    assert [command for command, _ in robot.commands] == ["pause_walking"]


def test_a_robot_that_breaks_is_a_fault_and_no_crash():
    class BrokenRobot(ScriptedRobot):
        def state(self):
            raise OSError("no connection")

    tree, robot = make("{tree: t, root: {Scripted: {says: R}}}", BrokenRobot())
    run(tree, robot, 2)
    assert tree.outcome is Outcome.ERROR
    assert tree.reason == "/t: OSError in tick: no connection"
    assert robot.commands == [("pause_walking", 0.0)]
    assert letters(tree.nodes) == "."


def test_a_clock_that_runs_backwards_is_a_fault():
    tree, robot = make("{tree: t, root: {Scripted: {says: R}}}")
    robot.time = 5.0
    tree.tick()
    robot.time = 4.0
    tree.tick()
    assert tree.outcome is Outcome.ERROR
    assert tree.reason.endswith("robot time went back from 5.000000 s to 4.000000 s")
