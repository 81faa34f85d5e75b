"""Footsteps for the whole way from a stance to a goal, on a map that is known from start to end."""

from __future__ import annotations

import numpy as np

from skills.footsteps.footstep import FootstepPlan, Side, Stance
from skills.footsteps.footstep_parameters import FootstepParameters, TerrainParameters
from skills.footsteps.footstep_planner import plan_from_stance, terrain_ahead
from skills.footsteps.terrain import region_terrain
from skills.geometry.pose import Array, Pose
from skills.regions.planar_region import PlanarRegions

_EXPANSIONS = 15000


def plan_whole_way(
    regions: PlanarRegions,
    stance: Stance,
    goal_world: Array,
    parameters: FootstepParameters,
    terrain_parameters: TerrainParameters,
) -> FootstepPlan:
    """Plan all steps from a stance to a goal.

    Args:
        regions: the ground, known from start to end.
        stance: where the feet are.
        goal_world: (4,) middle of the feet x, y, z [m] and heading [rad] at the goal.
        parameters: limits, costs and search settings.
        terrain_parameters: how regions become ground.

    Returns:
        The plan; its outcome is GOAL_REACHED with both feet at the goal, PARTIAL or BLOCKED where that was not found.
    """
    # The body path's package itself needs this one.
    from skills.body_path.straight_path import straight_path
    from skills.body_path.sub_goal import SubGoal

    start = np.array((*stance.mid_feet[:2], stance.yaw))
    path = straight_path(start, np.asarray(goal_world)[[0, 1, 3]])
    searched = np.column_stack((path.waypoints_world, path.arc_lengths))
    goal = SubGoal(path, 0.0, path.length, path.length, searched)
    terrain = terrain_ahead(regions, stance, goal, parameters, terrain_parameters)
    return plan_from_stance(terrain, stance, goal, parameters, max_expansions=_EXPANSIONS)


def stand_on(
    regions: PlanarRegions,
    xyzyaw_world: Array,
    parameters: FootstepParameters,
    terrain_parameters: TerrainParameters,
) -> Stance:
    """Both feet side by side on the ground at a place; level at the place's height where there is none under a foot."""
    x, y, z, yaw = (float(n) for n in xyzyaw_world)
    around = parameters.ideal_width + parameters.sole_length
    terrain = region_terrain(regions, np.array((x, y)) - around, np.array((x, y)) + around, terrain_parameters)
    soles = {}
    for side in Side:
        half = 0.5 * side.sign * parameters.ideal_width
        foot_x, foot_y = x - half * np.sin(yaw), y + half * np.cos(yaw)
        found = terrain.snap(foot_x, foot_y, yaw, parameters).T_world_sole
        soles[side] = found or Pose.from_xyz_rpy((foot_x, foot_y, z), (0.0, 0.0, yaw))
    return Stance(soles[Side.LEFT], soles[Side.RIGHT])
