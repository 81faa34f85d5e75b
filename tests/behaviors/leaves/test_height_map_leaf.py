"""Looking around: each scan joins the height map once, around the feet and on the way to a goal, where there is one."""

from __future__ import annotations

import pytest
from scripted_walk import PARAMETERS, WalkingRobot, feet_at, goal, status_and_reason, tick

from behaviors import JobOutcome, Status, Tree, parse_tree
from behaviors.leaves import height_map
from behaviors.operator import SendGoal
from skills.body_path import Goal
from skills.height_map import HeightMap, HeightMapper

LOOK_AROUND = """
tree: look_around
root:
  parallel:
    - loop_forever:
        UpdateHeightMap: {in: [goal], out: [height_map], latency: 0.04}
    - sequence:
        - WaitForGoal: {out: [goal]}
        - Wait: {duration: 60.0}
"""
STOPPED_BY_GOAL = """
tree: stopped
root:
  loop_forever:
    parallel:
      succeed_after: 1
      children:
        - loop_forever:
            UpdateHeightMap: {in: [goal], out: [height_map], latency: 0.04}
        - WaitForGoal: {out: [goal]}
"""
UPDATE = "/look_around/loop_forever/update_height_map"


@pytest.fixture
def robot() -> WalkingRobot:
    return WalkingRobot()


@pytest.fixture
def tree(robot):
    tree = Tree(parse_tree(LOOK_AROUND), robot, parameters=dict(PARAMETERS))
    yield tree
    tree.shutdown()


@pytest.fixture
def updates(monkeypatch: pytest.MonkeyPatch) -> list[tuple]:
    """Mapper, scan, feet and goal of each update."""
    asked: list[tuple] = []
    update = HeightMapper.update
    monkeypatch.setattr(height_map.HeightMapper, "update", lambda *given: asked.append(given) or update(*given))
    return asked


def take_scan(tree: Tree, robot: WalkingRobot, scan_id: int) -> None:
    """A new scan, and time enough to use it."""
    robot.scan_id = scan_id
    tick(tree, 5)


def test_it_waits_for_the_first_scan_with_a_reason(tree, updates):
    status_and_reason(tree)
    node = tree.node(UPDATE)
    assert (node.status, node.reason) == (Status.RUNNING, "waits for the first lidar scan")
    assert not updates


def test_each_scan_is_used_once(tree, robot, updates):
    take_scan(tree, robot, 0)
    tick(tree, 20)
    assert tree.node(UPDATE).reason == "waits for the next lidar scan"
    take_scan(tree, robot, 1)
    assert [scan.scan_id for _, scan, _, _ in updates] == [0, 1]
    delivered = tree.blackboard["height_map"]
    assert isinstance(delivered, HeightMap)
    assert delivered.scan_id == 1


def test_the_map_lies_around_the_feet_and_then_on_the_way_to_the_goal(tree, robot, updates):
    robot.stand(x=2.0)
    take_scan(tree, robot, 0)
    assert tree.blackboard["height_map"].origin_world.tolist() == pytest.approx([-3.0, -5.0])
    tree.send(SendGoal(Goal(6.0, 0.0, 0.0)))
    tick(tree)
    take_scan(tree, robot, 1)
    assert tree.blackboard["height_map"].origin_world.tolist() == pytest.approx([-1.0, -5.0])
    assert updates[-1][2].tolist() == feet_at(2.0).mid_feet.tolist()
    assert updates[-1][3].tolist() == [6.0, 0.0]


def test_an_update_that_is_dropped_leaves_no_trace(robot, updates):
    tree = Tree(parse_tree(STOPPED_BY_GOAL), robot, parameters=dict(PARAMETERS))
    tick(tree)
    robot.scan_id = 0
    tick(tree)
    tree.send(goal())
    tick(tree, 5)
    assert [job.outcome for job in tree.drain_jobs()] == [JobOutcome.CANCELLED]
    assert tree.blackboard["height_map"] is None
    robot.scan_id = 1
    tick(tree, 5)
    assert tree.blackboard["height_map"].scan_id == 1
    before, after = (mapper for mapper, *_ in updates)
    assert before is not after
    tree.shutdown()
