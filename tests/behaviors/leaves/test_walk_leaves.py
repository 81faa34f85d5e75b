"""Commands to the walking controller, and waiting for it."""

from __future__ import annotations

import pytest
from scripted_walk import PERIOD, WalkingRobot, plan, status_and_reason, step, tick, tree_of

from behaviors import Status
from skills.footsteps import Footstep

SEND = "SendFootsteps: {in: [plan]}"
WAIT = "WaitForSwing: {in: [plan], fraction: 0.5, patience: 0.5}"


def ids(steps: tuple[Footstep, ...]) -> list[int]:
    return [sent.sequence_id for sent in steps]


@pytest.mark.parametrize(
    ("do", "expected"),
    [
        (lambda robot: robot.stand(), [3, 4, 5]),
        (lambda robot: robot.swing(step(2)), [3, 4, 5]),
        (lambda robot: robot.transfer(step(3)), [3, 4, 5]),
        (lambda robot: robot.swing(step(3)), [4, 5]),
        (lambda robot: (robot.settle(step(3)), robot.transfer(step(4, x=0.8))), [4, 5]),
        (lambda robot: robot.settle(step(3)), [4, 5]),
        (lambda robot: (robot.settle(step(3)), robot.settle(step(4, x=0.8))), [5]),
    ],
    ids=[
        "before all",
        "the step before swings",
        "weight shifts for the first",
        "the first swings",
        "weight shifts for the second",
        "the first landed",
        "the second landed",
    ],
)
def test_steps_that_began_while_the_plan_was_made_are_left_out(do, expected):
    robot = WalkingRobot()
    do(robot)
    tree = tree_of(SEND, robot, plan=plan(3))
    assert status_and_reason(tree) == (Status.SUCCESS, f"sent {len(expected)} steps")
    assert ids(robot.queue) == expected


@pytest.mark.parametrize("do", [WalkingRobot.swing, WalkingRobot.settle, lambda robot, last: robot.stand(last=last)])
def test_a_plan_of_which_every_step_has_begun_is_not_sent(do):
    robot = WalkingRobot()
    do(robot, step(5))
    tree = tree_of(SEND, robot, plan=plan(3))
    assert status_and_reason(tree) == (Status.FAILURE, "all planned steps have begun while they were planned")
    assert robot.commands == []


def test_a_plan_whose_first_step_began_elsewhere_is_not_sent():
    robot = WalkingRobot()
    robot.swing(step(3, x=0.34))
    tree = tree_of(SEND, robot, plan=plan(3))
    assert status_and_reason(tree) == (Status.FAILURE, "step 3 began 0.06 m from its place in the plan")
    assert robot.commands == []


def test_a_plan_is_made_when_few_enough_steps_are_left():
    robot = WalkingRobot()
    tree = tree_of("WaitForQueue: {most: 3}", robot)
    robot.swing(step(0), queue=plan(1).steps)
    assert status_and_reason(tree) == (Status.RUNNING, "4 footsteps are incomplete, limit 3")
    robot.swing(step(1), queue=plan(2, count=2).steps)
    assert status_and_reason(tree)[0] is Status.SUCCESS


@pytest.mark.parametrize("leaf", [SEND, WAIT])
def test_a_fallen_robot_is_neither_sent_nor_waited_for(leaf):
    robot = WalkingRobot()
    robot.swing(step(3))
    robot.fall()
    tree = tree_of(leaf, robot, plan=plan(3))
    assert status_and_reason(tree) == (
        Status.FAILURE,
        "the robot has fallen: the left sole swung into the ground",
    )
    assert robot.commands == []


@pytest.mark.parametrize(
    ("do", "status", "reason"),
    [
        (lambda robot: robot.swing(step(2), 1.0), Status.RUNNING, "waits for the swing to begin"),
        (lambda robot: robot.transfer(step(3)), Status.RUNNING, "waits for the swing to begin"),
        (lambda robot: robot.swing(step(3), 0.59), Status.RUNNING, "waits for 50 % of the swing"),
        (lambda robot: robot.swing(step(3), 0.6), Status.SUCCESS, ""),
        (lambda robot: robot.transfer(step(4)), Status.SUCCESS, "the step has landed"),
        (lambda robot: robot.settle(step(3)), Status.SUCCESS, "the step has landed"),
        (lambda robot: robot.stand(last=step(3)), Status.SUCCESS, "the step has landed"),
        (lambda robot: robot.stand(last=step(2)), Status.RUNNING, "waits for the step to begin"),
    ],
    ids=[
        "the step before swings",
        "weight shifts for it",
        "just before half",
        "half",
        "the next one begins",
        "landed, none follows",
        "stands after it",
        "stands before it",
    ],
)
def test_the_swing_is_waited_for_until_its_share_or_an_early_landing(do, status, reason):
    robot = WalkingRobot()
    do(robot)
    assert status_and_reason(tree_of(WAIT, robot, plan=plan(3))) == (status, reason)


def test_a_single_step_is_waited_for_until_it_has_landed():
    robot = WalkingRobot()
    tree = tree_of("WaitForSwing: {in: [plan], fraction: 1.0}", robot, plan=plan(3, count=1))
    robot.swing(step(3), 1.19)
    assert status_and_reason(tree)[0] is Status.RUNNING
    robot.settle(step(3))
    assert status_and_reason(tree)[0] is Status.SUCCESS


def test_a_robot_that_stands_although_steps_were_sent_is_a_failure_with_a_reason():
    robot = WalkingRobot()
    tree = tree_of(WAIT, robot, plan=plan(0))
    tick(tree, round(0.5 / PERIOD))
    assert tree.root.status is Status.RUNNING
    tick(tree, 2)
    assert (tree.root.status, tree.root.reason) == (Status.FAILURE, "the robot stands although steps were sent")


def test_pausing_drops_the_queue_at_once():
    robot = WalkingRobot()
    robot.send_footsteps(plan(0).steps)
    assert status_and_reason(tree_of("PauseWalking: {}", robot))[0] is Status.SUCCESS
    assert robot.commands[-1] == "pause_walking"
    assert robot.queue == ()


def test_standing_is_waited_for_until_both_feet_are_down_and_no_step_is_left():
    robot = WalkingRobot()
    tree = tree_of("WaitUntilStanding: {}", robot)
    for do in (robot.transfer, robot.swing, robot.settle):
        do(step(0))
        assert status_and_reason(tree) == (Status.RUNNING, "waits until the robot stands")
    robot.stand(last=step(0))
    assert status_and_reason(tree)[0] is Status.SUCCESS
