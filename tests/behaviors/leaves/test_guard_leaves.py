"""Guards say why the robot must not go on."""

from __future__ import annotations

import numpy as np
import pytest
from scripted_walk import PARAMETERS, WalkingRobot, ground, path, status_and_reason, step, tick, tree_of

from behaviors import Status, Tree, parse_tree
from behaviors.leaves import guards
from behaviors.leaves.vain_attempts import VainAttempts
from skills.body_path import ImpassabilityParameters, Obstacle
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


def test_old_data_of_the_robot_is_refused_with_its_age_and_the_limit():
    robot = WalkingRobot()
    tree = tree_of("RobotDataFresh: {max_age: 0.5}", robot)
    assert status_and_reason(tree)[0] is Status.SUCCESS
    old = robot.state()
    robot.state = lambda: old  # type: ignore[method-assign]
    robot.time = 0.7
    tree = tree_of("RobotDataFresh: {max_age: 0.5}", robot)
    assert status_and_reason(tree) == (Status.FAILURE, "robot data is 0.7 s old, limit 0.5 s")


def test_disabled_is_told_with_what_happened():
    robot = WalkingRobot()
    assert status_and_reason(tree_of("RobotDisabled: {}", robot))[0] is Status.FAILURE
    robot.disable()
    assert status_and_reason(tree_of("RobotDisabled: {}", robot)) == (
        Status.SUCCESS,
        "the robot is disabled: motors off",
    )
    assert status_and_reason(tree_of("RobotFallen: {}", robot))[0] is Status.FAILURE


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


@pytest.mark.parametrize("came", [True, False])
def test_what_came_is_waited_for_some_time_and_what_was_only_not_seen_before_is_not(monkeypatch, came: bool):
    thing: list[Obstacle] = []
    monkeypatch.setattr(Obstacle, "has_come_since", lambda self, before: came)
    monkeypatch.setattr(guards, "find_obstacle", lambda *given, halted: thing[0] if thing else None)
    robot = WalkingRobot()
    robot.scan_id = 0
    look = "{loop_forever: {UpdateHeightMap: {out: [height_map]}}}"
    guard = "{loop_forever: {PathClear: {in: [path, height_map], out: [waits]}}}"
    tree = Tree(
        parse_tree(f"{{tree: t, ports: {{in: {{path: BodyPath}}}}, root: {{parallel: [{look}, {guard}]}}}}"),
        robot,
        parameters={**PARAMETERS, "impassability": ImpassabilityParameters(patience=2.0)},
    )
    node = next(node for node in tree.nodes if node.kind == "PathClear")
    tree.set_input("path", path())

    def after(seconds: float) -> tuple[Status, bool]:
        for _ in range(round(seconds / 0.1)):
            robot.scan_id += 1  # type: ignore[operator]
            tick(tree, 5)
        return node.status, tree.blackboard["waits"]

    for _ in range(2):
        assert after(0.5) == (Status.SUCCESS, False)
        thing.append(Obstacle(0.7, 1.7, np.zeros((4, 3))))
        assert after(1.8) == (Status.FAILURE, came)
        assert node.reason == "path blocked: something 1.7 m high stands 0.7 m ahead"
        assert after(0.4) == (Status.FAILURE, False)
        thing[:] = [Obstacle(1.2, 1.7, np.zeros((4, 3)))]
        assert after(0.4) == (Status.FAILURE if came else Status.SUCCESS, False)
        thing.clear()
    tree.shutdown()
