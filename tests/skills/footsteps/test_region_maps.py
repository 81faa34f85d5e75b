"""Whole plans over the planar-region maps that the reference system's planner is tested on."""

import json
import os
from pathlib import Path

import numpy as np
import pytest
from open_loop import standing

from skills.body_path import SubGoalParameters, straight_path, sub_goal
from skills.footsteps import FootstepParameters, PlanOutcome, Stance, TerrainParameters, plan_from_stance, terrain_ahead
from skills.geometry.pose import Pose
from skills.regions.planar_region import PlanarRegion, PlanarRegions

FOLDER = Path(os.environ.get("LOOKSTEP_DATA", "")) / "planar_regions"
MAPS = sorted(FOLDER.glob("*.json")) if "LOOKSTEP_DATA" in os.environ else []
# More of the way at once than a real sub-goal asks for: the whole of it.
WHOLE_WAY = SubGoalParameters(ahead=5.0, ahead_in_curve=5.0, search_beyond=5.0)


def read_map(path: Path) -> tuple[dict, PlanarRegions]:
    data = json.loads(path.read_text())
    regions = []
    for region in data["regions"]:
        T = Pose.from_quaternion_xyzw(region["quaternion_xyzw"], region["origin"])
        regions.append(PlanarRegion(T, np.array(region["hull"]).reshape(-1, 2), (), 0.0, 0.0))
    return data, PlanarRegions(tuple(regions), 0.0, 0)


@pytest.mark.skipif(not MAPS, reason="LOOKSTEP_DATA does not point to a folder that holds planar_regions/*.json")
@pytest.mark.parametrize("path", MAPS, ids=lambda path: path.stem)
def test_maps_of_the_reference_suite_are_crossed(path: Path):
    data, regions = read_map(path)
    if data.get("status_2019") != "test":
        pytest.skip("not in the reference's own regression suite")
    start, goal = np.array(data["start_position"]), np.array(data["goal_position"])
    facing = np.arctan2(goal[1] - start[1], goal[0] - start[0])
    start_yaw, goal_yaw = data.get("start_yaw", facing), data.get("goal_yaw", facing)
    way = straight_path(np.array((*start[:2], start_yaw)), np.array((*goal[:2], goal_yaw)))
    if way.length > 10.0:
        pytest.skip("farther than one search looks")
    parameters = FootstepParameters()
    level = standing(start[0], start[1], start_yaw, start[2])
    ahead = sub_goal(way, level, WHOLE_WAY)
    terrain = terrain_ahead(regions, level, ahead, parameters, TerrainParameters())
    soles = [terrain.snap(T.p[0], T.p[1], start_yaw, parameters) for T in (level.T_world_left, level.T_world_right)]
    left, right = (sole.T_world_sole for sole in soles)
    assert left is not None and right is not None
    plan = plan_from_stance(terrain, Stance(left, right), ahead, parameters)
    assert plan.outcome is PlanOutcome.GOAL_REACHED, plan.reason
