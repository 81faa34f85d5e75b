"""Every rejection has a name, in the search as for a single sole; every bad request an outcome, in bounded effort."""

import dataclasses
from typing import Any

import numpy as np
import pytest
from open_loop import rectangle, region_map, standing

from skills.body_path import SubGoalParameters, straight_path, sub_goal
from skills.footsteps import (
    Foothold,
    FootstepParameters,
    FootstepPlan,
    PlanOutcome,
    Side,
    Stance,
    TerrainParameters,
    plan_footsteps,
    plan_whole_way,
    region_terrain,
    stand_on,
    terrain_ahead,
)
from skills.footsteps.rejections import in_percent, sizes_in_percent
from skills.geometry.pose import Pose
from skills.regions.planar_region import PlanarRegion, PlanarRegions

PARAMETERS, TERRAIN = FootstepParameters(), TerrainParameters()
FLOOR = rectangle((1.0, 0.0, 0.0), size=(6.0, 3.0))


def planned(*regions: PlanarRegion, stance: Stance | None = None, **options: Any) -> FootstepPlan:
    stance = stance or standing()
    extra = {key: options.pop(key) for key in ("max_expansions", "out_of_time") if key in options}
    parameters = dataclasses.replace(PARAMETERS, heuristic_weight=1.0, **options)
    goal = sub_goal(straight_path(np.zeros(3), np.array((4.0, 0.0, 0.0))), stance, SubGoalParameters())
    terrain = terrain_ahead(region_map(*regions), stance, goal, parameters, TERRAIN)
    return plan_footsteps(terrain, stance, Side.LEFT, goal, parameters, **extra)


def sole(*regions: PlanarRegion, **options: float) -> Foothold:
    terrain = region_terrain(region_map(*regions), np.full(2, -1.0), np.full(2, 1.0), TERRAIN)
    return terrain.snap(0.0, 0.0, 0.0, dataclasses.replace(PARAMETERS, **options))


def step(z: float, x: float = 1.4) -> PlanarRegion:
    return rectangle((x, 0.0, z), size=(2.0, 3.0))


def test_sizes_of_steps_are_counted_by_name():
    reasons = dict(planned(FLOOR).rejections)
    assert {"too far", "too far back", "too narrow", "too wide", "turned too much", "soles too near"} <= set(reasons)


@pytest.mark.parametrize(
    ("reason", "regions", "options"),
    [
        ("step too high", [FLOOR, step(0.3)], {}),
        ("step too low", [rectangle((-0.5, 0.0, 0.0), size=(2.0, 3.0)), step(-0.3, 1.6)], {}),
        ("too far for a step up", [FLOOR, step(0.2)], {}),
        ("too far for a step down", [rectangle((-0.5, 0.0, 0.0), size=(2.0, 3.0)), step(-0.2, 1.6)], {}),
        ("swing too long", [FLOOR], {"swing_reach": 0.4}),
        ("swing too high", [FLOOR, step(0.2)], {"swing_height_change": 0.15}),
        ("step in place", [FLOOR], {}),
        ("body at an obstacle", [FLOOR, rectangle((1.0, 0.5, 0.8), size=(0.4, 0.4))], {}),
        ("wall under the swing", [FLOOR, rectangle((0.4, 0.0, 0.2), (0.0, np.pi / 2, 0.0), size=(0.4, 3.0))], {}),
        ("obstacle across the body's way", [FLOOR, rectangle((0.3, 0.0, 0.8), (0.0, np.pi / 2, 0.0), size=(0.6, 3.0))],
         {"body_depth": 0.0, "body_width": 0.0}),
        ("outside the searched ground", [FLOOR], {"window_margin": 0.3}),
    ],
)  # fmt: skip
def test_a_step_is_rejected_by_name(reason: str, regions: list[PlanarRegion], options: dict[str, Any]):
    counts = dict(planned(*regions, **options).rejections)
    assert counts.get(reason, 0) > 0, counts


def test_a_drop_off_a_foot_that_stands_uphill_is_rejected_by_name():
    ramp = rectangle((0.0, 0.0, 0.0), (0.0, -0.2, 0.0), size=(0.7, 3.0))
    lower = rectangle((1.4, 0.0, -0.16), size=(2.0, 3.0))
    stance = Stance(*(Pose.from_xyz_rpy((0.1, 0.12 * s, 0.1 * np.tan(0.2)), (0.0, -0.2, 0.0)) for s in (1, -1)))
    counts = dict(planned(ramp, lower, stance=stance).rejections)
    assert counts.get("step down off a foot that stands uphill", 0) > 0, counts
    assert "step down off a foot that stands uphill" not in dict(
        planned(ramp, lower, stance=stance, uphill_drop=0.26).rejections
    )


def test_ground_at_the_shin_is_refused():
    for gap, height, usable in ((0.06, 0.35, False), (0.06, 0.25, True), (0.10, 0.35, True)):
        block = rectangle((0.13 + gap + 0.1, 0.0, height), size=(0.2, 0.5))
        found = sole(FLOOR, block)
        assert found.usable is usable, (gap, height, found.reason)
        assert usable or found.reason == "ground at the shin"


