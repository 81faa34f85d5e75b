from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports]
import pytest

from skills.footsteps.footstep import Footstep, Side
from skills.geometry.pose import Pose
from skills.walking import SwingParameters
from skills.walking.swing_trajectory import SwingTrajectory

PARAMETERS = SwingParameters()
CLEARANCE = 0.01


def random_ways(seed: int, count: int) -> list[tuple[Pose, Pose, list[list[float]]]]:
    """Starts, footholds and waypoints: bare, one arch, walls at the start, at the end, at both, and a hump between."""
    rng = np.random.default_rng(seed)
    ways = []
    for i in range(count):
        rpy = rng.uniform(-0.3, 0.3, (2, 3))
        start = Pose.from_xyz_rpy(rng.uniform(-0.1, 0.1, 3), rpy[0])
        x, y, z = rng.uniform(0.1, 0.9), rng.uniform(-0.15, 0.15), rng.uniform(-0.26, 0.26)
        end = Pose.from_xyz_rpy(start.p + np.array((x, y, z)), rpy[1])
        top = max(start.p[2], end.p[2]) + rng.uniform(0.05, 0.15)
        above_start, above_end = [*start.p[:2], top], [*end.p[:2], top]
        middle = [*(0.5 * (start.p + end.p)[:2]), top + 0.05]
        shapes = ([], [middle], [above_start], [above_end], [above_start, above_end], [above_start, middle, above_end])
        ways.append((start, end, shapes[i % len(shapes)]))
    return ways


def height_of_way(way: np.ndarray, p: np.ndarray) -> float:
    """Greatest height of the polyline within the clearance of a place, by brute force."""
    dense = np.concatenate([a + np.linspace(0, 1, 200)[:, None] * (b - a) for a, b in pairwise(way)])
    along = way[-1, :2] - way[0, :2]
    gap = np.abs((dense[:, :2] - p[:2]) @ along) / np.linalg.norm(along)
    return float(dense[np.argmin(gap), 2] if gap.min() > CLEARANCE else dense[gap <= CLEARANCE, 2].min())


@pytest.mark.parametrize(("start", "end", "waypoints"), random_ways(1, 36))
def test_the_sole_stays_above_the_way(
    make_step: Callable[..., Footstep], start: Pose, end: Pose, waypoints: list[list[float]]
) -> None:
    swing = SwingTrajectory(start, make_step(0, Side.LEFT, end, (1.0, 0.5), waypoints), PARAMETERS)
    way = np.vstack((start.p, *waypoints, end.p))
    _, positions = swing.poses(np.linspace(0.0, 1.0, 200))
    for p in positions:
        assert p[2] > height_of_way(way, p) - CLEARANCE


@pytest.mark.parametrize(("start", "end", "waypoints"), random_ways(2, 12))
def test_it_starts_at_rest_and_lands_sinking_in_the_given_poses(
    make_step: Callable[..., Footstep], start: Pose, end: Pose, waypoints: list[list[float]]
) -> None:
    swing = SwingTrajectory(start, make_step(0, Side.LEFT, end, (1.0, 0.5), waypoints), PARAMETERS)
    times = np.array((0.0, 1e-4, 1.0 - 1e-4, 1.0))
    rotations, positions = swing.poses(times)
    for k, pose in ((0, start), (3, end)):
        np.testing.assert_allclose(positions[k], pose.p, atol=1e-9)
        np.testing.assert_allclose(rotations[k], pose.R, atol=1e-9)
    assert np.abs(positions[1] - positions[0]).max() < 1e-7
    sunk = np.array((positions[3] - positions[2]) / 1e-4)
    assert sunk[2] == pytest.approx(-PARAMETERS.touchdown_speed, rel=0.02)


def test_behind_its_end_it_sinks_on_until_the_ground_comes(make_step: Callable[..., Footstep]) -> None:
    end = Pose.from_xyz_rpy((0.4, 0.0, 0.1))
    swing = SwingTrajectory(Pose.identity(), make_step(0, Side.LEFT, end, (0.8, 0.3)), PARAMETERS)
    late = swing.motion(1.25, 1.0 / 0.8)
    np.testing.assert_allclose(late.pose.p, end.p - (0.0, 0.0, 0.2 * PARAMETERS.touchdown_speed), atol=1e-9)
    np.testing.assert_allclose(late.velocity, (0.0, 0.0, -PARAMETERS.touchdown_speed, 0.0, 0.0, 0.0), atol=1e-9)


