"""Decorators that let the robot stand: once, with a reason, and the child begins anew."""

from __future__ import annotations

from dataclasses import replace

import pytest
from scripted import ScriptedRobot, calls, footstep, make, run

from behaviors import Status
from skills.walking import WalkingPhase, WalkingStatus


class BusyRobot(ScriptedRobot):
    """In the middle of a step, until it is told to pause."""

    def status(self) -> WalkingStatus:
        standing = super().status()
        if any(name == "pause_walking" for name, _ in self.commands):
            return standing
        return replace(standing, phase=WalkingPhase.SWING, current_step=footstep())


HALT = "{tree: t, root: {halt_unless: {condition: {Scripted: {says: %s}}, child: {Scripted: {name: work, says: %s}}}}}"


def test_a_halt_stops_the_child_pauses_the_robot_once_and_the_child_begins_anew():
    tree, robot = make(HALT % ("SSFRFSS", "R"), BusyRobot())
    found = []
    for _ in range(7):
        run(tree, robot, 1)
        found.append((tree.root.status, tree.root.reason))
    assert {status for status, _ in found} == {Status.RUNNING}
    assert [reason for _, reason in found][1:6] == [
        "said R",
        "halted: said F",
        "halted: said R",
        "halted: said F",
        "said R",
    ]
    assert calls(tree, "/t/work") == ["start", "tick", "tick", "stop", "start", "tick", "tick"]
    assert robot.commands == [("pause_walking", pytest.approx(0.04))]
    assert [line.text for line in tree.drain_log()] == ["halted: said F", "goes on after 0.1 s"]


def test_a_robot_that_stands_is_not_told_to():
    tree, robot = make(HALT % ("FFS", "R"))
    run(tree, robot, 5)
    assert robot.commands == []


@pytest.mark.parametrize(("says", "status"), [("S", Status.SUCCESS), ("F", Status.FAILURE)])
def test_a_halt_ends_as_its_child_does(says, status):
    tree, robot = make(HALT % ("S", says), BusyRobot())
    run(tree, robot, 1)
    assert tree.root.status is status and robot.commands == []


def test_a_failure_pauses_the_robot_and_stays_a_failure():
    text = "{tree: t, root: {loop_forever: {pause_on_failure: {Scripted: {says: RSF}}}}}"
    tree, robot = make(text, BusyRobot())
    run(tree, robot, 2)
    assert robot.commands == []
    run(tree, robot, 1)
    node = tree.node("/t/pause_on_failure")
    assert (node.status, node.reason) == (Status.FAILURE, "said F")
    assert robot.commands == [("pause_walking", pytest.approx(0.04))]
    assert [line.text for line in tree.drain_log()] == ["pauses: said F"]
