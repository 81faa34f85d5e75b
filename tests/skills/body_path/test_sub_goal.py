import numpy as np
import pytest

from skills.body_path import BodyPath, Goal, SubGoalParameters, goal_reached, straight_path, sub_goal
from skills.footsteps.footstep import Stance
from skills.geometry.pose import Pose

PARAMETERS = SubGoalParameters()


def stance(x: float, y: float = 0.0, yaw: float = 0.0) -> Stance:
    side = 0.12 * np.array((-np.sin(yaw), np.cos(yaw)))
    left, right = (Pose.from_xyz_rpy((x + s * side[0], y + s * side[1], 0.0), (0.0, 0.0, yaw)) for s in (1, -1))
    return Stance(left, right)


def test_sub_goal_lies_ahead_of_the_feet_on_the_path():
    goal = sub_goal(straight_path(np.zeros(3), np.array((5.0, 0.0, 0.0))), stance(1.0, 0.3), PARAMETERS)
    np.testing.assert_allclose(goal.pose_world, (1.0 + PARAMETERS.ahead, 0.0, 0.0))
    assert goal.search_arc_length == pytest.approx(1.0 + PARAMETERS.ahead + PARAMETERS.search_beyond)
    np.testing.assert_allclose(goal.searched_world[[0, -1], 0], (1.0, 2.2))
    assert not goal.final


def test_sub_goal_is_nearer_in_a_tight_curve():
    corner = BodyPath(np.array(((0, 0, 0), (0.5, 0, 0), (0.7, 0.2, np.pi / 2), (0.7, 3, np.pi / 2))))
    assert sub_goal(corner, stance(0.0), PARAMETERS).arc_length == pytest.approx(PARAMETERS.ahead_in_curve)
    after = stance(0.7, 1.0, np.pi / 2)
    goal = sub_goal(corner, after, PARAMETERS)
    assert goal.arc_length - goal.start_arc_length == pytest.approx(PARAMETERS.ahead)


def test_search_ends_at_the_end_of_the_path():
    goal = sub_goal(straight_path(np.zeros(3), np.array((2.0, 0.0, 0.0))), stance(1.0), PARAMETERS)
    assert goal.final
    assert goal.search_arc_length == pytest.approx(2.0)
    np.testing.assert_allclose(goal.pose_world, (1.8, 0.0, 0.0))


def test_goal_is_reached_by_position_and_heading():
    goal = Goal(2.0, 0.0, 0.0)
    assert goal_reached(goal, stance(2.0 - 0.9 * PARAMETERS.goal_distance), PARAMETERS)
    assert not goal_reached(goal, stance(2.0 - 1.1 * PARAMETERS.goal_distance), PARAMETERS)
    assert goal_reached(goal, stance(2.0, yaw=0.9 * PARAMETERS.goal_yaw), PARAMETERS)
    assert not goal_reached(goal, stance(2.0, yaw=1.1 * PARAMETERS.goal_yaw), PARAMETERS)


def test_heading_is_compared_the_short_way_round():
    assert goal_reached(Goal(0.0, 0.0, np.pi), stance(0.0, yaw=-np.pi + 0.05), PARAMETERS)
