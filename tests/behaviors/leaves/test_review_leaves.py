"""The operator's checkpoints: an approval approves what it names and nothing else, and the robot stands meanwhile."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from scripted_walk import PARAMETERS, WalkingRobot, path, plan, status_and_reason, step, tick

from behaviors import Status, Tree, parse_tree
from behaviors.halt import HaltCause
from behaviors.operator import Approve, Reject, ReviewParameters, SwitchReview

ASKING = {**PARAMETERS, "review": ReviewParameters()}
THINGS = {
    "footsteps": ("ReviewFootsteps: {in: [plan]}", "plan", lambda number: plan(0, plan_id=number), "plan"),
    "body_path": ("ReviewBodyPath: {in: [path]}", "path", lambda number: path(path_id=number), "body path"),
}


@pytest.fixture(params=THINGS)
def checkpoint(request) -> str:
    return request.param


def asking(checkpoint: str, robot: WalkingRobot, number: int = 7) -> tuple[Tree, Callable[[int], None]]:
    """A checkpoint that waits, and how to put another thing before it."""
    leaf, key, thing, _ = THINGS[checkpoint]
    kind = type(thing(0)).__name__
    tree = Tree(
        parse_tree(f"{{tree: t, ports: {{in: {{{key}: {kind}}}}}, root: {{{leaf}}}}}"), robot, parameters=ASKING
    )
    tree.set_input(key, thing(number))
    return tree, lambda other: tree.set_input(key, thing(other))


def test_it_waits_without_an_end_and_says_for_what(checkpoint):
    tree, _ = asking(checkpoint, WalkingRobot())
    tick(tree, 500)
    name = THINGS[checkpoint][3]
    assert (tree.root.status, tree.root.reason) == (Status.RUNNING, f"waits for approval of {name} 7")
    (request,) = tree.context.reviews
    assert (request.checkpoint, request.item_id, request.path, request.since) == (checkpoint, 7, "/t", 0.0)
    assert [halt.cause for halt in tree.context.halts] == [HaltCause.REVIEW]
    assert [line.text for line in tree.drain_log()] == [f"{name} 7 waits for approval"]


def test_what_is_approved_goes_on_and_what_is_rejected_is_made_again(checkpoint):
    name = THINGS[checkpoint][3]
    for decision, status, reason in (
        (Approve(checkpoint, 7), Status.SUCCESS, f"{name} 7 is approved"),
        (Reject(checkpoint, 7), Status.FAILURE, f"{name} 7 is rejected by the operator"),
    ):
        tree, _ = asking(checkpoint, WalkingRobot())
        tick(tree, 3)
        tree.send(decision)
        assert status_and_reason(tree) == (status, reason)
        assert tree.context.reviews == [] and tree.context.halts == []


def test_decisions_on_another_thing_or_of_another_checkpoint_decide_nothing(checkpoint):
    other = next(name for name in THINGS if name != checkpoint)
    tree, replace = asking(checkpoint, WalkingRobot())
    tick(tree, 3)
    tree.send(Approve(other, 7))
    tree.send(Approve(checkpoint, 8))
    tick(tree)
    assert tree.root.status is Status.RUNNING
    replace(8)
    tree.send(Approve(checkpoint, 7))
    tree.drain_log()
    tick(tree)
    assert tree.root.status is Status.RUNNING
    assert [line.text for line in tree.drain_log()] == [
        f"approve 7 comes too late: {THINGS[checkpoint][3]} 8 waits for approval"
    ]
    tree.send(Approve(checkpoint, 8))
    assert status_and_reason(tree)[0] is Status.SUCCESS


def test_what_was_approved_before_anyone_asked_is_asked_all_the_same(checkpoint):
    tree, _ = asking(checkpoint, WalkingRobot())
    tree.send(Approve(checkpoint, 7))
    tick(tree, 5)
    assert tree.root.status is Status.RUNNING


def test_review_is_switched_off_while_it_waits_and_each_checkpoint_has_its_own_switch(checkpoint):
    other = next(name for name in THINGS if name != checkpoint)
    tree, _ = asking(checkpoint, WalkingRobot())
    tick(tree, 3)
    tree.send(SwitchReview(other, asks=False))
    tick(tree)
    assert tree.root.status is Status.RUNNING
    tree.send(SwitchReview(checkpoint, asks=False))
    assert status_and_reason(tree) == (Status.SUCCESS, "goes on without review")
    again, _ = asking(checkpoint, WalkingRobot())
    again.send(SwitchReview(checkpoint, asks=False))
    again.send(SwitchReview(checkpoint, asks=True))
    assert status_and_reason(again)[0] is Status.RUNNING


@pytest.mark.parametrize(
    ("do", "commands"),
    [
        (WalkingRobot.stand, []),
        (lambda robot: robot.swing(step(0)), ["pause_walking"]),
        (lambda robot: robot.transfer(step(0)), ["pause_walking"]),
    ],
)
def test_the_robot_finishes_its_step_and_stands_while_it_is_asked(checkpoint, do, commands):
    robot = WalkingRobot()
    do(robot)
    tree, _ = asking(checkpoint, robot)
    tick(tree, 20)
    assert robot.commands == commands
    tree.send(SwitchReview(checkpoint, asks=False))
    quiet = WalkingRobot()
    do(quiet)
    unasked, _ = asking(checkpoint, quiet)
    unasked.send(SwitchReview(checkpoint, asks=False))
    tick(unasked)
    assert quiet.commands == []
