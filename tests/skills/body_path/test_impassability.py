"""What stands in the way: things of the body's height on the path, and no steps, no slopes, nor what is beside it."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from skills.body_path import BodyPath, ImpassabilityParameters, find_obstacle, straight_path
from skills.footsteps import Stance
from skills.geometry import Array, Pose
from skills.height_map import HeightMap
from skills.height_map.height_map import ScanAccount

RULES = ImpassabilityParameters()
RESOLUTION = 0.05
AHEAD = straight_path(np.zeros(3), np.array((4.0, 0.0, 0.0)))


def height_map(height: Callable[[Array, Array], Array]) -> HeightMap:
    """A map of 8 x 8 m around the origin with heights by x and y."""
    cells = RESOLUTION * (np.arange(160) + 0.5) - 4.0
    x, y = (np.asarray(grid, dtype=np.float64) for grid in np.meshgrid(cells, cells))
    heights = np.asarray(height(x, y) + np.zeros_like(x), dtype=np.float32)
    no = np.zeros(heights.shape, dtype=np.bool_)
    return HeightMap(
        heights, np.full_like(heights, 1e-4), no, RESOLUTION, np.array((-4.0, -4.0)), 0.0, 0, 0.0, ScanAccount()
    )


def box(x: float, y: float, height: float, size: float = 0.4) -> Callable[[Array, Array], Array]:
    """Level ground with a square box on it."""
    return lambda xs, ys: np.where((abs(xs - x) < size / 2) & (abs(ys - y) < size / 2), height, 0.0)


def stance_at(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> Stance:
    return Stance(Pose.from_xyz_rpy((x, y + 0.12, z)), Pose.from_xyz_rpy((x, y - 0.12, z)))


def found(height: Callable[[Array, Array], Array], path: BodyPath = AHEAD, stance: Stance | None = None, **rules):
    rules = ImpassabilityParameters(**rules)
    return find_obstacle(path, stance or stance_at(), height_map(height), rules)


def test_a_person_on_the_path_is_found_where_it_begins():
    obstacle = found(box(1.5, 0.1, 1.7))
    assert obstacle is not None
    assert obstacle.distance == pytest.approx(1.3, abs=RESOLUTION)
    assert obstacle.height == pytest.approx(1.7, abs=1e-3)
    assert np.abs(obstacle.points_world[:, 1]).max() <= 0.5 * RULES.width + RESOLUTION
    assert obstacle.points_world[:, 2] == pytest.approx(1.7, abs=1e-3)


@pytest.mark.parametrize(
    ("x", "y", "height"),
    [(2.4, 0.0, 1.7), (1.5, 0.6, 1.7), (1.5, 0.0, 0.4), (1.5, 0.0, 2.2), (-1.0, 0.0, 1.7), (0.05, 0.0, 1.7)],
    ids=["beyond the horizon", "beside the path", "a block to step on", "above the head", "behind", "the robot itself"],
)
def test_what_the_body_does_not_meet_is_no_obstacle(x, y, height):
    assert found(box(x, y, height)) is None


def test_an_obstacle_moves_with_the_robot_along_the_path_and_turns_with_it():
    obstacle = found(box(1.5, 0.0, 1.7), stance=stance_at(x=0.5))
    assert obstacle is not None and obstacle.distance == pytest.approx(0.8, abs=RESOLUTION)
    turning = BodyPath(np.array([(0.0, 0.0, 0.0), (1.0, 0.0, math.pi / 2), (1.0, 3.0, math.pi / 2)]))
    assert found(box(1.7, 0.0, 1.7), turning) is None
    around = found(box(1.0, 0.6, 1.7), turning)
    assert around is not None and around.distance == pytest.approx(1.4, abs=2 * RESOLUTION)


def test_stairs_slopes_and_gaps_are_ground_however_high_they_lead():
    def stairs(x: Array, y: Array) -> Array:
        return 0.2 * np.clip(np.floor((x - 0.3) / 0.3), 0.0, 10.0)

    def slope(x: Array, y: Array) -> Array:
        return math.tan(math.radians(25.0)) * x

    def ditch(x: Array, y: Array) -> Array:
        return np.where((x > 0.8) & (x < 1.2), -0.8, 0.0)

    def pit(x: Array, y: Array) -> Array:
        return np.where((x > 0.8) & (x < 1.2), np.nan, 0.1)

    assert [found(way) for way in (stairs, slope, ditch, pit)] == [None] * 4
    assert found(lambda x, y: stairs(-x, y), stance=stance_at(z=0.0)) is None
    on_the_stairs = found(lambda x, y: stairs(x, y) + box(1.5, 0.0, 1.0)(x, y))
    assert on_the_stairs is not None and on_the_stairs.distance == pytest.approx(1.3, abs=RESOLUTION)


def test_nothing_unknown_and_no_spike_is_an_obstacle():
    assert found(lambda x, y: np.full_like(x, np.nan)) is None
    spikes = box(1.5, 0.0, 1.0, size=0.1)
    assert found(spikes, cells=5) is None
    assert found(spikes, cells=4) is not None


def test_the_way_ends_with_the_path():
    short = straight_path(np.zeros(3), np.array((1.0, 0.0, 0.0)))
    assert found(box(1.5, 0.0, 1.7), short) is None


def test_a_thing_has_come_where_low_ground_was_seen_before_and_only_there():
    person = box(1.5, 0.0, 1.7)
    obstacle = found(person)
    assert obstacle is not None
    unseen = height_map(lambda x, y: np.where(x > 1.0, np.nan, 0.0))
    assert obstacle.has_come_since(height_map(lambda x, y: 0.0 * x))
    assert not obstacle.has_come_since(unseen)
    assert not obstacle.has_come_since(height_map(person))


def test_a_halted_robot_needs_a_little_more_than_the_horizon_to_go_on():
    seen = height_map(box(2.2, 0.0, 1.7))
    assert find_obstacle(AHEAD, stance_at(), seen, RULES) is None
    assert find_obstacle(AHEAD, stance_at(), seen, RULES, halted=True) is not None
    assert find_obstacle(AHEAD, stance_at(), height_map(box(2.5, 0.0, 1.7)), RULES, halted=True) is None
