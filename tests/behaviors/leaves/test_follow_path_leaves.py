"""From a goal along the body path: only a new goal counts, and everything starts from the imminent stance."""

from __future__ import annotations

import pytest
from scripted_walk import PARAMETERS, WalkingRobot, goal, path, status_and_reason, step, tick, tree_of

from behaviors import Outcome, Status, Tree, parse_tree
from skills.body_path import Goal

AGAIN_AND_AGAIN = "{tree: t, root: {loop_forever: {sequence: [WaitForGoal: {out: [goal]}, Wait: {duration: 0.1}]}}}"


def test_it_waits_until_a_goal_is_sent():
    tree = tree_of("WaitForGoal: {out: [goal]}", WalkingRobot())
    assert status_and_reason(tree) == (Status.RUNNING, "waits for a goal")
    tree.send(goal(3.0))
    tick(tree)
    assert tree.outcome is Outcome.SUCCESS
    assert tree.blackboard["goal"] == Goal(3.0, 0.0, 0.0)
    assert [line.text for line in tree.drain_log()] == ["new goal: x 3.00 m, y 0.00 m, yaw 0.00 rad"]


def test_the_newest_of_two_goals_counts():
    tree = tree_of("WaitForGoal: {out: [goal]}", WalkingRobot())
    tree.send(goal(3.0))
    tree.send(goal(5.0))
    tick(tree)
    assert tree.blackboard["goal"].x == 5.0


def test_whoever_asks_again_waits_for_a_new_goal():
    tree = Tree(parse_tree(AGAIN_AND_AGAIN), WalkingRobot())
    tree.send(goal(3.0))
    tick(tree, 3)
    assert tree.blackboard["goal"].x == 3.0
    tick(tree, 20)
    assert tree.blackboard["goal"] is None
    assert tree.root.reason == "waits for a goal"
    tree.send(goal(5.0))
    tick(tree)
    assert tree.blackboard["goal"].x == 5.0


def test_a_goal_for_a_fallen_robot_is_refused_and_forgotten():
    robot = WalkingRobot()
    robot.fall()
    tree = tree_of("WaitForGoal: {out: [goal]}", robot)
    tree.send(goal())
    tick(tree)
    assert tree.outcome is Outcome.RUNNING
    assert [(line.level, line.text) for line in tree.drain_log()] == [
        ("warning", "goal refused: the robot has fallen: the left sole swung into the ground")
    ]
    robot.stand()
    assert status_and_reason(tree) == (Status.RUNNING, "waits for a goal")


def test_the_body_path_leads_from_the_imminent_stance_to_the_goal():
    robot = WalkingRobot()
    robot.swing(step(0, x=0.4), 0.6)
    tree = tree_of("PlanBodyPath: {in: [goal], out: [path], latency: 0.04}", robot, goal=Goal(4.0, 1.0, 0.5))
    tick(tree, 3)
    assert tree.outcome is Outcome.SUCCESS
    assert tree.reason == "3.9 m to the goal"
    waypoints = tree.blackboard["path"].waypoints_world
    assert waypoints[0].tolist() == [0.2, 0.0, 0.0]
    assert waypoints[-1].tolist() == [4.0, 1.0, 0.5]


def test_the_sub_goal_lies_ahead_of_the_imminent_stance():
    robot = WalkingRobot()
    robot.stand(x=1.0)
    robot.swing(step(0, x=1.4), 0.6)
    tree = tree_of("FindSubGoal: {in: [path], out: [sub_goal]}", robot, path=path())
    tick(tree)
    found = tree.blackboard["sub_goal"]
    assert found.start_arc_length == pytest.approx(1.2)
    assert found.arc_length == pytest.approx(1.2 + PARAMETERS["sub_goal"].ahead)


def test_the_goal_is_reached_when_the_imminent_stance_is_there():
    robot = WalkingRobot()
    robot.stand(x=3.9)
    tree = tree_of("GoalReached: {in: [path]}", robot, path=path(4.0))
    assert status_and_reason(tree) == (Status.SUCCESS, "the imminent stance is at the goal")


def test_a_goal_ahead_is_not_reached_and_the_rest_of_the_way_is_told():
    robot = WalkingRobot()
    robot.stand(x=1.0)
    tree = tree_of("GoalReached: {in: [path]}", robot, path=path(4.0))
    assert status_and_reason(tree) == (Status.FAILURE, "3.0 m to go")
