"""There, look, and back, on a robot that stands where it is told: the second route, the wait, the end after a fall."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scripted_walk import PARAMETERS, WalkingRobot, feet_at, ground, plan, tick

from behaviors import Outcome, Tree, load_tree
from behaviors.leaves import look, plan_steps
from skills.geometry import Pose
from skills.regions import NoiseLevel, RegionExtraction
from skills.walking import WalkingPhase

SPEC = load_tree(Path(__file__).parents[3] / "trees" / "inspect_and_return.yaml")
WAY = "/inspect_and_return/run_while/sequence"


@pytest.fixture
def robot(monkeypatch: pytest.MonkeyPatch) -> WalkingRobot:
    """It sees ground and gets plans, and is put by the test where the tree wants it."""

    def examine(image, parameters):
        labels = np.zeros((1, 1), dtype=np.int16)
        return RegionExtraction(image, ground(image.time), labels, (0,), (), parameters, NoiseLevel())

    monkeypatch.setattr(look, "examine_regions", examine)
    monkeypatch.setattr(plan_steps, "plan_on_request", lambda request: plan(0))
    robot = WalkingRobot()
    robot.scan_id = 0
    return robot


@pytest.fixture
def tree(robot: WalkingRobot):
    settings = {f"{WAY}/there/direct": {"after": 8.0}, f"{WAY}/home": {"yaw": 0.0}}
    tree = Tree(SPEC, robot, parameters=dict(PARAMETERS), settings=settings)
    yield tree
    tree.shutdown()


def put(robot: WalkingRobot, x: float, y: float = 0.0) -> None:
    """On both feet at a place."""
    robot._feet = feet_at(0.0).moved(Pose.from_xyz_rpy((x, y, 0.0)))
    robot._say(WalkingPhase.STANDING, None, None, 0.0, 0.0)


def seconds(tree: Tree, duration: float) -> None:
    robot = tree.context.robot.robot
    for index in range(round(50 * duration)):
        robot.frame_id = 0 if robot.frame_id is None else robot.frame_id + 1  # type: ignore[attr-defined]
        robot.scan_id += index % 10 == 0  # type: ignore[attr-defined]
        tick(tree)


def test_the_direct_way_then_the_wait_then_back(tree: Tree, robot: WalkingRobot):
    seconds(tree, 0.5)
    assert (tree.blackboard["goal"].x, tree.blackboard["goal"].y) == (2.0, 0.0)
    put(robot, 2.0)
    seconds(tree, 3.0)
    assert tree.node(f"{WAY}/inspect").reason == "waits for 3 s"
    seconds(tree, 3.0)
    assert tree.blackboard["goal"].x == 0.0
    put(robot, 0.0)
    seconds(tree, 3.0)
    assert tree.outcome is Outcome.SUCCESS


def test_the_second_route_where_the_first_takes_too_long(tree: Tree, robot: WalkingRobot):
    seconds(tree, 8.5)
    assert tree.node(f"{WAY}/there/direct").reason == "took longer than 8 s"
    assert (tree.blackboard["goal"].x, tree.blackboard["goal"].y) == (1.0, 0.3)
    put(robot, 1.0, 0.3)
    seconds(tree, 3.0)
    assert (tree.blackboard["goal"].x, tree.blackboard["goal"].y) == (2.0, 0.0)
    put(robot, 2.0)
    seconds(tree, 3.0)
    assert tree.node(f"{WAY}/inspect").status.name == "RUNNING"


def test_a_fall_ends_it(tree: Tree, robot: WalkingRobot):
    seconds(tree, 0.5)
    robot.fall()
    tick(tree)
    assert tree.outcome is Outcome.FAILURE
    assert tree.reason.startswith("the robot has fallen")
