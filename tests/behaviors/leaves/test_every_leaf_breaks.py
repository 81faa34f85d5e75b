"""An exception in any hook of any leaf of the shipped tree, in the middle of a walk: a safe stop in the same cycle."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scripted_walk import PARAMETERS, WalkingRobot, goal, ground, plan, step

from behaviors import Outcome, Status, Tree, load_tree
from behaviors.leaf import LeafNode
from behaviors.leaves import look, plan_steps
from skills.regions import NoiseLevel, RegionExtraction

SPEC = load_tree(Path(__file__).parents[3] / "trees" / "look_and_step.yaml")
LEAVES = [node.path for node in SPEC.root if node.is_leaf]
# Leaves that take longer than a tick, and so can be preempted while they run.
PREEMPTED = ("extract_regions", "update_height_map", "wait_for_goal", "plan_footsteps", "wait_for_swing")


@pytest.fixture(autouse=True)
def skills(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every image shows ground, and every plan has three steps."""

    def examine(image, parameters):
        return RegionExtraction(
            image, ground(image.time), np.zeros((1, 1), dtype=np.int16), (0,), (), parameters, NoiseLevel()
        )

    monkeypatch.setattr(plan_steps, "plan_on_request", lambda asked: plan(asked.first_sequence_id))
    monkeypatch.setattr(look, "examine_regions", examine)


def walk(tree: Tree, robot: WalkingRobot, falls_at: int | None = None):
    """From a goal over one step to the next goal, tick by tick."""
    robot.frame_id = robot.scan_id = 0
    for index in range(120):
        if index % 5 == 0 and index < 84:
            robot.frame_id, robot.scan_id = robot.frame_id + 1, robot.scan_id + 1
        if index == 10:
            tree.send(goal())
        if index == 40:
            robot.transfer(step(0))
        if index == 50:
            robot.swing(step(0), 0.7)
        if index == 75:
            robot.swing(step(1), 0.1)
        if index == 85:
            robot.stand(x=4.0, last=step(1))
        if index == falls_at:
            robot.fall()
        robot.commands.clear()
        robot.time = tree.next_tick_time
        tree.tick()
        yield index


@pytest.mark.parametrize("hook", ["setup", "start", "tick", "stop"])
@pytest.mark.parametrize("path", LEAVES, ids=lambda path: path.rpartition("/")[2])
def test_a_leaf_that_raises_stops_the_robot_in_the_same_cycle(path: str, hook: str, monkeypatch: pytest.MonkeyPatch):
    if hook == "stop" and not path.endswith(PREEMPTED):
        pytest.skip("ends in the tick in which it starts, or is not running when something preempts it")
    robot = WalkingRobot()
    tree = Tree(SPEC, robot, parameters=dict(PARAMETERS))
    node = tree.node(path)
    assert isinstance(node, LeafNode)

    def broken() -> Status:
        raise RuntimeError("broken")

    monkeypatch.setattr(node.leaf, hook, broken)
    # Falls while the leaf runs, so that it is preempted.
    falls = {"wait_for_goal": 8, "plan_footsteps": 52, "wait_for_swing": 45}.get(path.rpartition("/")[2])
    for _ in walk(tree, robot, falls if hook == "stop" else None):
        if tree.faults:
            break
        assert tree.outcome is not Outcome.ERROR
    assert {(fault.path, fault.phase) for fault in tree.faults} == {(path, hook)}
    assert tree.outcome is Outcome.ERROR
    assert robot.commands[-1] == "pause_walking"
    assert all(found.status is Status.INVALID for found in tree.root.nodes)
    assert tree.context.executor.pending == ()
    tree.shutdown()
