"""The height map over time: filtering, following the robot, its own body, what moves and what is hidden."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from box_scene import SMALL, Box, block, directions_lidar, scan_of

from skills.geometry import Capsule, LidarScan, Pose
from skills.height_map import HeightMap, HeightMapParameters, HeightMapper

COARSE = HeightMapParameters(size=6.0, resolution=0.1)
FEET = np.zeros(3)
STILL = Pose.from_xyz_rpy((0.0, 0.0, 1.7))


def nothing(time: float = 0.1) -> LidarScan:
    """A scan in which nothing came back."""
    return LidarScan(np.zeros((SMALL.rings, SMALL.columns), np.float32), SMALL, STILL, time, 1)


def after(mapper: HeightMapper, scans: list[LidarScan]) -> HeightMap:
    """The map after some scans, the robot standing."""
    return [mapper.update(scan, FEET) for scan in scans][-1]


def heights_by_hand(scans: list[LidarScan], p: HeightMapParameters) -> tuple[np.ndarray, np.ndarray]:
    """Heights and variances as the parameters' meanings say, one return and one cell after another; nothing fades."""
    n, half = round(p.size / p.resolution), 0.5 * p.size
    heights, variances, seen = np.full((n, n), np.nan), np.full((n, n), np.nan), np.zeros((n, n))
    for scan in scans:
        origin = scan.T_world_lidar.p
        points = origin + scan.ranges[..., None].astype(float) * (directions_lidar(scan.lidar) @ scan.T_world_lidar.R.T)
        cells: dict[tuple[int, int], list[float]] = {}
        for x, y, z in points[scan.ranges > 0]:
            if abs(x) < half and abs(y) < half and z <= p.ceiling:
                cells.setdefault((int((y + half) / p.resolution), int((x + half) / p.resolution)), []).append(z)
        for (i, j), zs in cells.items():
            top = [z for z in zs if z >= max(zs) - p.surface]
            z = np.mean(top)
            to_cell = np.array(((j + 0.5) * p.resolution - half, (i + 0.5) * p.resolution - half, z)) - origin
            distance, level = np.linalg.norm(to_cell), np.hypot(*to_cell[:2])
            range_sd = p.range_sd + p.range_sd_per_metre * distance
            upright, flat = to_cell[2] / distance, level / distance
            along = (range_sd * flat) ** 2 + p.resolution**2 / 12
            noise = ((range_sd * upright) ** 2 + p.slope_sd**2 * along) / len(top) + (p.angle_sd * level) ** 2
            predicted = variances[i, j] + p.growth * (scan.time - seen[i, j])
            away = (z - heights[i, j]) / np.sqrt(predicted + noise)
            if away < -p.gate:
                continue
            seen[i, j] = scan.time
            if np.isnan(away) or away > p.gate:
                heights[i, j], variances[i, j] = z, noise
            else:
                weight = predicted / (predicted + noise)
                heights[i, j] += weight * (z - heights[i, j])
                variances[i, j] = 1.0 / (1.0 / predicted + 1.0 / noise)
    return heights, variances + p.growth * (scans[-1].time - seen)


@pytest.mark.parametrize("seed", range(3))
def test_heights_are_those_of_one_kalman_filter_a_cell(seed):
    rng = np.random.default_rng(seed)
    p = replace(COARSE, votes=100, check_every=1, see_through=1.0, spike=1.0, fill_reach=0)
    boxes = [block(x, y, top, 0.5) for x, y, top in rng.uniform((-2.5, -2.5, 0.05), (2.5, 2.5, 0.5), (6, 3))]
    scans = []
    for k in range(4):
        x, y = rng.uniform(-0.3, 0.3, 2)
        T = Pose.from_xyz_rpy((x, y, 1.6), rng.uniform(-0.2, 0.2, 3))
        scans.append(scan_of(boxes, time=0.1 * k, T_world_lidar=T, noise=0.03, seed=k))
    found = after(HeightMapper(p), scans)
    heights, variances = heights_by_hand(scans, p)
    known = np.pad(~np.isnan(heights), 1)
    around = np.stack([np.roll(known, (i, j), (0, 1)) for i in (-1, 0, 1) for j in (-1, 0, 1)])
    heights[around.sum(axis=0)[1:-1, 1:-1] < 3] = np.nan  # What stands alone is dropped.
    variances[np.isnan(heights)] = np.nan
    np.testing.assert_allclose(found.heights, heights, atol=2e-5)
    np.testing.assert_allclose(found.variances, variances, rtol=1e-3)