@pytest.mark.parametrize(("start", "end", "waypoints"), random_ways(4, 12))
def test_velocity_and_acceleration_are_derivatives_of_the_pose(
    make_step: Callable[..., Footstep], start: Pose, end: Pose, waypoints: list[list[float]]
) -> None:
    swing, h = SwingTrajectory(start, make_step(0, Side.LEFT, end, (1.0, 0.5), waypoints), PARAMETERS), 1e-5
    for u in np.linspace(0.05, 0.95, 13):
        before, now, after = (swing.motion(u + d, 1.0) for d in (-h, 0.0, h))
        np.testing.assert_allclose(now.velocity[:3], (after.pose.p - before.pose.p) / (2 * h), atol=1e-5)
        turn = pin.log3(after.pose.R @ before.pose.R.T) / (2 * h)
        np.testing.assert_allclose(now.velocity[3:], turn, atol=1e-5)
        np.testing.assert_allclose(now.acceleration[:3], (after.velocity - before.velocity)[:3] / (2 * h), atol=1e-2)
        # The turning of the rotation vector's own frame is left out of the angular acceleration.
        angular = (after.velocity - before.velocity)[3:] / (2 * h)
        np.testing.assert_allclose(now.acceleration[3:], angular, atol=0.5 + 0.1 * np.abs(angular).max())


@pytest.mark.parametrize(("start", "end", "waypoints"), random_ways(3, 12))
def test_velocity_and_acceleration_are_continuous(
    make_step: Callable[..., Footstep], start: Pose, end: Pose, waypoints: list[list[float]]
) -> None:
    swing = SwingTrajectory(start, make_step(0, Side.LEFT, end, (1.0, 0.5), waypoints), PARAMETERS)
    jumps = []
    for h in (2e-3, 1e-3):
        _, positions = swing.poses(np.arange(0.0, 1.0, h))
        jumps.append(np.abs(np.diff(positions, n=3, axis=0)).max() / h**2)
    # Differences of the acceleration shrink with the step, unlike a jump.
    assert jumps[1] < 0.7 * jumps[0]


def test_it_meets_the_ground_along_the_normal(make_step: Callable[..., Footstep]) -> None:
    end = Pose.from_xyz_rpy((0.4, 0.0, 0.1), (0.0, -0.3, 0.0))
    swing = SwingTrajectory(Pose.identity(), make_step(0, Side.LEFT, end, (1.0, 0.5)), PARAMETERS)
    for t in np.linspace(0.9, 0.99, 10):
        offset = swing.pose(t).p - end.p
        np.testing.assert_allclose(offset / np.linalg.norm(offset), end.R[:, 2], atol=0.12)
        np.testing.assert_allclose(swing.pose(t).R, end.R, atol=1e-9 if t > 0.965 else 2e-3)


def test_without_waypoints_it_rises_to_the_apex(make_step: Callable[..., Footstep]) -> None:
    end = Pose.from_xyz_rpy((0.4, 0.0, 0.1))
    _, positions = SwingTrajectory(Pose.identity(), make_step(0, Side.LEFT, end), PARAMETERS).poses(
        np.linspace(0.0, 0.8, 100)
    )
    assert positions[:, 2].max() == pytest.approx(0.2, abs=1e-3)


def test_the_sole_is_level_at_mid_swing_and_turns_the_shorter_way(make_step: Callable[..., Footstep]) -> None:
    start = Pose.from_xyz_rpy((0.0, 0.0, 0.0), (0.2, 0.1, 3.0))
    end = Pose.from_xyz_rpy((-0.3, 0.0, 0.0), (-0.1, 0.2, -3.0))
    swing = SwingTrajectory(start, make_step(0, Side.LEFT, end, (1.0, 0.5)), PARAMETERS)
    np.testing.assert_allclose(swing.pose(0.5).R[2, 2], 1.0, atol=1e-9)
    assert all(abs(swing.pose(t).yaw) > 2.9 for t in np.linspace(0.0, 1.0, 50))


def test_many_poses_are_the_single_ones(make_step: Callable[..., Footstep]) -> None:
    end = Pose.from_xyz_rpy((0.4, 0.1, 0.1), (0.2, -0.1, 0.4))
    swing = SwingTrajectory(Pose.from_xyz_rpy((0, 0, 0), (0.0, 0.3, 0.0)), make_step(0, Side.LEFT, end), PARAMETERS)
    times = np.linspace(0.0, 0.79, 20)
    rotations, positions = swing.poses(times)
    np.testing.assert_allclose(rotations, [swing.pose(t).R for t in times], atol=1e-12)
    np.testing.assert_allclose(positions, [swing.pose(t).p for t in times], atol=1e-12)
