"""Scripted boxes move once, in time, along the shorter way round."""

import numpy as np
import pytest

from sim_envs.courses import BoxEvent
from sim_envs.worlds.box_motion import BoxMotions
from skills.geometry.pose import Pose

_FAR = np.array([10.0, 0.0, 0.0])


def test_a_timed_box_is_half_way_at_half_time_and_still_afterwards():
    end = Pose.from_xyz_rpy((1.0, 2.0, 0.0), (0.0, 0.0, 1.0))
    motions = BoxMotions((BoxEvent("b", end, duration=2.0, time=1.0),))
    poses = {"b": Pose.identity()}
    assert motions.advance(0.99, _FAR, poses) == {}
    poses |= motions.advance(1.0, _FAR, poses)
    poses |= motions.advance(2.0, _FAR, poses)
    np.testing.assert_allclose(poses["b"].p, (0.5, 1.0, 0.0))
    assert poses["b"].yaw == pytest.approx(0.5)
    assert motions.advance(3.5, _FAR, poses)["b"] is end
    assert motions.advance(4.0, _FAR, poses) == {}


def test_a_near_robot_sets_off_a_box_only_once():
    end = Pose.from_xyz_rpy((0.0, 0.0, 1.0))
    motions = BoxMotions((BoxEvent("b", end, duration=0.0, distance=1.0),))
    poses = {"b": Pose.identity()}
    assert motions.advance(0.0, np.array([1.1, 0.0, 0.0]), poses) == {}
    assert motions.advance(0.1, np.array([0.9, 0.0, 5.0]), poses)["b"] is end
    assert motions.advance(0.2, np.array([0.5, 0.0, 0.0]), poses) == {}


def test_a_turn_takes_the_shorter_way_round():
    start, end = (Pose.from_xyz_rpy((0.0, 0.0, 0.0), (0.0, 0.0, yaw)) for yaw in (3.0, -3.0))
    motions = BoxMotions((BoxEvent("b", end, duration=1.0, time=0.0),))
    motions.advance(0.0, _FAR, {"b": start})
    assert abs(motions.advance(0.5, _FAR, {"b": start})["b"].yaw) == pytest.approx(np.pi)


def test_an_event_follows_the_one_before_it_of_the_same_box():
    up, down = Pose.from_xyz_rpy((0.0, 0.0, 1.0)), Pose.from_xyz_rpy((0.0, 0.0, -1.0))
    motions = BoxMotions(
        (
            BoxEvent("b", up, duration=0.0, distance=1.0),
            BoxEvent("c", up, duration=0.0, time=0.1),
            BoxEvent("b", down, duration=0.0, after=2.0),
        )
    )
    poses = {"b": Pose.identity(), "c": Pose.identity()}
    assert motions.advance(5.0, _FAR, poses) == {"c": up}
    assert motions.advance(6.0, np.zeros(3), poses) == {"b": up}
    assert motions.advance(7.9, _FAR, poses) == {}
    assert motions.advance(8.0, _FAR, poses) == {"b": down}
    assert motions.advance(99.0, np.zeros(3), poses) == {}
