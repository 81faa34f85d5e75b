"""An exception in any hook of any leaf, in the middle of a walk or alone: a safe stop in the same cycle."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scripted_walk import PARAMETERS, WalkingRobot, goal, ground, plan, step

from behaviors import Outcome, Status, Tree, known_leaves, load_tree, parse_tree
from behaviors.leaf import LeafNode
from behaviors.leaves import look, plan_steps
from behaviors.ports import declared_inputs
from skills.regions import NoiseLevel, RegionExtraction

SPEC = load_tree(Path(__file__).parents[3] / "trees" / "look_and_step.yaml")
LEAVES = [node.path for node in SPEC.root if node.is_leaf]
# Leaves that take longer than a tick, and so can be preempted while they run.
PREEMPTED = ("extract_regions", "update_height_map", "wait_for_goal", "plan_footsteps", "wait_for_swing")
# Every shipped leaf by itself; what is around it stops it then [s].
ALONE = sorted(cls.__name__ for cls in known_leaves().classes if cls.__module__.startswith("behaviors."))
STOPPED_AT = 60.0


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


@pytest.mark.parametrize("hook", ["setup", "start", "tick", "stop"])
@pytest.mark.parametrize("name", ALONE)
def test_a_leaf_that_raises_alone_stops_the_robot_too(name: str, hook: str, monkeypatch: pytest.MonkeyPatch):
    cls = known_leaves().get(name)
    assert cls is not None
    inputs = {port: told for port, told in declared_inputs(cls).items() if told.required}
    types = ", ".join(f"{port}: {told.type.__name__}" for port, told in inputs.items())
    root = f"{{timeout: {{after: {STOPPED_AT}, {name}: {{name: broken, in: {list(inputs)}}}}}}}"
    text = f"{{tree: t, ports: {{in: {{{types}}}}}, safe_stop: PauseWalking, root: {root}}}"
    robot = WalkingRobot()
    tree = Tree(parse_tree(text), robot, parameters=dict(PARAMETERS))
    node = tree.node("/t/broken")
    assert isinstance(node, LeafNode)
    node.replace_leaf(node.leaf)  # One that stands in does not wait for inputs.
    leaf = node.leaf
    for other in ("start", "stop"):
        monkeypatch.setattr(leaf, other, lambda: None)
    monkeypatch.setattr(leaf, "tick", lambda: Status.RUNNING)

    def broken() -> None:
        raise RuntimeError(f"broken {hook}")

    monkeypatch.setattr(leaf, hook, broken)
    ticks = 0
    while tree.outcome is Outcome.RUNNING and ticks < 5:
        assert "pause_walking" not in robot.commands
        robot.time = STOPPED_AT if ticks == 2 else tree.next_tick_time
        tree.tick()
        ticks += 1
    assert tree.outcome is Outcome.ERROR
    assert tree.reason == f"/t/broken: RuntimeError in {hook}: broken {hook}"
    assert ticks == (3 if hook == "stop" else 1)
    assert robot.commands.count("pause_walking") == 1
    assert all(node.status is Status.INVALID for node in tree.root.nodes)
    tree.shutdown()
