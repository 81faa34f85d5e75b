"""Floors above each other, walls, and goals that no ground leads to."""

import numpy as np
import pytest
from open_loop import rectangle, region_map
from plan_judge import PlanJudge

from skills.footsteps import (
    FootstepParameters,
    FootstepPlan,
    PlanOutcome,
    TerrainParameters,
    plan_whole_way,
    region_terrain,
    stand_on,
)
from skills.geometry.pose import Array, Pose
from skills.regions import PlanarRegion, PlanarRegions

FOOTSTEPS, TERRAIN = FootstepParameters(), TerrainParameters()
FLOOR = rectangle((0.0, 0.0, 0.0), size=(6.0, 4.0))


def way(regions: PlanarRegions, start: tuple[float, ...], goal: tuple[float, ...]) -> FootstepPlan:
    stance = stand_on(regions, np.array(start), FOOTSTEPS, TERRAIN)
    return plan_whole_way(regions, stance, np.array(goal), FOOTSTEPS, TERRAIN)


def wall(x: float, y: float, length: float, low: float = 0.0, high: float = 2.0) -> PlanarRegion:
    """A vertical rectangle along y."""
    return rectangle((x, y, 0.5 * (low + high)), (0.0, np.pi / 2, 0.0), size=(high - low, length))


def places(plan: FootstepPlan) -> Array:
    return np.array([step.T_world_sole.p for step in plan.steps])


def test_both_floors_under_a_bridge_are_ground():
    bridge = rectangle((0.0, 0.0, 2.0), size=(1.0, 1.0))
    for order in ((FLOOR, bridge), (bridge, FLOOR)):
        terrain = region_terrain(region_map(*order), np.full(2, -1.0), np.full(2, 1.0), TERRAIN)
        assert terrain.raster.cells.shape[0] == 2
        np.testing.assert_allclose(terrain.heights(np.array(((0, 0, 0.1), (0, 0, 1.9), (0.8, 0, 1.9)))), (0, 2, 0))
        assert terrain.heights(np.zeros((1, 2)))[0] == pytest.approx(2.0)
        for z in (0.0, 2.0):
            found = terrain.snap(0.2, 0.0, 0.0, FOOTSTEPS, z)
            assert found.usable and found.T_world_sole is not None
            assert found.T_world_sole.p[2] == pytest.approx(z)


def test_a_way_leads_under_a_bridge():
    regions = region_map(FLOOR, rectangle((0.0, 0.0, 2.0), size=(1.0, 4.0)))
    plan = way(regions, (-1.5, 0.0, 0.0, 0.0), (1.5, 0.0, 0.0, 0.0))
    assert plan.outcome is PlanOutcome.GOAL_REACHED
    assert np.all(places(plan)[:, 2] < 0.1)


def spiral() -> list[PlanarRegion]:
    """One and a half turns of stairs around a post, 1.9 m a turn."""
    steps = []
    for k in range(18):
        angle = 2 * np.pi * k / 12
        centre = (1.3 * np.sin(angle), -1.3 * np.cos(angle), 0.16 * (k + 1))
        steps.append(rectangle(centre, (0.0, 0.0, angle), size=(0.85, 0.9)))
    return steps


def test_stairs_that_wind_over_themselves_are_climbed():
    regions = region_map(rectangle((0.0, 0.0, 0.0), size=(8.0, 8.0)), *spiral())
    top = spiral()[-1].T_world_region
    plan = way(regions, (-1.6, -1.3, 0.0, 0.0), (*top.p, top.yaw))
    assert plan.outcome is PlanOutcome.GOAL_REACHED, plan.reason
    assert places(plan)[-1, 2] == pytest.approx(top.p[2])
    assert np.max(np.abs(np.diff(places(plan)[:, 2]))) <= FOOTSTEPS.max_step_height


def test_the_goal_is_on_the_floor_that_its_height_tells():
    regions = region_map(FLOOR, rectangle((1.5, 0.0, 2.0), size=(1.0, 1.0)))
    assert way(regions, (-1.0, 0.0, 0.0, 0.0), (1.5, 0.0, 0.0, 0.0)).outcome is PlanOutcome.GOAL_REACHED
    above = way(regions, (-1.0, 0.0, 0.0, 0.0), (1.5, 0.0, 2.0, 0.0))
    assert above.outcome is PlanOutcome.PARTIAL
    assert "does not lead to the goal" in above.reason


