"""Whole plans over the planar-region maps that the reference system's planner is tested on."""

import os
from pathlib import Path

import pytest

from skills.footsteps import FootstepParameters, PlanOutcome, TerrainParameters, plan_whole_way, stand_on
from skills.footsteps.region_map import map_files, read_region_map

DATA = os.environ.get("LOOKSTEP_DATA")
MAPS = map_files(Path(DATA)) if DATA and (Path(DATA) / "planar_regions").is_dir() else []
FOOTSTEPS, TERRAIN = FootstepParameters(), TerrainParameters()


@pytest.mark.skipif(not MAPS, reason="LOOKSTEP_DATA does not point to a folder that holds planar_regions/*.json")
@pytest.mark.parametrize("path", MAPS, ids=lambda path: path.stem)
def test_maps_of_the_reference_suite_are_crossed(path: Path):
    region_map = read_region_map(path)
    if region_map.note != "test":
        pytest.skip("not in the reference's own regression suite")
    stance = stand_on(region_map.regions, region_map.start_world, FOOTSTEPS, TERRAIN)
    plan = plan_whole_way(region_map.regions, stance, region_map.goal_world, FOOTSTEPS, TERRAIN)
    assert plan.outcome is PlanOutcome.GOAL_REACHED, plan.reason
