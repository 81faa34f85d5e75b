"""A fall is called exactly where its limits say."""

from dataclasses import replace

import numpy as np
import pytest
from small_worlds import slab, steps, world

from sim_envs.courses import Ground
from sim_envs.robot import RobotDescription
from sim_envs.worlds import FallDetector, FallParameters
from skills.geometry.polygon import convex_hull
from skills.geometry.pose import Pose
from skills.walking import WalkingPhase


@pytest.fixture
def swinging():
    """A robot in mid-swing of its left foot, and the ground it walks on."""
    robot = world()
    robot.send_footsteps(steps(3))
    while robot.status().phase is not WalkingPhase.SWING:
        robot.advance(0.01)
    robot.advance(0.2)
    return robot, Ground((slab(),))


def _detector():
    return FallDetector(FallParameters(), RobotDescription())


def _with_dcm(output, xy):
    return replace(output, dcm_world=np.array((*xy, 1.1)))


def test_the_dcm_may_be_five_centimetres_outside_the_feet_and_their_next_foothold(swinging):
    robot, ground = swinging
    output, status = robot.true_state(), robot.status()
    soles = (status.imminent_stance.T_world_left, status.imminent_stance.T_world_right)
    corners = np.column_stack((RobotDescription().sole_corners_sole, np.zeros(4)))
    hull = convex_hull(np.concatenate([(T @ corners)[:, :2] for T in soles]))
    middle = hull.mean(axis=0)
    for a, b in zip(hull, np.roll(hull, -1, axis=0), strict=True):
        outward = np.array((b[1] - a[1], a[0] - b[0])) / np.linalg.norm(b - a)
        for distance, falls in ((-0.02, False), (0.048, False), (0.052, True)):
            failure = _detector().check(_with_dcm(output, 0.5 * (a + b) + distance * outward), status, ground)
            assert bool(failure) is falls
    assert _detector().check(_with_dcm(output, middle), status, ground) == ""
    assert "5 cm outside" in _detector().check(_with_dcm(output, (hull[:, 0].max() + 0.051, 0.12)), status, ground)


def test_a_swinging_sole_may_be_two_centimetres_inside_the_ground(swinging):
    robot, ground = swinging
    status, stance = robot.status(), robot.true_state().stance
    sole = stance.T_world_left
    for z, falls in ((-0.019, False), (-0.021, True)):
        lowered = stance.with_sole(status.current_step.side, Pose(np.eye(3), np.array((*sole.p[:2], z))))
        failure = _detector().check(replace(robot.true_state(), stance=lowered), status, ground)
        assert failure.startswith("the left sole swung 2 cm into the ground at") is falls


def test_a_swinging_sole_beside_a_wall_is_not_in_the_ground(swinging):
    robot, _ = swinging
    wall = replace(slab(name="wall"), T_world_box=Pose.from_xyz_rpy((0.0, 0.0, 5.0)))
    assert _detector().check(robot.true_state(), robot.status(), Ground((slab(), wall))) == ""


def test_a_stance_sole_needs_ground_under_a_quarter_of_it_in_mid_stance(swinging):
    robot, _ = swinging
    robot.advance(0.15)
    output, status = robot.true_state(), robot.status()
    toe = output.stance.T_world_right.p[0] + 0.13
    for share, falls in ((0.15, True), (0.4, False)):
        edge = Ground((replace(slab(), T_world_box=Pose.from_xyz_rpy((toe - share * 0.26 + 2.5, 0.0, -0.1))),))
        failure = _detector().check(output, status, edge)
        assert failure.endswith("% of the right sole stood on ground") is falls
