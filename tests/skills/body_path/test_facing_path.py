"""Paths on which the robot faces as at the goal, and sub-goals on them."""

from __future__ import annotations

import numpy as np
import pytest

from skills.body_path import SubGoalParameters, facing_path, sub_goal
from skills.footsteps import Stance
from skills.geometry.pose import Pose

STANCE = Stance(Pose.from_xyz_rpy((0.0, 0.12, 0.0)), Pose.from_xyz_rpy((0.0, -0.12, 0.0)))
PARAMETERS = SubGoalParameters()


@pytest.mark.parametrize("goal", [(0.0, 2.0, 0.0), (-2.0, 0.0, 0.0), (-1.0, -2.0, 0.3)])
def test_it_leads_straight_and_faces_as_at_the_goal(goal):
    path = facing_path(np.zeros(3), np.array(goal), 0.7)
    np.testing.assert_allclose(path.waypoints_world[:, 2], goal[2])
    np.testing.assert_allclose(path.waypoints_world[[0, -1], :2], ((0.0, 0.0), goal[:2]))
    assert not path.squares_up, "it is enough to come near it"


@pytest.mark.parametrize(("turn", "asked"), [(0.5, 0.5), (3.0, 0.7), (-3.0, -0.7), (4.0, -0.7)])
def test_it_turns_the_short_way_and_no_farther_at_once_than_it_may(turn, asked):
    path = facing_path(np.zeros(3), np.array((0.0, 0.0, turn)), 0.7)
    assert path.at(0.0)[2] == pytest.approx(asked)
    assert sub_goal(path, STANCE, PARAMETERS).pose_world[2] == pytest.approx(asked)


def test_sub_goals_are_nearer_where_steps_are_short():
    reached = {}
    for name, goal in {"ahead": (3.0, 0.0, 0.0), "left": (0.0, 3.0, 0.0), "back": (-3.0, 0.0, 0.0)}.items():
        target = sub_goal(facing_path(np.zeros(3), np.array(goal), 0.7), STANCE, PARAMETERS)
        reached[name] = target.arc_length, target.search_arc_length
    assert reached["ahead"] == (PARAMETERS.ahead, PARAMETERS.ahead + PARAMETERS.search_beyond)
    for name in ("left", "back"):
        assert reached[name][0] == PARAMETERS.ahead_aside
        assert reached[name][1] - reached[name][0] < PARAMETERS.search_beyond
