"""Footsteps for the whole way from a stance to a goal, on a map that is known from start to end.

No body path is needed: a field over the ground tells how far every place is from the goal, around walls, over gaps and
up stairs that wind over themselves, and guides the search. Where the ground does not lead to the goal, the plan goes to
the place nearest to it that can be reached.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np

from skills.footsteps.footstep import FootstepPlan, PlanOutcome, Side, Stance
from skills.footsteps.footstep_parameters import FootstepParameters, TerrainParameters
from skills.footsteps.footstep_planner import WayPlanner
from skills.footsteps.goal_field import open_edges, spread_field
from skills.footsteps.search_log import SearchLog
from skills.footsteps.search_request import step_limits
from skills.footsteps.search_target import SearchTarget
from skills.footsteps.stride import stride_towards
from skills.footsteps.terrain import RegionTerrain, region_terrain
from skills.footsteps.way import Way
from skills.geometry.pose import Array, Pose
from skills.regions.planar_region import PlanarRegion, PlanarRegions

# How far around start and goal ground is looked at, as a share of their distance and at least [m].
_AROUND, _AT_LEAST = 0.35, 3.0


def plan_whole_way(
    regions: PlanarRegions,
    stance: Stance,
    goal_world: Array,
    parameters: FootstepParameters,
    terrain_parameters: TerrainParameters,
    *,
    out_of_time: Callable[[], bool] | None = None,
    logs: list[SearchLog] | None = None,
) -> FootstepPlan:
    """Plan all steps from a stance to a goal.

    Args:
        regions: the ground, known from start to end.
        stance: where the feet are.
        goal_world: (4,) middle of the feet x, y, z [m] and heading [rad] at the goal; z tells floors apart.
        parameters: limits, costs and search settings.
        terrain_parameters: how regions become ground.
        out_of_time: as in `plan_footsteps`.
        logs: as there.

    Returns:
        The plan; its outcome is GOAL_REACHED with both feet at the goal, PARTIAL or BLOCKED where that was not found.

    Raises:
        ValueError: where the goal is not four finite numbers.
    """
    goal = np.asarray(goal_world, dtype=np.float64)
    if goal.shape != (4,) or not np.all(np.isfinite(goal)):
        raise ValueError(f"goal_world: got {goal.tolist()}, needs four finite numbers x, y, z, yaw")
    low, high = _window(regions, stance.mid_feet[:2], goal[:2])
    terrain = region_terrain(regions, low, high, terrain_parameters)
    target, reachable = _target(terrain, stance, goal, parameters)
    best, planner, budget = None, None, parameters.whole_way_expansions
    for side in _sides(stance, goal):
        tried = WayPlanner(terrain, stance, side, target, parameters)
        way = tried.way(max_expansions=budget, out_of_time=out_of_time, logs=logs)
        if best is None or way.rank < best.rank:
            best, planner = way, tried
        # A search that has spent its budget would spend the other foot's as well.
        if best.reached or way.expansions >= budget:
            break
    assert best is not None and planner is not None, "a robot has feet"
    return planner.plan(best if reachable else _short_of_goal(best), 0, 0)


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
        found = terrain.snap(foot_x, foot_y, yaw, parameters, z).T_world_sole
        soles[side] = found or Pose.from_xyz_rpy((foot_x, foot_y, z), (0.0, 0.0, yaw))
    return Stance(soles[Side.LEFT], soles[Side.RIGHT])


def _window(regions: PlanarRegions, start: Array, goal: Array) -> tuple[Array, Array]:
    """Corners of the ground that is looked at: around start and goal, and no further than the ground goes."""
    around = max(_AROUND * float(np.linalg.norm(goal - start)), _AT_LEAST)
    low, high = np.minimum(start, goal), np.maximum(start, goal)
    bounds = [bound for bound in map(_bounds, regions.regions) if np.all(np.isfinite(bound))]
    if not bounds:
        return low - _AT_LEAST, high + _AT_LEAST
    ground_low, ground_high = np.min([low for low, _ in bounds], axis=0), np.max([high for _, high in bounds], axis=0)
    return (
        np.maximum(low - around, np.minimum(ground_low, low)),
        np.minimum(high + around, np.maximum(ground_high, high)),
    )


def _bounds(region: PlanarRegion) -> tuple[Array, Array]:
    if len(region.hull_region) == 0:
        return np.full(2, np.nan), np.full(2, np.nan)
    outline = region.hull_world[:, :2]
    return outline.min(axis=0), outline.max(axis=0)


def _target(
    terrain: RegionTerrain, stance: Stance, goal: Array, parameters: FootstepParameters
) -> tuple[SearchTarget, bool]:
    """The goal with its field, or where the ground does not lead there, the nearest place; whether it is the goal."""
    start = stance.mid_feet
    field, _, off = _field(terrain, goal[:3], start, parameters)
    reachable = off <= parameters.ideal_width
    if not reachable:
        around, _, _ = _field(terrain, start, np.full(3, np.inf), parameters)
        goal = _nearest(terrain, around, goal, parameters)
        field, _, _ = _field(terrain, goal[:3], start, parameters)
    path = np.array(((*start[:2], stance.yaw, 0.0), (goal[0], goal[1], goal[3], 1.0)))
    low, high = _searched(terrain, field, start, parameters)
    stride, near = stride_towards(0.0, parameters), parameters.goal_tolerance
    tolerances = near, near, parameters.goal_yaw_tolerance
    return SearchTarget(path, 1.0, True, True, stride, tolerances, low, high, float(goal[2]), field), reachable


def _field(
    terrain: RegionTerrain, goal: Array, start: Array, parameters: FootstepParameters
) -> tuple[Array, float, float]:
    """Field of costs to a goal, the cost at a start, and how far from the start the field is known."""
    floors, ny, nx = terrain.raster.cells.shape
    cell = parameters.field_cell
    rows, columns = (int(np.ceil(n * terrain.raster.resolution / cell)) for n in (ny, nx))
    field = np.empty((floors, rows, columns, 3))
    corner = (*terrain.corner_world, 0.0)
    cost, off = spread_field(
        terrain.raster, step_limits(parameters)[0], open_edges(), goal - corner, start - corner, field
    )
    return field, cost, off


def _nearest(terrain: RegionTerrain, around: Array, goal: Array, parameters: FootstepParameters) -> Array:
    """The place nearest to a goal among those of a field with a cost, with the goal's heading."""
    known = np.argwhere(np.isfinite(around[..., 0]))
    if len(known) == 0:
        return goal
    places = terrain.corner_world + (known[:, [2, 1]] + 0.5) * parameters.field_cell
    heights = around[(*known.T, 2)]
    off = np.linalg.norm(np.column_stack((places, heights)) - goal[:3], axis=1)
    nearest = int(np.argmin(off))
    return np.array((*places[nearest], heights[nearest], goal[3]))