def test_the_way_goes_around_a_wall_and_keeps_the_body_from_it():
    plan = way(region_map(FLOOR, wall(0.0, -0.5, 3.0)), (-1.0, -0.5, 0.0, 0.0), (1.0, -0.5, 0.0, 0.0))
    assert plan.outcome is PlanOutcome.GOAL_REACHED, plan.reason
    crossing = places(plan)[np.abs(places(plan)[:, 0]) < 0.2]
    assert np.all(crossing[:, 1] > 0.9)


def test_a_wall_on_all_sides_ends_with_a_reason():
    cell = [wall(-2.0, 0.0, 3.0), wall(0.0, 0.0, 3.0)]
    for y in (-1.5, 1.5):
        cell.append(rectangle((-1.0, y, 1.0), (np.pi / 2, 0.0, 0.0), size=(2.0, 2.0)))
    plan = way(region_map(FLOOR, *cell), (-1.0, 0.0, 0.0, 0.0), (1.5, 0.0, 0.0, 0.0))
    assert plan.outcome in (PlanOutcome.PARTIAL, PlanOutcome.BLOCKED)
    assert "does not lead to the goal" in plan.reason
    assert plan.expansions < FOOTSTEPS.whole_way_expansions


def test_low_walls_are_stepped_over_and_high_ones_not():
    for high, crossed in ((0.15, True), (0.4, False)):
        row = wall(0.0, 0.0, 4.5, 0.0, high)
        plan = way(region_map(FLOOR, row), (-0.8, 0.0, 0.0, 0.0), (0.8, 0.0, 0.0, 0.0))
        assert (plan.outcome is PlanOutcome.GOAL_REACHED) is crossed
        if crossed:
            over = max(step.swing_waypoints_world[:, 2].max() for step in plan.steps)
            assert over >= high + FOOTSTEPS.swing_clearance - 1e-6
            assert not np.any(np.abs(places(plan)[:, 0]) < 0.5 * FOOTSTEPS.sole_width)
        else:
            assert "wall under the swing" in dict(plan.rejections)


@pytest.mark.parametrize("width", [0.5, 0.3])
def test_a_door_is_passed_where_the_body_fits(width: float):
    sides = [wall(0.0, s * (0.5 * width + 1.1), 2.2) for s in (-1, 1)]
    plan = way(region_map(FLOOR, *sides), (-1.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))
    assert (plan.outcome is PlanOutcome.GOAL_REACHED) is (width > FOOTSTEPS.body_width)


def test_gaps_are_crossed_and_the_plan_keeps_every_limit():
    stones = [rectangle((0.6 * i, 0.0, 0.0), size=(0.42, 1.0)) for i in range(7)]
    plan = way(region_map(*stones), (0.0, 0.0, 0.0, 0.0), (3.6, 0.0, 0.0, 0.0))
    assert plan.outcome is PlanOutcome.GOAL_REACHED, plan.reason
    stance = stand_on(region_map(*stones), np.zeros(4), FOOTSTEPS, TERRAIN)
    assert PlanJudge(region_map(*stones), FOOTSTEPS).violations(plan, stance, None) == []


def test_a_void_too_wide_ends_at_its_edge():
    regions = region_map(FLOOR, rectangle((5.0, 0.0, 0.0), size=(2.0, 4.0)))
    plan = way(regions, (1.0, 0.0, 0.0, 0.0), (5.0, 0.0, 0.0, 0.0))
    assert plan.outcome is PlanOutcome.PARTIAL
    assert 2.5 < places(plan)[-1, 0] <= 3.0 - 0.13


@pytest.mark.parametrize(
    "regions",
    [
        (),
        (PlanarRegion(Pose(np.eye(3), np.full(3, np.nan)), FLOOR.hull_region, (), 1.0, 0.0),),
        (PlanarRegion(Pose.identity(), np.zeros((0, 2)), (), 0.0, 0.0),),
        (PlanarRegion(Pose.identity(), np.array(((0.0, 0.0), (1.0, 0.0))), (), 0.0, 0.0),),
        (PlanarRegion(Pose.identity(), np.full((4, 2), np.nan), (), 0.0, 0.0),),
        (wall(0.3, 0.0, 1.0),),
        (wall(0.3, 0.0, 0.0), wall(0.3, 0.0, 1.0, 1.0, 1.0)),
    ],
    ids=["none", "nan", "empty", "line", "nan_outline", "wall", "thin_walls"],
)
def test_ground_that_is_none_is_blocked_with_a_reason(regions: tuple[PlanarRegion, ...]):
    plan = way(region_map(*regions), (0.0, 0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0))
    assert plan.outcome is PlanOutcome.BLOCKED
    assert plan.reason and not plan.steps
