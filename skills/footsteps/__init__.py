"""Footstep planning: where the next feet land, on which ground, and how they get there."""

from skills.footsteps.footstep import Footstep, FootstepPlan, PlanOutcome, Side, Stance
from skills.footsteps.footstep_parameters import FootstepParameters, TerrainParameters
from skills.footsteps.footstep_planner import plan_footsteps, plan_from_stance, terrain_ahead
from skills.footsteps.plan_request import PlanRequest, plan_on_request
from skills.footsteps.search_log import SearchLog
from skills.footsteps.supported_polygon import whole_sole
from skills.footsteps.swing_clearance import SwingClearance, swing_clearance
from skills.footsteps.terrain import Foothold, RegionTerrain, Terrain, region_terrain
from skills.footsteps.whole_way import plan_whole_way, stand_on

__all__ = [
    "Foothold",
    "Footstep",
    "FootstepParameters",
    "FootstepPlan",
    "PlanOutcome",
    "PlanRequest",
    "RegionTerrain",
    "SearchLog",
    "Side",
    "Stance",
    "SwingClearance",
    "Terrain",
    "TerrainParameters",
    "plan_footsteps",
    "plan_from_stance",
    "plan_on_request",
    "plan_whole_way",
    "region_terrain",
    "stand_on",
    "swing_clearance",
    "terrain_ahead",
    "whole_sole",
]
