"""Clicks on the ground: the nearest of what is known of it, and two clicks as a place and a heading."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lookstep.panel.picking import Placing, box_under_click, ground_under_click
from sim_envs.courses import Box, load_course
from sim_envs.courses.ground import Ground
from skills.geometry import Pose
from skills.regions import PlanarRegions


def snapshot(boxes: tuple[Box, ...] = (), regions: PlanarRegions | None = None, feet: float = 0.0) -> Any:
    poses = {box.name: (tuple(box.T_world_box.p), tuple(box.T_world_box.quaternion_wxyz)) for box in boxes}
    values = {PlanarRegions: regions}
    return SimpleNamespace(
        stage=SimpleNamespace(boxes=boxes),
        boxes=poses,
        state=SimpleNamespace(stance=SimpleNamespace(mid_feet=np.array((0.0, 0.0, feet)))),
        value=values.get,
    )


def test_clicks_from_above_land_on_the_true_ground():
    course = load_course("rough", seed=2)
    known, ground = snapshot(course.boxes), Ground(course.boxes)
    rng = np.random.default_rng(0)
    hit = 0
    for x, y in rng.uniform((0.0, -0.5), (6.0, 0.5), (200, 2)):
        height = ground.ground_height(np.array([[x, y]]))[0]
        point = ground_under_click(np.array((x, y, 5.0)), np.array((0.0, 0.0, -2.0)), known)
        if np.isfinite(height):
            assert point is not None and np.allclose(point, (x, y, height), atol=1e-6)
            assert box_under_click(np.array((x, y, 5.0)), np.array((0.0, 0.0, -2.0)), known) is not None
            hit += 1
    assert hit > 150


def test_a_slanted_click_lands_where_the_ray_first_meets_a_box():
    box = Box("a", (1.0, 1.0, 0.4), Pose.from_xyz_rpy((2.0, 0.0, 0.2), (0.0, 0.0, 0.3)), "block")
    origin, target = np.array((-1.0, 0.0, 1.5)), np.array((2.0, 0.0, 0.4))
    point = ground_under_click(origin, target - origin, snapshot((box,)))
    assert point is not None and np.allclose(point, target)


def test_without_ground_a_click_lands_level_with_the_feet_and_into_the_sky_nowhere():
    known = snapshot(feet=0.3)
    point = ground_under_click(np.array((0.0, 0.0, 2.0)), np.array((1.0, 0.0, -1.0)), known)
    assert point is not None and np.allclose(point, (1.7, 0.0, 0.3))
    assert ground_under_click(np.array((0.0, 0.0, 2.0)), np.array((1.0, 0.0, 0.1)), known) is None


@pytest.mark.parametrize(
    ("origin", "direction"),
    (((np.nan, 0.0, 1.0), (0.0, 0.0, -1.0)), ((0.0, 0.0, 1.0), (0.0, 0.0, 0.0)), ((0, 0, 1.0), (np.inf, 0.0, -1.0))),
)
def test_rays_that_are_none_land_nowhere(origin, direction):
    assert ground_under_click(np.array(origin), np.array(direction), snapshot()) is None


def test_two_clicks_are_a_place_and_a_heading():
    placing, goal = Placing().clicked(np.array((2.0, 1.0, 0.1)))
    assert goal is None and placing.position_world == (2.0, 1.0, 0.1)
    same, goal = placing.clicked(np.array((2.001, 1.0, 0.1)))
    assert goal is None and same == placing  # A double click says no heading.
    after, goal = placing.clicked(np.array((2.0, 3.0, 0.0)))
    assert goal is not None and (goal.x, goal.y) == (2.0, 1.0) and goal.yaw == pytest.approx(np.pi / 2)
    assert after == Placing()