def test_a_map_that_has_moved_holds_the_same_where_it_was_before():
    scan = scan_of([block(1.0, 0.5, 0.3), block(-1.0, -1.0, 0.2)])
    mapper = HeightMapper(COARSE)
    before = mapper.update(scan, FEET)
    mapper.update(nothing(), (0.7, -0.4, 0.0))
    mapper.update(nothing(), (1.3, 0.2, 0.0))
    moved = mapper.update(nothing(), (-1.1, 0.9, 0.0))
    assert np.allclose(moved.origin_world - before.origin_world, (-1.1, 0.9))
    points = (np.stack(np.meshgrid(np.arange(60), np.arange(60)), axis=-1) + 0.5) * 0.1 + moved.origin_world
    # What was inside all the time: x from -1.7 to 1.9, y from -2.1 to 2.6, less a cell where cleaning looks outside.
    kept = ((points > (-1.5, -1.9)) & (points < (1.7, 2.4))).all(axis=-1)
    assert kept.sum() > 1000
    np.testing.assert_array_equal(moved.nearest(points)[kept], before.nearest(points)[kept])
    gone = points[(points[..., 0] < -3.1) & ~np.isnan(moved.heights)]
    assert len(gone) == 0, "nothing is known of cells that have just entered"


@pytest.mark.parametrize("shift", [(6.0, 0.0), (0.0, -6.0), (25.0, 13.0), (5.9, 5.9), (-600.3, 1.0)])
def test_a_jump_beyond_the_map_leaves_nothing_behind(shift):
    mapper = HeightMapper(COARSE)
    first = mapper.update(scan_of([]), FEET)
    assert np.isfinite(first.heights).mean() > 0.5
    jumped = mapper.update(nothing(), (*shift, 0.0))
    assert np.isnan(jumped.heights).all()
    assert jumped.inside(shift).all()


@pytest.mark.parametrize("goal", [None, (1.0, -0.5), (4.0, 0.0), (90.0, -70.0)])
def test_the_map_lies_between_robot_and_goal_and_the_robot_well_inside(goal):
    p = HeightMapParameters()
    found = HeightMapper(p).update(scan_of([]), (3.0, 2.0, 0.1), None if goal is None else np.add(goal, (3.0, 2.0)))
    middle = found.origin_world + 0.5 * p.size - (3.0, 2.0)
    expected = np.clip(np.multiply(goal or (0.0, 0.0), 0.5), -3.0, 3.0)
    assert np.abs(middle - expected).max() <= 0.5 * p.resolution + 1e-9


def test_the_robots_own_body_is_no_obstacle():
    legs = [Box((0.05, y, 0.0), (0.25, y + 0.15, 0.8)) for y in (-0.2, 0.05)]
    lidar_pose = Pose.from_xyz_rpy((-0.4, 0.0, 1.7))
    feet = [np.array((0.15, y, 0.0)) for y in (-0.125, 0.125)]
    capsules = tuple(Capsule(foot, foot + np.array((0.0, 0.0, 0.75)), 0.1) for foot in feet)
    blind = HeightMapper(COARSE).update(scan_of(legs, T_world_lidar=lidar_pose), FEET)
    aware = HeightMapper(COARSE).update(scan_of(legs, T_world_lidar=lidar_pose, body=capsules), FEET)
    assert np.nanmax(blind.heights) > 0.7
    assert np.nanmax(aware.heights) < 0.01
    assert aware.account.own_body > 100
    assert aware.account.returns == blind.account.returns


def test_what_hangs_high_above_the_feet_is_left_out():
    mapper = HeightMapper(COARSE)
    beam = Box((1.0, -2.0, 2.2), (1.3, 2.0, 2.5))
    found = mapper.update(scan_of([beam], lidar=SMALL), FEET)
    assert found.account.above > 0
    assert np.nanmax(found.heights) < 0.01


def moving_box(time: float) -> Box:
    """As high and wide as a person, walking across 2 m ahead of the robot at 1 m/s."""
    y = -2.5 + time
    return Box((1.8, y - 0.2, 0.0), (2.2, y + 0.2, 1.8))


