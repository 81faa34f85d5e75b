"""The shipped tree on a scripted robot: what it sends when, and that a fall or a goal ends the walk for good."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scripted_walk import PARAMETERS, WalkingRobot, blocked_plan, goal, ground, plan, step, tick

from behaviors import JobOutcome, Outcome, Status, Tree, load_tree
from behaviors.leaves import look, plan_steps
from behaviors.leaves.plan_steps import PlanRequest
from skills.regions import NoiseLevel, RegionExtraction

SPEC = load_tree(Path(__file__).parents[3] / "trees" / "look_and_step.yaml")
WALK = "/look_and_step/walk/sequence"
PLAN_TICKS = 11  # 0.2 s of latency, and the tick that asks.
PLAN_PERIOD_TICKS = 25  # Plans begin at most every 0.5 s.


@pytest.fixture
def requests(monkeypatch: pytest.MonkeyPatch) -> list[PlanRequest]:
    """What plans were asked for; every image shows ground, and every plan has three steps."""
    asked: list[PlanRequest] = []

    def answer(request: PlanRequest):
        asked.append(request)
        return plan(request.first_sequence_id, plan_id=request.plan_id)

    def examine(image, parameters):
        return RegionExtraction(
            image, ground(image.time), np.zeros((1, 1), dtype=np.int16), (0,), (), parameters, NoiseLevel()
        )

    monkeypatch.setattr(plan_steps, "plan_on_request", answer)
    monkeypatch.setattr(look, "examine_regions", examine)
    return asked


@pytest.fixture
def robot() -> WalkingRobot:
    """It has looked around once, and seen nothing: the way leads straight over unseen ground."""
    robot = WalkingRobot()
    robot.scan_id = 0
    return robot


@pytest.fixture
def tree(robot, requests):
    tree = Tree(SPEC, robot, parameters=dict(PARAMETERS))
    yield tree
    tree.shutdown()


def walk_on(tree: Tree, ticks: int) -> None:
    """Tick, with a new depth image before each tick, and a new scan before each tenth."""
    robot = tree.context.robot.robot
    for _ in range(ticks):
        robot.frame_id = 0 if robot.frame_id is None else robot.frame_id + 1  # type: ignore[attr-defined]
        robot.scan_id = robot.frame_id // 10  # type: ignore[attr-defined]
        tick(tree)


def begin(tree: Tree, robot: WalkingRobot) -> None:
    """Send a goal and tick until the first plan is sent."""
    tree.send(goal())
    for _ in range(100):
        walk_on(tree, 1)
        if robot.queue:
            return
    raise AssertionError("no steps were sent")


def leaf(tree: Tree, name: str) -> tuple[Status, str]:
    (node,) = [node for node in tree.nodes if node.path.endswith(f"/{name}") and node.path.startswith(WALK)]
    return node.status, node.reason


def test_nothing_is_sent_before_a_goal(tree, robot):
    walk_on(tree, 50)
    assert robot.commands == ["pause_walking"]
    assert leaf(tree, "wait_for_goal") == (Status.RUNNING, "waits for a goal")


def test_the_next_plan_is_sent_while_the_foot_is_still_in_the_air(tree, robot, requests):
    begin(tree, robot)
    assert robot.commands == ["pause_walking", "send_footsteps"]
    robot.transfer(step(0))
    walk_on(tree, 40)
    robot.swing(step(0), 0.58)
    walk_on(tree, 1)
    assert len(requests) == 1
    robot.swing(step(0), 0.6)
    walk_on(tree, 1)
    for elapsed in np.arange(0.62, 0.83, 0.02):
        robot.swing(step(0), elapsed)
        walk_on(tree, 1)
    assert [(r.plan_id, r.first_sequence_id, r.first_side) for r in requests] == [(0, 0, None), (1, 1, step(1).side)]
    assert robot.commands[-1] == "send_footsteps"
    assert [sent.sequence_id for sent in robot.queue] == [1, 2, 3]


def test_old_ground_is_not_planned_on_and_the_operator_reads_why(tree, robot, requests):
    walk_on(tree, 10)
    tick(tree, 90)
    tree.send(goal())
    said = []
    for _ in range(40):
        tick(tree)
        said += [t.reason for t in tree.transitions if t.path.endswith("ground_fresh") and t.after is Status.FAILURE]
    assert said == ["regions are 1.9 s old, limit 1.5 s"]
    assert requests == [] and robot.commands == ["pause_walking"]


def test_a_fall_drops_the_queue_and_waits_for_a_new_goal(tree, robot):
    begin(tree, robot)
    robot.swing(step(0), 0.1)
    walk_on(tree, 5)
    robot.fall()
    walk_on(tree, 1)
    assert robot.commands == ["pause_walking", "send_footsteps", "pause_walking"]
    assert robot.queue == ()
    assert leaf(tree, "wait_for_goal") == (Status.RUNNING, "waits for a goal")
    assert tree.blackboard["goal"] is None
    assert tree.outcome is Outcome.RUNNING


def test_a_plan_of_the_old_goal_that_is_late_never_arrives(tree, robot, requests):
    begin(tree, robot)
    robot.swing(step(0), 0.6)
    for _ in range(PLAN_PERIOD_TICKS):
        if leaf(tree, "plan_footsteps")[0] is not Status.RUNNING:
            walk_on(tree, 1)
    assert leaf(tree, "plan_footsteps") == (Status.RUNNING, "computing")
    before = tree.blackboard["plan"]
    tree.drain_jobs()
    robot.fall()
    walk_on(tree, 2 * PLAN_TICKS)
    assert tree.blackboard["plan"] is before
    assert robot.commands[-1] == "pause_walking"
    assert [job.outcome for job in tree.drain_jobs() if job.path.endswith("plan_footsteps")] == [JobOutcome.CANCELLED]


def test_nothing_resumes_by_itself_when_the_robot_is_back_on_its_feet(tree, robot, requests):
    begin(tree, robot)
    robot.swing(step(0), 0.1)
    robot.fall()
    walk_on(tree, 5)
    tree.send(goal())
    walk_on(tree, 5)
    planned = len(requests)
    robot.stand(last=step(0))
    walk_on(tree, 100)
    assert len(requests) == planned
    assert robot.commands[-1] == "pause_walking"
    assert leaf(tree, "wait_for_goal") == (Status.RUNNING, "waits for a goal")


def test_after_a_fall_a_new_goal_begins_a_new_walk_whose_ids_follow_on(tree, robot, requests):
    begin(tree, robot)
    robot.swing(step(0), 0.1)
    robot.fall()
    walk_on(tree, 5)
    robot.stand(last=step(0))
    walk_on(tree, 5)
    begin(tree, robot)
    assert robot.commands == ["pause_walking", "send_footsteps"] * 2
    assert (requests[-1].first_sequence_id, requests[-1].first_side, requests[-1].reference) == (1, None, None)


def test_a_second_fall_ends_the_walk_as_the_first_did(tree, robot):
    for last in (None, step(0)):
        robot.stand(last=last)
        walk_on(tree, 5)
        begin(tree, robot)
        robot.fall()
        walk_on(tree, 5)
        assert robot.queue == ()
        assert leaf(tree, "wait_for_goal")[0] is Status.RUNNING


def test_the_walk_ends_when_the_robot_stands_at_the_goal_and_a_later_goal_is_another_run(tree, robot, requests):
    begin(tree, robot)
    robot.stand(x=4.0, last=step(8))
    walk_on(tree, 200)
    assert tree.outcome is Outcome.SUCCESS
    sent = len(robot.commands)
    tree.send(goal(8.0))
    walk_on(tree, 50)
    assert len(robot.commands) == sent


def test_a_robot_that_finds_no_way_on_stands_and_ends_with_the_reason(tree, robot, monkeypatch):
    begin(tree, robot)
    robot.swing(step(0), 0.6)
    monkeypatch.setattr(plan_steps, "plan_on_request", lambda request: blocked_plan())
    walk_on(tree, 10 * PLAN_PERIOD_TICKS)
    robot.stand(last=step(0))
    walk_on(tree, 9 * PLAN_PERIOD_TICKS)
    assert tree.outcome is Outcome.RUNNING
    walk_on(tree, 6 * PLAN_PERIOD_TICKS)
    assert tree.outcome is Outcome.FAILURE
    assert tree.reason == f"blocked: 20 attempts to plan a step were in vain, the last: {blocked_plan().reason}"
