import numpy as np
import pytest
from open_loop import generated, random_field, rectangle, region_map, swing_start, walk

from skills.footsteps import FootstepParameters, SwingClearance, Terrain, TerrainParameters, region_terrain
from skills.footsteps import swing_clearance as find_way
from skills.footsteps.planned_steps import swing_duration
from skills.geometry.pose import Array, Pose

PARAMETERS = FootstepParameters()
EDGE = PARAMETERS.ground_above + 0.002


def smallest_clearance(terrain: Terrain, start: Pose, way: SwingClearance, end: Pose) -> tuple[float, float]:
    """Clearance of the sole by brute force over the whole way, and over its crossing: points 1 cm apart, poses 5 mm."""
    corners = np.stack((start.p, *way.waypoints_world, end.p))
    x = np.linspace(-0.5, 0.5, 27) * PARAMETERS.sole_length
    y = np.linspace(-0.5, 0.5, 15) * PARAMETERS.sole_width
    sole = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    whole = np.linalg.norm(end.p[:2] - start.p[:2])
    turn = (end.yaw - start.yaw + np.pi) % (2 * np.pi) - np.pi
    smallest = [np.inf, np.inf, np.inf]
    for leg in range(3):
        for f in np.linspace(0.0, 1.0, 2 + int(np.linalg.norm(corners[leg + 1] - corners[leg]) / 0.005)):
            centre = (1 - f) * corners[leg] + f * corners[leg + 1]
            yaw = start.yaw + turn * (np.linalg.norm(centre[:2] - start.p[:2]) / whole if whole > 0.01 else 1.0)
            near = start if leg == 0 else end
            steep = (1.0 - f, 0.0, f)[leg] * near.R[:2, 2] / -near.R[2, 2]
            offset = sole @ np.array(((np.cos(yaw), np.sin(yaw)), (-np.sin(yaw), np.cos(yaw))))
            ground = terrain.heights(centre[:2] + offset)
            clear = centre[2] + offset @ steep - ground
            if np.any(np.isfinite(clear)):
                smallest[leg] = min(smallest[leg], float(np.nanmin(clear)))
    return min(smallest), smallest[1]


@pytest.mark.parametrize("name", ["rough", "uneven_flat"])
def test_planned_swings_clear_the_ground_of_generated_courses(name: str):
    taken, _ = walk(*generated(name, 3))
    for one in taken:
        way = SwingClearance(one.step.swing_height, one.step.swing_waypoints_world)
        whole, crossing = smallest_clearance(one.terrain, swing_start(one), way, one.step.T_world_sole)
        assert whole >= -EDGE
        assert crossing >= PARAMETERS.swing_clearance - 0.005


@pytest.mark.parametrize("seed", range(3))
def test_planned_swings_clear_steep_random_fields(seed: int):
    taken, _ = walk(random_field(seed, tilted=0.7, spread=0.08), np.zeros(3), np.array((4.16, 0.0, 0.0)))
    assert taken
    for one in taken:
        way = SwingClearance(one.step.swing_height, one.step.swing_waypoints_world)
        whole, crossing = smallest_clearance(one.terrain, swing_start(one), way, one.step.T_world_sole)
        assert whole >= -EDGE
        assert crossing >= PARAMETERS.swing_clearance - 0.005


def wall_terrain(x: float, height: float) -> Terrain:
    """Level ground with a wall 8 cm thick across the way."""
    regions = region_map(rectangle((0.5, 0.0, 0.0), size=(3.0, 2.0)), rectangle((x, 0.0, height), size=(0.08, 2.0)))
    return region_terrain(regions, np.array((-1.0, -1.0)), np.array((2.0, 1.0)), TerrainParameters())


def sole_at(x: float) -> Pose:
    return Pose.from_xyz_rpy((x, 0.12, 0.0))


def test_level_ground_is_crossed_at_the_plain_swing_height():
    way = find_way(wall_terrain(1.9, 0.0), sole_at(0.0), sole_at(0.6), PARAMETERS)
    assert way.height == pytest.approx(PARAMETERS.swing_height)
    np.testing.assert_allclose(way.waypoints_world[:, 2], PARAMETERS.swing_height)
    np.testing.assert_allclose(way.waypoints_world[:, 0], (0.12, 0.48))


def test_foot_arrives_before_it_descends_behind_a_wall():
    way = find_way(wall_terrain(0.4, 0.06), sole_at(0.0), sole_at(0.6), PARAMETERS)
    np.testing.assert_allclose(way.waypoints_world[1, :2], (0.6, 0.12))
    assert way.waypoints_world[0, 0] > 0.05
    assert way.height == pytest.approx(0.06 + PARAMETERS.swing_clearance)


def test_foot_rises_before_it_moves_over_a_wall_in_front():
    way = find_way(wall_terrain(0.2, 0.12), sole_at(0.0), sole_at(0.6), PARAMETERS)
    np.testing.assert_allclose(way.waypoints_world[0, :2], (0.0, 0.12))
    assert way.height == pytest.approx(0.12 + PARAMETERS.swing_clearance)


def test_foot_may_be_lifted_and_put_down_where_it_stands():
    way = find_way(wall_terrain(1.9, 0.0), sole_at(0.0), sole_at(0.0), PARAMETERS)
    assert np.all(np.isfinite(way.waypoints_world))
    assert way.height == pytest.approx(PARAMETERS.swing_height)


def clearance_of_boxes(height: float, points: Array) -> Array:
    return height - points


@pytest.mark.parametrize("x", np.linspace(-0.1, 0.7, 9))
@pytest.mark.parametrize("height", [0.02, 0.05, 0.11, 0.2])
def test_walls_anywhere_on_the_way_are_cleared(x: float, height: float):
    terrain = wall_terrain(float(x), height)
    start, end = sole_at(0.0), sole_at(0.6)
    rest = min(
        smallest_clearance(terrain, foot, SwingClearance(0.0, np.tile(foot.p, (2, 1))), foot)[0]
        for foot in (start, end)
    )
    whole, _ = smallest_clearance(terrain, start, find_way(terrain, start, end, PARAMETERS), end)
    assert whole >= min(rest, -EDGE)


@pytest.mark.parametrize(("length", "rise"), [(0.7, 0.0), (1.3, 0.0), (0.7, 0.3)])
def test_long_and_high_steps_take_longer(length: float, rise: float):
    ground = region_map(rectangle((0.0, 0.0, 0.0), size=(0.4, 1.0)), rectangle((length, 0.0, rise), size=(0.4, 1.0)))
    terrain = region_terrain(ground, np.array((-1.0, -1.0)), np.array((2.0, 1.0)), TerrainParameters())
    start, end = Pose.from_xyz_rpy((0.0, 0.0, 0.0)), Pose.from_xyz_rpy((length, 0.0, rise))
    way = find_way(terrain, start, end, PARAMETERS)
    corners = np.stack((start.p, *way.waypoints_world, end.p))
    travelled = np.linalg.norm(np.diff(corners, axis=0), axis=1).sum()
    duration = swing_duration(start, end, way, PARAMETERS)
    if travelled <= PARAMETERS.swing_way:
        assert duration == PARAMETERS.swing_duration
    else:
        # No faster on average than over the way for which the time suffices.
        assert travelled / duration == pytest.approx(PARAMETERS.swing_way / PARAMETERS.swing_duration)
    assert (duration > PARAMETERS.swing_duration) == (length > 1.0 or rise > 0.0)
