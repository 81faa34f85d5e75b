"""Plans of three steps as the walking robot asks for them: from every stance of a walk over the rough course."""

from __future__ import annotations

import numpy as np

from lookstep.bench.timing import Timing, timed
from sim_envs.courses import Box, Course, load_course
from skills.body_path import SubGoalParameters, goal_reached, straight_path, sub_goal
from skills.footsteps import (
    FootstepParameters,
    FootstepPlan,
    Side,
    TerrainParameters,
    plan_footsteps,
    stand_on,
    terrain_ahead,
)
from skills.geometry.pose import Pose
from skills.regions import PlanarRegion, PlanarRegions

_MOST_STEPS = 60


def measure_three_steps(
    parameters: FootstepParameters, terrain_parameters: TerrainParameters, repeats: int, seeds: int = 1
) -> Timing:
    """Time every plan of walks over the rough course on its true regions, ground drawing and swings included."""
    times: list[float] = []
    for seed in range(seeds):
        times += _walk(load_course("rough", seed), parameters, terrain_parameters, repeats)
    return Timing.of(times)


def _walk(
    course: Course, parameters: FootstepParameters, terrain_parameters: TerrainParameters, repeats: int
) -> list[float]:
    """Take the first step of each plan until the goal is reached; the times of all plans [s]."""
    regions = PlanarRegions(tuple(_top(box) for box in course.boxes), 0.0, 0)
    start, goal = np.array(course.start), np.array(course.goal)
    sub_goals = SubGoalParameters()
    path = straight_path(start, goal)
    stance = stand_on(regions, np.array((*start[:2], 0.0, start[2])), parameters, terrain_parameters)
    times: list[float] = []
    side, plan = Side.LEFT, None
    for _ in range(_MOST_STEPS):
        ahead = sub_goal(path, stance, sub_goals)

        def once(stance=stance, side=side, ahead=ahead, reference=plan) -> FootstepPlan:  # noqa: ANN001
            terrain = terrain_ahead(regions, stance, ahead, parameters, terrain_parameters)
            return plan_footsteps(terrain, stance, side, ahead, parameters, reference=reference)

        plan, spent = timed(once, repeats)
        times += spent
        if not plan.steps or goal_reached(path, stance, sub_goals):
            break
        stance, side = stance.with_sole(side, plan.steps[0].T_world_sole), side.opposite
    return times


def _top(box: Box) -> PlanarRegion:
    """The upper face of a box."""
    x, y, z = (0.5 * length for length in box.size)
    outline = np.array(((-x, -y), (x, -y), (x, y), (-x, y)))
    T_world_top = box.T_world_box @ Pose.from_xyz_rpy((0.0, 0.0, z))
    return PlanarRegion(T_world_top, outline, (outline,), box.size[0] * box.size[1], 0.0)
