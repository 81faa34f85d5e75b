"""Leaves of the modes: goals from here, headings, and the way of a carrot."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scripted_walk import PARAMETERS, WalkingRobot, feet_at, status_and_reason, tick, tree_of

from behaviors import Status, Tree, parse_tree
from behaviors.operator import MoveCarrot
from skills.body_path import BodyPath, Goal
from skills.geometry import Pose
from skills.walking import WalkingPhase


def at(x: float, y: float, yaw: float) -> WalkingRobot:
    """A robot that stands there."""
    robot = WalkingRobot()
    robot._feet = feet_at(0.0).moved(Pose.from_xyz_rpy((x, y, 0.0), (0.0, 0.0, yaw)))
    robot._say(WalkingPhase.STANDING, None, None, 0.0, 0.0)
    return robot


def giving(leaf: str, out: str, robot: WalkingRobot) -> Tree:
    """A leaf with an output, as a whole tree."""
    return Tree(parse_tree(f"{{tree: t, root: {{{leaf}: {{out: [{out}]}}}}}}"), robot, parameters=dict(PARAMETERS))


@pytest.mark.parametrize(
    ("setting", "goal"),
    [
        ({"left": 2.0}, (1.0 - 2.0, 2.0, np.pi / 2)),
        ({"forward": -2.0}, (1.0, 0.0, np.pi / 2)),
        ({"turn": 3.0}, (1.0, 2.0, np.pi / 2 + 3.0 - 2 * np.pi)),
    ],
)
def test_a_goal_from_here_is_told_as_the_robot_faces(setting: dict[str, float], goal: tuple[float, float, float]):
    tree = giving("GiveGoalFromHere", "goal", at(1.0, 2.0, np.pi / 2))
    for key, value in setting.items():
        tree.set_parameter("/t", key, value)
    tick(tree)
    np.testing.assert_allclose(tree.blackboard["goal"].xyyaw_world, goal, atol=1e-9)


def test_a_turn_is_over_with_the_heading_wherever_the_robot_stands():
    goal = Goal(0.0, 0.0, 3.1)
    assert status_and_reason(tree_of("FacesGoal: {in: [goal]}", at(0.3, 0.2, -3.1), goal=goal))[0] is Status.SUCCESS
    assert status_and_reason(tree_of("FacesGoal: {in: [goal]}", at(0.0, 0.0, 2.1), goal=goal)) == (
        Status.FAILURE,
        "1.0 rad to turn",
    )


def test_a_path_that_faces_the_goal_starts_where_the_feet_were_when_it_was_given():
    tree = tree_of("FaceGoal: {in: [goal], out: [path]}", at(1.0, 0.0, 0.0), goal=Goal(1.0, 2.0, 0.0))
    tick(tree)
    path: BodyPath = tree.blackboard["path"]
    np.testing.assert_allclose(path.waypoints_world, ((1.0, 0.0, 0.0), (1.0, 2.0, 0.0)), atol=1e-9)
    robot = tree.context.robot.robot
    robot._feet = feet_at(1.3)  # type: ignore[attr-defined]
    robot._say(WalkingPhase.STANDING, None, None, 0.0, 0.0)  # type: ignore[attr-defined]
    tree.root.stop(Status.INVALID)
    tick(tree)
    np.testing.assert_allclose(tree.blackboard["path"].waypoints_world[0], (1.0, 0.0, 0.0), atol=1e-9)


def carrot_tree(robot: WalkingRobot, **settings: Any) -> Tree:
    tree = giving("WatchCarrot", "goal, path", robot)
    for key, value in settings.items():
        tree.set_parameter("/t", key, value)
    return tree


def test_the_path_of_a_carrot_is_the_way_that_it_took():
    robot = at(0.0, 0.0, 0.0)
    tree = carrot_tree(robot)
    assert status_and_reason(tree) == (Status.RUNNING, "waits for a carrot")
    corner = [(x, 0.0, 0.0) for x in np.arange(0.1, 1.05, 0.1)] + [(1.0, y, 1.5) for y in np.arange(0.1, 1.05, 0.1)]
    for place in corner:
        tree.send(MoveCarrot(Goal(*map(float, place))))
        tick(tree)
    path: BodyPath = tree.blackboard["path"]
    assert path.length == pytest.approx(2.0, abs=0.05), "it goes around the corner, as the carrot did"
    assert path.at(path.project(np.array((1.0, 0.5))))[2] == pytest.approx(1.5, abs=0.05)
    robot._feet = feet_at(1.0)
    robot._say(WalkingPhase.STANDING, None, None, 0.0, 0.0)
    tree.send(MoveCarrot(Goal(1.0, 1.0, 1.5)))
    tick(tree)
    assert tree.blackboard["path"].length == pytest.approx(1.0, abs=0.12), "what lies behind the robot is dropped"


def test_following_ends_at_a_carrot_that_rests_and_not_before_the_robot_is_there():
    robot = at(0.0, 0.0, 0.0)
    tree = carrot_tree(robot, patience=0.5)
    tree.send(MoveCarrot(Goal(0.3, 0.0, 0.0)))
    tick(tree)
    assert tree.blackboard["path"] is None, "it is not worth a step yet"
    tree.send(MoveCarrot(Goal(1.0, 0.0, 0.0)))
    tick(tree, 50)
    assert tree.root.status is Status.RUNNING
    robot._feet = feet_at(1.0)
    robot._say(WalkingPhase.STANDING, None, None, 0.0, 0.0)
    tick(tree)
    assert tree.root.status is Status.SUCCESS