def test_a_drop_beside_the_sole_is_refused_where_that_is_asked_for():
    ledge, floor = rectangle((0.0, 0.0, 0.3), size=(0.32, 0.5)), rectangle((0.0, 0.0, 0.0), size=(2.0, 2.0))
    assert sole(ledge, floor).usable
    assert sole(ledge, floor, drop_distance=0.05).reason == "drop beside the sole"
    assert sole(ledge, floor, drop_distance=0.02).usable
    assert sole(ledge, floor, drop_distance=0.05, drop_depth=0.4).usable
    assert sole(ledge, drop_distance=0.05).reason == "drop beside the sole"


def test_shares_of_reasons_add_up_to_a_hundred_percent():
    plan = planned(FLOOR, step(0.3))
    for shares in (in_percent(plan.rejections), sizes_in_percent(plan.rejections)):
        assert sum(share for _, share in shares) == pytest.approx(100.0)
    assert {reason for reason, _ in in_percent(plan.rejections)}.isdisjoint(dict(sizes_in_percent(plan.rejections)))


def nan_region() -> PlanarRegion:
    outline = np.array(((0.0, 0.0), (1.0, 0.0), (np.nan, 1.0)))
    return PlanarRegion(Pose(np.eye(3), np.array((0.3, np.nan, 0.0))), outline, (outline,), 0.5, 0.0)


BAD_GROUND = {
    "no regions": (),
    "points and lines": (
        PlanarRegion(Pose.identity(), np.zeros((0, 2)), (), 0.0, 0.0),
        PlanarRegion(Pose.identity(), np.zeros((3, 2)), (), 0.0, 0.0),
        PlanarRegion(Pose.identity(), np.array(((0.0, 0.0), (1.0, 0.0))), (), 0.0, 0.0),
    ),
    "not a number": (nan_region(),),
    "walls alone": tuple(rectangle((x, 0.0, 0.5), (0.0, np.pi / 2, 0.0), size=(1.0, 2.0)) for x in (0.3, 0.6)),
}


@pytest.mark.parametrize("kind", BAD_GROUND)
def test_ground_that_carries_nobody_is_blocked_with_a_reason(kind: str):
    plan = planned(*BAD_GROUND[kind])
    assert plan.outcome is PlanOutcome.BLOCKED and plan.steps == ()
    assert plan.reason.startswith("no way on: ") and plan.rejections
    goal = np.array((2.0, 0.0, 0.0, 0.0))
    whole = plan_whole_way(region_map(*BAD_GROUND[kind]), standing(), goal, PARAMETERS, TERRAIN)
    assert whole.outcome is PlanOutcome.BLOCKED and whole.steps == () and whole.reason


def test_bad_regions_among_good_ones_do_no_harm():
    bad = [region for regions in BAD_GROUND.values() for region in regions if abs(region.normal_world[2]) > 0.5]
    overlapping = (FLOOR, rectangle((1.0, 0.0, 0.002), size=(5.0, 2.5)), FLOOR)
    clean, plan = planned(*overlapping), planned(*overlapping, *bad)
    assert plan.outcome is PlanOutcome.ENOUGH_STEPS
    assert [s.T_world_sole.p.tolist() for s in plan.steps] == [s.T_world_sole.p.tolist() for s in clean.steps]


def test_a_goal_that_is_not_reachable_is_partial_with_reasons_and_within_the_budget():
    islands = region_map(rectangle((0.0, 0.0, 0.0), size=(2.0, 2.0)), rectangle((4.0, 0.0, 0.0), size=(2.0, 2.0)))
    stance = stand_on(islands, np.zeros(4), PARAMETERS, TERRAIN)
    plan = plan_whole_way(islands, stance, np.array((4.0, 0.0, 0.0, 0.0)), PARAMETERS, TERRAIN)
    assert plan.outcome is PlanOutcome.PARTIAL
    assert plan.reason.startswith("the ground does not lead to the goal")
    assert plan.steps and plan.rejections
    assert plan.expansions <= 2 * PARAMETERS.whole_way_expansions


def test_a_search_whose_time_is_over_ends_with_the_best_it_has():
    asked = []

    def out_of_time() -> bool:
        asked.append(None)
        return len(asked) == 2

    hard = [FLOOR, *(rectangle((0.9 + 0.1 * i, 0.0, 0.3), size=(0.05, 3.0)) for i in range(4))]
    whole, cut = planned(*hard, max_expansions=800), planned(*hard, max_expansions=800, out_of_time=out_of_time)
    assert whole.expansions > 300, "otherwise the scene is too easy for this test"
    assert len(asked) == 2 and cut.expansions == 200
    assert cut.outcome is PlanOutcome.PARTIAL and cut.steps
    assert "not found in time, after 200 expansions" in cut.reason


def test_a_search_that_is_interrupted_finds_what_one_in_one_go_does():
    whole = planned(FLOOR, step(0.2))
    sliced = planned(FLOOR, step(0.2), out_of_time=lambda: False)
    assert (whole.cost, whole.expansions, whole.rejections) == (sliced.cost, sliced.expansions, sliced.rejections)


def test_nan_in_a_request_is_refused_where_it_enters():
    with pytest.raises(ValueError, match="goal"):
        plan_whole_way(PlanarRegions((FLOOR,), 0.0, 0), standing(), np.array((np.nan, 0, 0, 0)), PARAMETERS, TERRAIN)
