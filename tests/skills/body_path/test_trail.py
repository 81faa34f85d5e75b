"""The way that a moving place has taken, for whoever follows it."""

from __future__ import annotations

import numpy as np
import pytest

from skills.body_path import Goal, Trail

START = np.zeros((1, 3))


def circle(radius: float, angles: np.ndarray) -> list[Goal]:
    return [
        Goal(float(radius * np.sin(a)), float(radius - radius * np.cos(a)), float((a + np.pi) % (2 * np.pi) - np.pi))
        for a in angles
    ]


def test_it_is_where_the_place_has_been():
    trail = Trail(START)
    for place in circle(1.5, np.linspace(0.0, 1.0, 200)):
        trail = trail.to(place)
    path = trail.path()
    assert path.length == pytest.approx(1.5, rel=0.01)
    assert len(trail.poses_world) < 60, "places near each other are one"
    for place in circle(1.5, np.linspace(0.0, 1.0, 40)):
        x, y, yaw = path.at(path.project(place.xyyaw_world))
        assert np.hypot(x - place.x, y - place.y) < 2e-3
        assert yaw == pytest.approx(place.yaw, abs=0.05)
    assert tuple(path.waypoints_world[-1]) == tuple(circle(1.5, np.array((1.0,)))[0].xyyaw_world)


def test_what_lies_behind_is_dropped_and_the_rest_stays():
    trail = Trail(START)
    for x in np.arange(0.0, 2.0, 0.1):
        trail = trail.to(Goal(float(x), 0.0, 0.0))
    left = trail.behind(np.array((1.03, 0.2, 0.0)))
    assert 0.9 < left.poses_world[0, 0] <= 1.03
    np.testing.assert_array_equal(left.poses_world, trail.poses_world[-len(left.poses_world) :])
    beyond = trail.behind(np.array((9.0, 0.0, 0.0)))
    assert len(beyond.poses_world) >= 2 and beyond.path().length > 0.0


def test_a_place_that_rests_is_a_path_too():
    path = Trail(START).to(Goal(0.0, 0.0, 0.0)).path()
    assert path.length == 0.0 and not path.squares_up
    assert Trail(START).path().length == 0.0
