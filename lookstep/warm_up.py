"""Load every compiled kernel before the clock starts, so that no walk pays for compiling.

The whole chain runs once on a small flat course: one image, its regions, one scan, its heights, one plan, one control
step. The first time on a machine this compiles, later it loads from the disk cache.
"""

from __future__ import annotations

import dataclasses

import numpy as np

from lookstep.configuration import Configuration
from lookstep.world import build_world
from sim_envs.courses import load_course
from skills.body_path import straight_path, sub_goal
from skills.footsteps import Side, plan_footsteps, plan_from_stance, stand_on, terrain_ahead
from skills.geometry import Pose
from skills.height_map import HeightMapper
from skills.regions import MapParameters, PlanarRegion, PlanarRegions, RegionMemory, examine_regions, remember


def warm_up(configuration: Configuration) -> None:
    """Run each kernel once with the types that a walk uses."""
    course = load_course("flat")
    world = build_world(course, configuration, "kinematic")
    image, scan = world.depth_image(), world.lidar_scan()
    assert image is not None and scan is not None, "the world takes its first frames when it is made"
    stance = world.status().imminent_stance
    extraction = examine_regions(image, configuration.regions)
    HeightMapper(configuration.height_map).update(scan, stance.mid_feet)
    parameters = MapParameters.of(configuration.region_memory, configuration.registration, configuration.footsteps)
    memory = RegionMemory()
    for _ in range(2):  # The second look is registered against the first.
        memory = remember(memory, extraction.regions, stance, image, parameters)
    ground = memory.ground
    assert ground is not None, "it has just been looked at"
    path = straight_path(np.array(course.start), np.array(course.goal))
    goal = sub_goal(path, stance, configuration.sub_goal)
    terrain = terrain_ahead(ground, stance, goal, configuration.footsteps, configuration.terrain)
    plan = plan_from_stance(terrain, stance, goal, configuration.footsteps)
    world.send_footsteps(plan.steps)
    world.advance(0.1)
    warm_up_planner(configuration)


def warm_up_planner(configuration: Configuration) -> None:
    """Plan over a beam so narrow that feet must be moved to its middle and stand on it in part; then once more."""
    parameters = dataclasses.replace(configuration.footsteps, share=0.5)
    stance = stand_on(PlanarRegions((), 0.0, 0), np.zeros(4), parameters, configuration.terrain)
    outline = 0.5 * np.array(((-4.0, -0.26), (4.0, -0.26), (4.0, 0.26), (-4.0, 0.26)))
    beam = PlanarRegion(Pose.from_xyz_rpy((1.0, 0.01, 0.0)), outline, (outline,), 1.04, 0.0)
    goal = sub_goal(straight_path(np.zeros(3), np.array((3.0, 0.0, 0.0))), stance, configuration.sub_goal)
    terrain = terrain_ahead(PlanarRegions((beam,), 0.0, 0), stance, goal, parameters, configuration.terrain)
    plan = plan_footsteps(terrain, stance, Side.LEFT, goal, parameters)
    plan_footsteps(terrain, stance, Side.LEFT, goal, parameters, reference=plan)
