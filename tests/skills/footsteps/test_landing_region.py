"""Places to land instead lie wholly on the region of the planned foothold."""

import numpy as np
import pytest
from open_loop import random_field, rectangle, region_map

from skills.footsteps import FootstepParameters, TerrainParameters, plan_whole_way, stand_on
from skills.geometry.polygon import contains_point
from skills.geometry.pose import Array
from skills.regions import PlanarRegions

PARAMETERS = FootstepParameters()
SOLE = np.array(((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))) * (
    PARAMETERS.sole_length,
    PARAMETERS.sole_width,
)


def steps_over(regions: PlanarRegions, length: float):
    stance = stand_on(regions, np.zeros(4), PARAMETERS, TerrainParameters())
    return plan_whole_way(regions, stance, np.array((length, 0.0, 0.0, 0.0)), PARAMETERS, TerrainParameters()).steps


def on_one_region(regions: PlanarRegions, corners: Array) -> bool:
    for region in regions.regions:
        local = region.T_world_region.inverse @ corners
        if np.max(np.abs(local[:, 2])) < 1e-6 and all(contains_point(region.hull_region, *p[:2]) for p in local):
            return True
    return False


@pytest.mark.parametrize("seed", range(2))
def test_a_sole_at_any_corner_of_it_lies_on_one_region(seed: int):
    regions = random_field(seed)
    steps = steps_over(regions, 2.0)
    assert sum(len(step.landing_region_sole) > 0 for step in steps) >= len(steps) // 2
    for step in steps:
        for place in step.landing_region_sole:
            corners = step.T_world_sole @ np.column_stack((place + SOLE, np.zeros(4)))
            assert on_one_region(regions, corners)


def test_on_open_ground_it_reaches_as_far_as_allowed():
    for step in steps_over(region_map(rectangle((0.5, 0.0, 0.0), size=(4.0, 3.0))), 1.0):
        np.testing.assert_allclose(np.abs(step.landing_region_sole), PARAMETERS.landing_move)


def test_a_foothold_over_two_stones_must_be_met_as_planned():
    stones = [rectangle((0.13 * i, 0.0, 0.0), size=(0.13, 0.6)) for i in range(-3, 12)]
    assert all(len(step.landing_region_sole) == 0 for step in steps_over(region_map(*stones), 0.8))
