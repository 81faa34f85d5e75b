"""Synthetic and generated ground, and walking over it without a robot: plan, take the first step, repeat."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from sim_envs.courses import Box, Course, load_course
from skills.body_path import Goal, SubGoalParameters, goal_reached, straight_path, sub_goal
from skills.footsteps import (
    Footstep,
    FootstepParameters,
    FootstepPlan,
    Stance,
    Terrain,
    TerrainParameters,
    plan_footsteps,
    plan_from_stance,
    terrain_ahead,
)
from skills.geometry.pose import Array, Pose
from skills.regions.planar_region import PlanarRegion, PlanarRegions


@dataclass(frozen=True, slots=True, eq=False)
class Taken:
    """A step taken, the stance it was made from, the plan it comes from and the ground that plan saw."""

    step: Footstep
    stance: Stance
    plan: FootstepPlan
    terrain: Terrain

    @property
    def landed(self) -> Stance:
        return self.stance.with_sole(self.step.side, self.step.T_world_sole)


def rectangle(
    xyz: tuple[float, float, float],
    rpy: tuple[float, float, float] = (0.0, 0.0, 0.0),
    size: tuple[float, float] = (0.37, 0.37),
    time: float = 0.0,
) -> PlanarRegion:
    x, y = 0.5 * size[0], 0.5 * size[1]
    outline = np.array(((-x, -y), (x, -y), (x, y), (-x, y)))
    return PlanarRegion(Pose.from_xyz_rpy(xyz, rpy), outline, (outline,), size[0] * size[1], time)


def region_map(*regions: PlanarRegion) -> PlanarRegions:
    return PlanarRegions(regions, 0.0, 0)


def random_field(seed: int, rows: int = 8, tilted: float = 0.34, spread: float = 0.05) -> PlanarRegions:
    """Pads before and behind three columns of blocks 0.37 m apart, without gaps."""
    generator = np.random.default_rng(seed)
    length = 0.37 * rows
    regions = [rectangle((x, 0.0, 0.0), size=(1.2, 1.11)) for x in (0.0, 1.2 + length)]
    for row in range(rows):
        for column in (-1, 0, 1):
            rpy = [0.0, 0.0, 0.0]
            if generator.random() < tilted:
                tilt = generator.uniform(np.deg2rad(11), np.deg2rad(18))
                rpy[generator.integers(2)] = float(tilt * generator.choice((-1.0, 1.0)))
            height = 0.3 * np.sin(np.pi * (row + 0.5) / rows) + generator.uniform(-spread, spread)
            regions.append(
                rectangle((0.6 + 0.37 * (row + 0.5), 0.37 * column, float(height)), (rpy[0], rpy[1], rpy[2]))
            )
    return region_map(*regions)


def course_regions(course: Course) -> PlanarRegions:
    """The top faces of a course's boxes."""
    return region_map(*(_top(box) for box in course.boxes))


def _top(box: Box) -> PlanarRegion:
    x, y, z = (0.5 * length for length in box.size)
    outline = np.array(((-x, -y), (x, -y), (x, y), (-x, y)))
    return PlanarRegion(
        box.T_world_box @ Pose.from_xyz_rpy((0.0, 0.0, z)), outline, (outline,), box.size[0] * box.size[1], 0.0
    )


def generated(name: str, seed: int) -> tuple[PlanarRegions, Array, Array]:
    """Regions, start and goal of a generated course."""
    course = load_course(name, seed)
    return course_regions(course), np.array(course.start), np.array(course.goal)


def standing(x: float = 0.0, y: float = 0.0, yaw: float = 0.0, z: float = 0.0, width: float = 0.24) -> Stance:
    side = 0.5 * width * np.array((-np.sin(yaw), np.cos(yaw)))
    left, right = (Pose.from_xyz_rpy((x + s * side[0], y + s * side[1], z), (0.0, 0.0, yaw)) for s in (1, -1))
    return Stance(left, right)


def walk(
    regions: PlanarRegions,
    start: Array,
    goal: Array,
    parameters: FootstepParameters | None = None,
    sub_goals: SubGoalParameters | None = None,
    most: int = 80,
) -> tuple[list[Taken], FootstepPlan | None]:
    """Steps taken, and the last plan where the way ended before the goal."""
    parameters, sub_goals = parameters or FootstepParameters(), sub_goals or SubGoalParameters()
    stance = standing(*(float(n) for n in start))
    path = straight_path(start, goal)
    taken: list[Taken] = []
    plan: FootstepPlan | None = None
    while not goal_reached(Goal(*(float(n) for n in goal)), stance, sub_goals):
        ahead = sub_goal(path, stance, sub_goals)
        terrain = terrain_ahead(regions, stance, ahead, parameters, TerrainParameters())
        if taken:
            side = taken[-1].step.side.opposite
            plan = plan_footsteps(terrain, stance, side, ahead, parameters, reference=plan)
        else:
            plan = plan_from_stance(terrain, stance, ahead, parameters)
        if not plan.steps or len(taken) == most:
            return taken, plan
        taken.append(Taken(plan.steps[0], stance, plan, terrain))
        stance = taken[-1].landed
    return taken, None


def swing_start(taken: Taken) -> Pose:
    return taken.stance.sole(taken.step.side)


def stance_foot(taken: Taken) -> Pose:
    return taken.stance.sole(taken.step.side.opposite)
