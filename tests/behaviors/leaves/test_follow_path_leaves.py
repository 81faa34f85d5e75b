"""From a goal along the body path: only a new goal counts, and everything starts from the imminent stance."""

from __future__ import annotations

import numpy as np
import pytest
from scripted_walk import PARAMETERS, WalkingRobot, goal, height_map, path, status_and_reason, step, tick, tree_of

from behaviors import Outcome, Status, Tree, parse_tree
from behaviors.operator import ResetBehavior, SendWaypoints
from skills.body_path import BodyPath, Goal, PathEnd

PLAN = "PlanBodyPath: {in: [goal, height_map], out: [path], latency: 0.04}"
AGAIN = "PlanBodyPath: {in: [goal, height_map], out: [path], latency: 0.04, period: 1.0}"
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
    tree = tree_of(PLAN, robot, goal=Goal(4.0, 1.0, 0.5), height_map=height_map())
    tick(tree, 3)
    assert tree.outcome is Outcome.SUCCESS
    assert tree.reason == "3.9 m, at the goal"
    waypoints = tree.blackboard["path"].waypoints_world
    assert waypoints[0].tolist() == [0.2, 0.0, 0.0]
    assert waypoints[-1].tolist() == [4.0, 1.0, 0.5]


def test_the_path_is_planned_again_after_the_period_and_at_once_to_a_new_goal():
    robot = WalkingRobot()
    tree = tree_of(f"loop_forever: {{{AGAIN}}}", robot, goal=Goal(4.0, 0.0, 0.0), height_map=height_map())
    tick(tree, 3)
    first = tree.blackboard["path"]
    assert first.leads_to(Goal(4.0, 0.0, 0.0))
    robot.stand(x=1.0)
    tick(tree, 40)
    assert tree.root.reason == "plans again every 1 s"
    tick(tree, 12)
    assert tree.blackboard["path"] is first
    wall = np.zeros((80, 80))
    wall[38:43, 25:27] = 1.0
    tree.set_input("height_map", height_map(wall))
    tick(tree, 50)
    around = tree.blackboard["path"]
    assert around.leads_to(Goal(4.0, 0.0, 0.0))
    assert np.abs(around.waypoints_world[:, 1]).max() > 0.5
    tree.set_input("goal", Goal(4.0, 2.0, 0.0))
    tick(tree, 3)
    assert tree.blackboard["path"].leads_to(Goal(4.0, 2.0, 0.0))


def test_a_goal_that_is_sent_while_the_robot_walks_replaces_the_old_one():
    tree = tree_of("parallel: [WatchGoal: {out: [goal]}, Wait: {duration: 1.0}]", WalkingRobot())
    for x in (3.0, 5.0):
        tree.send(goal(x))
        tick(tree)
        assert tree.blackboard["goal"] == Goal(x, 0.0, 0.0)
    tick(tree, 5)
    assert tree.blackboard["goal"] == Goal(5.0, 0.0, 0.0)


def test_the_sub_goal_lies_ahead_of_the_imminent_stance():
    robot = WalkingRobot()
    robot.stand(x=1.0)
    robot.swing(step(0, x=1.4), 0.6)
    tree = tree_of("FindSubGoal: {in: [path], out: [sub_goal, vain]}", robot, path=path())
    tick(tree)
    found = tree.blackboard["sub_goal"]
    assert found.start_arc_length == pytest.approx(1.2)
    assert found.arc_length == pytest.approx(1.2 + PARAMETERS["sub_goal"].ahead)


@pytest.mark.parametrize("end", [PathEnd.BORDER, PathEnd.GOAL_OCCUPIED, PathEnd.GOAL_CUT_OFF])
def test_where_a_path_ends_short_of_the_goal_the_robot_stands_and_says_why(end):
    robot = WalkingRobot()
    robot.stand(x=1.95)
    short = BodyPath(path(2.0).waypoints_world, end=end, goal_world=np.array((4.0, 0.0, 0.0)))
    tree = tree_of("GoalReached: {in: [goal, path]}", robot, path=short, goal=Goal(4.0, 0.0, 0.0))
    assert status_and_reason(tree)[0] is Status.FAILURE
    tree = tree_of("FindSubGoal: {in: [path], out: [sub_goal, vain]}", robot, path=short)
    assert status_and_reason(tree) == (Status.FAILURE, f"the path ends here, {end.value}")
    assert tree.blackboard["vain"].count == 1


def test_before_it_is_there_the_robot_walks_on_to_where_a_path_ends_short_of_the_goal():
    short = BodyPath(path(2.0).waypoints_world, end=PathEnd.BORDER, goal_world=np.array((4.0, 0.0, 0.0)))
    tree = tree_of("FindSubGoal: {in: [path], out: [sub_goal, vain]}", WalkingRobot(), path=short)
    assert status_and_reason(tree)[0] is Status.SUCCESS


def test_the_goal_is_reached_when_the_imminent_stance_is_there():
    robot = WalkingRobot()
    robot.stand(x=3.9)
    tree = tree_of("GoalReached: {in: [goal, path]}", robot, path=path(4.0), goal=Goal(4.0, 0.0, 0.0))
    assert status_and_reason(tree) == (Status.SUCCESS, "the imminent stance is at the goal")


def test_a_goal_ahead_is_not_reached_and_the_rest_of_the_way_is_told():
    robot = WalkingRobot()
    robot.stand(x=1.0)
    tree = tree_of("GoalReached: {in: [goal, path]}", robot, path=path(4.0), goal=Goal(4.0, 0.0, 0.0))
    assert status_and_reason(tree) == (Status.FAILURE, "3.0 m to go on the path")


ROUND = """{tree: t, root: {parallel: [WatchWaypoints: {out: [waypoints]}, loop_forever: {sequence: [
WaitForGoal: {in: [waypoints], out: [goal]}, Wait: {duration: 0.1}]}]}}"""
PLACES = SendWaypoints((Goal(1.0, 0.0, 0.0), Goal(2.0, 0.0, 0.0), Goal(3.0, 0.0, 0.0)))


def test_waypoints_are_given_in_turn_once():
    tree = Tree(parse_tree(ROUND), WalkingRobot())
    tree.send(PLACES)
    tick(tree, 60)
    assert [line.text for line in tree.drain_log()] == [
        "3 waypoints",
        *(f"waypoint {place} of 3: x {place:.2f} m, y 0.00 m" for place in (1, 2, 3)),
    ]
    assert tree.blackboard["goal"] is None
    tree.send(PLACES)
    tick(tree)
    assert tree.blackboard["goal"].x == 1.0  # The same places again are another round.


@pytest.mark.parametrize("event", (goal(9.0), ResetBehavior()), ids=("goal", "reset"))
def test_a_goal_or_a_reset_ends_the_round(event):
    tree = Tree(parse_tree(ROUND), WalkingRobot())
    tree.send(PLACES)
    tick(tree)
    tree.send(event)
    tick(tree, 30)
    assert tree.blackboard["waypoints"] is None
    assert not any("waypoint 2" in line.text for line in tree.drain_log())


def test_after_a_fall_no_waypoint_is_walked_to():
    robot = WalkingRobot()
    tree = Tree(parse_tree(ROUND), robot)
    tree.send(PLACES)
    tick(tree)
    robot.fall()
    tick(tree, 20)
    robot.stand()
    tick(tree, 20)
    assert not any("waypoint 2" in line.text for line in tree.drain_log())