def _searched(
    terrain: RegionTerrain, field: Array, start: Array, parameters: FootstepParameters
) -> tuple[Array, Array]:
    """Corners of the ground that may lie on the way: where a way from the start over it is not much longer."""
    _, rows, columns = np.nonzero(np.isfinite(field[..., 0]))
    places = terrain.corner_world + (np.column_stack((columns, rows)) + 0.5) * parameters.field_cell
    places = np.vstack((places, start[:2]))
    return places.min(axis=0) - parameters.window_margin, places.max(axis=0) + parameters.window_margin


def _sides(stance: Stance, goal: Array) -> tuple[Side, Side]:
    """The foot that is farther from the goal first."""
    left, right = (np.linalg.norm(stance.sole(side).p[:2] - goal[:2]) for side in (Side.LEFT, Side.RIGHT))
    return (Side.LEFT, Side.RIGHT) if left >= right else (Side.RIGHT, Side.LEFT)


def _short_of_goal(way: Way) -> Way:
    """A way to the nearest place is no way to the goal."""
    reason = "the ground does not lead to the goal" + (f"; {way.reason}" if way.reason else "")
    outcome = PlanOutcome.PARTIAL if way.footholds else PlanOutcome.BLOCKED
    return dataclasses.replace(way, outcome=outcome, reason=reason)
