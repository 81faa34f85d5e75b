"""Guards say why the robot must not go on."""

from __future__ import annotations

import pytest
from scripted_walk import WalkingRobot, ground, status_and_reason, step, tree_of

from behaviors import Status
from behaviors.leaves.vain_attempts import VainAttempts
from skills.regions import PlanarRegions

GROUND_FRESH = "GroundFresh: {in: [ground], max_age: 1.5}"


@pytest.mark.parametrize(
    ("age", "status", "reason"),
    [
        (0.0, Status.SUCCESS, ""),
        (1.5, Status.SUCCESS, ""),
        (1.7, Status.FAILURE, "regions are 1.7 s old, limit 1.5 s"),
    ],
)
def test_old_regions_are_refused_with_their_age_and_the_limit(age, status, reason):
    robot = WalkingRobot()
    robot.time = age
    assert status_and_reason(tree_of(GROUND_FRESH, robot, ground=ground(0.0))) == (status, reason)


def test_ground_without_regions_is_refused():
    tree = tree_of(GROUND_FRESH, WalkingRobot(), ground=PlanarRegions((), 0.0, 0))
    assert status_and_reason(tree) == (Status.FAILURE, "no regions in sight")


def test_fallen_is_told_with_what_happened():
    robot = WalkingRobot()
    robot.swing(step(0))
    robot.fall()
    tree = tree_of("RobotFallen: {}", robot)
    assert status_and_reason(tree) == (
        Status.SUCCESS,
        "the robot has fallen: the left sole swung into the ground",
    )


@pytest.mark.parametrize(
    "do", [WalkingRobot.stand, lambda robot: robot.transfer(step(0)), lambda robot: robot.swing(step(0))]
)
def test_a_robot_on_its_feet_has_not_fallen(do):
    robot = WalkingRobot()
    do(robot)
    assert status_and_reason(tree_of("RobotFallen: {}", robot))[0] is Status.FAILURE


@pytest.mark.parametrize(
    ("count", "status", "reason"),
    [
        (4, Status.FAILURE, "4 of 5 attempts in a row were in vain"),
        (5, Status.SUCCESS, "blocked: 5 attempts to plan a step were in vain, the last: no way on"),
    ],
)
def test_the_way_is_blocked_after_so_many_attempts_in_vain(count, status, reason):
    vain = VainAttempts(count, (4.0, 0.0), "no way on")
    tree = tree_of("NoWayOn: {in: [vain], attempts: 5}", WalkingRobot(), vain=vain)
    assert status_and_reason(tree) == (status, reason)


def test_the_way_is_not_blocked_before_anything_was_planned():
    tree = tree_of("NoWayOn: {attempts: 5}", WalkingRobot())
    assert status_and_reason(tree) == (Status.FAILURE, "0 of 5 attempts in a row were in vain")
