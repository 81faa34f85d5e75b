"""A trial fails where it must, and its pushes come when they should."""

import dataclasses

import numpy as np
import pytest
from scipy.stats import binomtest

from lookstep.bench.walking.cases import CASES
from lookstep.bench.walking.known_walks import KnownWalk
from lookstep.bench.walking.pushes import Push, force_at, random_pushes
from lookstep.bench.walking.trial import run_trial, write_limited_robot
from lookstep.configuration import load_configuration
from lookstep.wilson_interval import wilson_interval
from sim_envs.robot import RobotDescription
from skills.walking import RobotModel


@pytest.mark.parametrize(("ok", "of"), [(0, 10), (10, 10), (57, 60), (1, 3)])
def test_intervals_are_those_of_scipy(ok, of):
    interval = binomtest(ok, of).proportion_ci(method="wilson")
    assert wilson_interval(ok, of) == pytest.approx((interval.low, interval.high), abs=1e-6)


def test_a_push_after_a_landing_waits_for_it():
    push = Push(np.array((400.0, 0.0, 0.0)), 0.2, after_landing=3)
    assert not force_at([push], 5.0, {}).any()
    assert [float(force_at([push], t, {3: 5.0})[0]) for t in (5.19, 5.2, 5.29, 5.31)] == [0.0, 400.0, 400.0, 0.0]


def test_random_pushes_are_level_and_within_their_range():
    pushes = random_pushes(np.random.default_rng(0), 200.0, least=50.0, most=150.0, every=2.0)
    sizes = [float(np.linalg.norm(push.force_world)) for push in pushes]
    assert len(pushes) == 99 and 50.0 <= min(sizes) < 60.0 and 140.0 < max(sizes) <= 150.0
    assert all(push.force_world[2] == 0.0 for push in pushes)


def test_a_robot_that_stands_bears_a_push_and_not_ten_times_as_much():
    case = CASES["push_standing_600"].trial(0, None)
    assert isinstance(case.walk, KnownWalk) and case.walk.steps == ()
    configuration = load_configuration()
    small = dataclasses.replace(case, pushes=(Push(np.array((200.0, 0.0, 0.0)), 0.2),))
    large = dataclasses.replace(case, pushes=(Push(np.array((6000.0, 0.0, 0.0)), 0.2),))
    assert run_trial(small, configuration).ok
    assert "DCM" in run_trial(large, configuration).failure


def test_a_limited_robot_differs_in_its_ankles_alone(tmp_path):
    robot = RobotDescription()
    write_limited_robot(tmp_path / "limited.xml", robot, -1.0)
    whole, limited = RobotModel(robot.mjcf_path), RobotModel(tmp_path / "limited.xml")
    changed = whole.lower_limits != limited.lower_limits
    names = [name for name, differs in zip(whole.joint_names, changed, strict=True) if differs]
    assert names == ["left_ankle_pitch", "right_ankle_pitch"] and set(limited.lower_limits[changed]) == {-1.0}
    assert np.array_equal(whole.upper_limits, limited.upper_limits) and whole.mass == limited.mass