@pytest.mark.parametrize("parameters", [COARSE, HeightMapParameters(size=6.0)])
def test_what_has_walked_by_is_gone_a_second_later_and_blocks_stay(parameters):
    wall = Box((2.6, -1.0, 0.0), (2.9, 1.0, 0.4))
    low = block(1.2, 0.0, 0.15)
    mapper = HeightMapper(parameters)
    maps = {}
    for k in range(51):
        boxes = [wall, low, moving_box(0.1 * k)] if k < 40 else [wall, low]
        maps[k] = mapper.update(scan_of(boxes, time=0.1 * k, noise=0.015, seed=k), FEET)
    for k in range(25, 40, 5):
        y = -2.5 + 0.1 * k
        there = maps[k].nearest(np.stack(np.meshgrid((1.85,), y + np.array((-0.1, 0.0, 0.1))), axis=-1))
        assert np.nanmax(there) > 1.0, "it is in the map while it walks"
        trail = maps[k].nearest(np.stack(np.meshgrid((1.85, 2.0, 2.15), np.arange(-2.5, y - 1.2, 0.1)), axis=-1))
        assert np.nanmax(trail) < 0.1, "it leaves no trail"
        for height, x in ((0.4, 2.7), (0.15, 1.2)):
            assert maps[k].nearest((x, 0.0)) == pytest.approx(height, abs=0.03), "what it hides stays"
    way = np.stack(np.meshgrid((1.85, 2.0, 2.15), np.arange(-2.5, 2.5, 0.1)), axis=-1)
    assert np.nanmax(maps[50].nearest(way)) < 0.1


def test_a_block_that_was_taken_away_fades_although_nothing_lies_behind_it():
    boxes = [[block(1.5, 0.0, 0.3)]] * 10 + [[]] * 10
    scans = [scan_of(there, time=0.1 * k, noise=0.01, seed=k) for k, there in enumerate(boxes)]
    found = after(HeightMapper(COARSE), scans)
    assert np.abs(found.nearest(np.array([(1.45, 0.05), (1.55, -0.05), (1.35, 0.15)]))).max() < 0.03


def test_a_scan_in_which_nothing_came_back_changes_nothing():
    mapper = HeightMapper(COARSE)
    before = mapper.update(scan_of([block(1.0, 0.0, 0.2)]), FEET)
    later = after(mapper, [nothing()] * 20)
    np.testing.assert_array_equal(later.heights, before.heights)
    assert later.account.returns == 0


def test_an_empty_scan_makes_an_empty_map():
    empty = HeightMapper(COARSE).update(nothing(), FEET)
    assert np.isnan(empty.heights).all() and np.isnan(empty.variances).all() and not empty.filled.any()
    assert np.isnan(empty.ground_height)
    assert empty.points_world.shape == (0, 3)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, -3.0, 1e30])
def test_ranges_that_are_no_ranges_do_not_count(value):
    scan = scan_of([block(1.0, 0.0, 0.2)])
    broken = scan.ranges.copy()
    broken[::3] = value
    clean = scan.ranges.copy()
    clean[::3] = 0.0
    first, second = (
        HeightMapper(COARSE).update(LidarScan(ranges, SMALL, STILL, 0.0, 0), FEET) for ranges in (broken, clean)
    )
    np.testing.assert_array_equal(first.heights, second.heights)


def test_the_same_scans_make_the_same_map_to_the_last_bit():
    scans = [scan_of([block(1.0, 0.0, 0.2)], time=0.1 * k, noise=0.03, seed=k) for k in range(5)]
    first, second = after(HeightMapper(), scans), after(HeightMapper(), scans)
    for name in ("heights", "variances", "filled"):
        assert getattr(first, name).tobytes() == getattr(second, name).tobytes()


def test_a_delivered_map_does_not_change_when_the_next_scan_comes():
    mapper = HeightMapper(COARSE)
    first = mapper.update(scan_of([]), FEET)
    heights = first.heights.copy()
    mapper.update(scan_of([block(1.0, 0.0, 0.3)], time=0.1), (1.0, 0.0, 0.0))
    np.testing.assert_array_equal(first.heights, heights)
    assert not first.heights.flags.writeable


def test_the_ground_is_the_low_part_of_the_map_but_not_its_lowest():
    pit = Box((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    blocks = [block(x, y, 0.3) for x in np.arange(0.6, 2.6, 0.5) for y in np.arange(-2.0, 2.0, 0.5)]
    found = HeightMapper(COARSE).update(scan_of([*blocks, pit], noise=0.005), FEET)
    assert abs(found.ground_height) < 0.01


def test_noise_of_the_lidar_averages_out_and_the_highest_returns_do_not_lift_the_map():
    scans = [scan_of([block(1.5, 0.0, 0.3, 0.8)], time=0.1 * k, noise=0.02, seed=k) for k in range(20)]
    found = after(HeightMapper(), scans)
    for (x, y), height in (((1.5, 0.0), 0.3), ((1.5, 1.2), 0.0)):
        points = np.stack(np.meshgrid(np.linspace(x - 0.3, x + 0.3, 13), np.linspace(y - 0.3, y + 0.3, 13)), axis=-1)
        errors = found.nearest(points) - height
        assert abs(np.median(errors)) < 0.003
        assert np.percentile(np.abs(errors), 90) < 0.02, "better than one return, although few beams hit a cell"
