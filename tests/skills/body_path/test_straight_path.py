import numpy as np
import pytest

from skills.body_path import straight_path


def test_robot_turns_walks_and_turns():
    path = straight_path(np.array((1.0, 0.0, 0.5)), np.array((1.0, 4.0, -0.5)))
    np.testing.assert_allclose(
        path.waypoints_world, ((1, 0, 0.5), (1, 0.25, np.pi / 2), (1, 3.75, np.pi / 2), (1, 4, -0.5)), atol=1e-12
    )
    assert path.length == pytest.approx(4.0)


def test_short_ways_are_two_waypoints():
    path = straight_path(np.zeros(3), np.array((0.3, 0.0, 1.0)))
    np.testing.assert_allclose(path.waypoints_world, ((0, 0, 0), (0.3, 0, 1)))


def test_turn_on_the_spot_has_a_path():
    path = straight_path(np.zeros(3), np.array((0.0, 0.0, 1.0)))
    assert path.length == 0.0
    assert path.at(0.0)[2] == pytest.approx(1.0)
