"""The modes as whole walks, from depth images to steps; the long ones are sweeps."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from lookstep.options import RunOptions
from lookstep.summary import Outcome
from lookstep.walk import walk
from skills.geometry.pose import wrap_angle

SMALL_CAMERA = "camera.resolution=0.3125"
WIDE: dict[str, Any] = {"robot": "atlas_class_wide", "world": "kinematic", "preset": "fast"}


class Way:
    """Where the true mid-feet were, and how the robot faced."""

    def __init__(self) -> None:
        self.poses: list[tuple[float, float, float]] = []

    def observe(self, moment) -> None:
        stance = moment.state.stance
        self.poses.append((*stance.mid_feet[:2], stance.yaw))


def test_a_robot_with_cameras_around_steps_backward_and_faces_ahead():
    way = Way()
    options = RunOptions(
        tree="step_to", course="flat", goal=(-0.4, 0.0, 0.0), time_limit=15.0, assignments=(SMALL_CAMERA,), **WIDE
    )
    summary = walk(options, way)
    assert summary.outcome is Outcome.GOAL_REACHED, summary.reason
    poses = np.array(way.poses)
    assert poses[-1, 0] == pytest.approx(-0.4, abs=0.15)
    assert np.abs(poses[:, 2]).max() < 0.2 and np.abs(poses[:, 1]).max() < 0.15


def test_a_carrot_is_followed_on_the_way_that_it_takes():
    options = RunOptions(
        tree="carrot",
        course="uneven_field",
        seed=1,
        time_limit=8.0,
        world="kinematic",
        preset="fast",
        assignments=(SMALL_CAMERA,),
    )
    summary = walk(options)
    assert summary.outcome is Outcome.TIMEOUT
    assert summary.lateral_error_m is not None and summary.lateral_error_m < 0.1
    assert summary.distance_m > 0.7


@pytest.mark.sweep
@pytest.mark.parametrize("world", ["kinematic", "physics"])
@pytest.mark.parametrize("seed", range(3))
def test_a_figure_eight_is_followed_to_its_end(seed, world):
    options = RunOptions(tree="carrot", course="uneven_field", seed=seed, time_limit=120.0, world=world, preset="fast")
    summary = walk(options)
    assert summary.outcome is Outcome.GOAL_REACHED, summary.reason
    assert summary.lateral_error_m is not None and summary.lateral_error_m <= 0.15


@pytest.mark.sweep
@pytest.mark.parametrize("world", ["kinematic", "physics"])
@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize(
    ("tree", "course", "goal", "by"),
    [
        ("turn_in_place", "rough", (3.275, 0.0, 0.0), (0.0, 0.0, np.pi)),
        ("step_sideways", "rough_wide", (2.535, -0.975, 0.0), (0.0, 2.0, 0.0)),
        ("step_backward", "rough_wide", (3.275, 0.195, 0.0), (-2.0, 0.0, 0.0)),
    ],
)
def test_it_turns_and_steps_aside_and_back_on_rough_ground(tree, course, goal, by, seed, world):
    way = Way()
    options = RunOptions(tree=tree, course=course, seed=seed, goal=goal, time_limit=90.0, **{**WIDE, "world": world})
    summary = walk(options, way)
    assert summary.outcome is Outcome.GOAL_REACHED, summary.reason
    assert abs(wrap_angle(way.poses[-1][2] - goal[2] - by[2])) < 0.3
    assert np.hypot(way.poses[-1][0] - goal[0] - by[0], way.poses[-1][1] - goal[1] - by[1]) < 0.5
