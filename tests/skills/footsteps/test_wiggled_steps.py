import numpy as np
import pytest
from open_loop import Taken, random_field, rectangle, region_map, walk

from skills.footsteps import FootstepParameters, PlanOutcome, TerrainParameters, plan_whole_way, stand_on
from skills.geometry.pose import Array, Pose
from skills.regions import PlanarRegions

STILL = FootstepParameters(wiggle_move=0.0, wiggle_turn=0.0)
WIGGLED = FootstepParameters()


def margin(regions: PlanarRegions, T_world_sole: Pose, parameters: FootstepParameters) -> float:
    """Smallest distance of the sole's corners inside the region that they lie on."""
    x, y = 0.5 * parameters.sole_length, 0.5 * parameters.sole_width
    corners = T_world_sole @ np.array(((-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0)))
    best = -np.inf
    for region in regions.regions:
        local = region.T_world_region.inverse @ corners
        if np.max(np.abs(local[:, 2])) < 1e-6:
            half = np.abs(region.hull_region).max(axis=0)
            best = max(best, float(np.min(half - np.abs(local[:, :2]))))
    return best


def margins(taken: list[Taken], regions: PlanarRegions, parameters: FootstepParameters) -> Array:
    return np.array([margin(regions, one.step.T_world_sole, parameters) for one in taken])


@pytest.mark.parametrize("seed", range(2))
def test_footholds_keep_farther_from_edges(seed: int):
    regions, goal = random_field(seed), np.array((1.2 + 0.37 * 8, 0.0, 0.0))
    still, wiggled = (
        margins(walk(regions, np.zeros(3), goal, parameters)[0], regions, parameters) for parameters in (STILL, WIGGLED)
    )
    assert np.mean(wiggled >= WIGGLED.wiggle_margin - 1e-3) > np.mean(still >= WIGGLED.wiggle_margin - 1e-3)


def test_a_sole_is_turned_with_a_beam_that_the_lattice_does_not_follow():
    beams = [
        rectangle((0.45 * i, 0.13 * s, 0.0), (0.0, 0.0, 0.06), size=(0.34, 0.19)) for i in range(6) for s in (-1, 1)
    ]
    regions = region_map(*beams)
    plans = []
    for parameters in (STILL, WIGGLED):
        stance = stand_on(regions, np.array((0.0, 0.0, 0.0, 0.06)), parameters, TerrainParameters())
        goal = np.array((0.45 * 5, 0.0, 0.0, 0.0))
        plans.append(plan_whole_way(regions, stance, goal, parameters, TerrainParameters()))
    assert all(plan.outcome is PlanOutcome.GOAL_REACHED for plan in plans)
    worst = [min(margin(regions, step.T_world_sole, WIGGLED) for step in plan.steps) for plan in plans]
    assert worst[1] > worst[0]


def test_between_edges_a_sole_stands_in_the_middle():
    stones = [rectangle((0.4 * i, 0.12 * s, 0.0), size=(0.28, 0.16)) for i in range(4) for s in (-1, 1)]
    regions = region_map(*stones)
    stance = stand_on(regions, np.zeros(4), WIGGLED, TerrainParameters())
    plan = plan_whole_way(regions, stance, np.array((1.2, 0.0, 0.0, 0.0)), WIGGLED, TerrainParameters())
    assert plan.outcome is PlanOutcome.GOAL_REACHED
    assert all(abs(abs(step.T_world_sole.p[1]) - 0.12) < 0.005 for step in plan.steps)
