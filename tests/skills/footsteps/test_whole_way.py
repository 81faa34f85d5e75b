"""Whole plans over the planar-region maps that the reference system's planner is tested on."""

import os
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from skills.footsteps import FootstepParameters, PlanOutcome, TerrainParameters, plan_whole_way, stand_on
from skills.footsteps.region_map import map_files, read_region_map

DATA = os.environ.get("LOOKSTEP_DATA")
MAPS = map_files(Path(DATA)) if DATA and (Path(DATA) / "planar_regions").is_dir() else []
FOOTSTEPS, TERRAIN = FootstepParameters(), TerrainParameters()


# Strips of 0.10 m by turns 0.10 and 0.21 m apart carry no sole; of the rubble most is too small or too steep for one.
NOT_CROSSED = ("20190219_182005_PartialGaps", "20190204_160000_CampLejeuneRock8")


@pytest.mark.skipif(not MAPS, reason="LOOKSTEP_DATA does not point to a folder that holds planar_regions/*.json")
@pytest.mark.parametrize("path", MAPS, ids=lambda path: path.stem)
def test_maps_of_the_reference_system_are_crossed(path: Path):
    region_map = read_region_map(path)
    stance = stand_on(region_map.regions, region_map.start_world, FOOTSTEPS, TERRAIN)
    plan = plan_whole_way(region_map.regions, stance, region_map.goal_world, FOOTSTEPS, TERRAIN)
    if region_map.name in NOT_CROSSED:
        assert plan.outcome is PlanOutcome.PARTIAL
        assert plan.reason and plan.expansions <= FOOTSTEPS.whole_way_expansions
        return
    assert plan.outcome is PlanOutcome.GOAL_REACHED, plan.reason
    sides = [step.side for step in plan.steps]
    assert all(a is b.opposite for a, b in pairwise(sides))
    feet = {step.side: step.T_world_sole for step in plan.steps[-2:]}
    middle = 0.5 * sum(T.p for T in feet.values())
    assert np.linalg.norm(middle - region_map.goal_world[:3]) < 0.2
