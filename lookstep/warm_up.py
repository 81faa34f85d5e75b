"""Load every compiled kernel before the clock starts, so that no walk pays for compiling.

The whole chain runs once on a small flat course: one image, its regions, one scan, its heights, one plan, one control
step. The first time on a machine this compiles, later it loads from the disk cache. Compiling is work for one core, so
the first time a second process sees to about half of the kernels, and leaves them in the cache.
"""

from __future__ import annotations

import dataclasses
import gc
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np

from lookstep.configuration import Configuration, load_configuration
from lookstep.world import build_world
from sim_envs.courses import load_course
from skills.body_path import straight_path, sub_goal
from skills.footsteps import Side, plan_footsteps, plan_from_stance, stand_on, terrain_ahead
from skills.geometry import DepthImage, Pose
from skills.height_map import HeightMapper
from skills.kernels import kernel_cache
from skills.regions import MapParameters, PlanarRegion, PlanarRegions, RegionMemory, examine_regions, remember
from skills.regions.extraction import polygons_of

_COMPILED = "compiled"  # empty file in the cache of kernels: all of them are in there


def warm_up(configuration: Configuration) -> None:
    """Run each kernel once with the types that a walk uses."""
    course = load_course("flat")
    world = build_world(course, configuration, "kinematic")
    with _second_process():
        image, scan, stance = world.depth_image(), world.lidar_scan(), world.status().imminent_stance
        assert image is not None and scan is not None, "the world takes its first frames when it is made"
        HeightMapper(configuration.height_map).update(scan, stance.mid_feet)
        regions = examine_regions(image, configuration.regions).regions
        parameters = MapParameters.of(configuration.region_memory, configuration.registration, configuration.footsteps)
        memory = RegionMemory()
        for _ in range(2):  # The second look is registered against the first.
            memory = remember(memory, regions, stance, image, parameters)
    assert memory.ground is not None, "it has just been looked at"
    warm_up_planner(configuration)
    goal = sub_goal(straight_path(np.array(course.start), np.array(course.goal)), stance, configuration.sub_goal)
    terrain = terrain_ahead(memory.ground, stance, goal, configuration.footsteps, configuration.terrain)
    plan = plan_from_stance(terrain, stance, goal, configuration.footsteps)
    world.send_footsteps(plan.steps)
    world.advance(0.1)
    (kernel_cache() / _COMPILED).touch()


@contextmanager
def _second_process() -> Iterator[None]:
    """Let another process compile what it can meanwhile, where there is something to compile and a core to do it."""
    if (kernel_cache() / _COMPILED).exists() or len(os.sched_getaffinity(0)) < 2:
        yield
        return
    # What a compiler makes is kept; looking again and again for what of it is garbage takes a tenth of the time.
    gc.disable()
    try:
        # Where the other fails, its kernels are compiled here.
        with subprocess.Popen((sys.executable, "-m", __name__), stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL):
            yield
    finally:
        gc.enable()


def warm_up_beside(configuration: Configuration) -> None:
    """What the second process does: polygons and plans, about as much as all the rest."""
    camera, downward = configuration.camera.camera, Pose(np.diag((1.0, -1.0, -1.0)), np.zeros(3))
    floor = np.zeros((camera.height, camera.width), dtype=np.int16)
    image = DepthImage(np.ones(floor.shape, dtype=np.float32), camera, downward, 0.0, 0)
    polygons_of(image, floor, np.array([[0.0, 0.0, 1.0]]), np.zeros(1), np.zeros(1), configuration.regions)
    warm_up_planner(configuration)


def _slab(length: float, width: float, pose: Pose | None = None) -> PlanarRegion:
    half = 0.5 * np.array((length, width))
    outline = half * ((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0))
    return PlanarRegion(pose or Pose.identity(), outline, (outline,), length * width, 0.0)


def warm_up_planner(configuration: Configuration) -> None:
    """Plan over a beam so narrow that feet must be moved to its middle and stand on it in part; then once more."""
    parameters = dataclasses.replace(configuration.footsteps, share=0.5)
    stance = stand_on(PlanarRegions((), 0.0, 0), np.zeros(4), parameters, configuration.terrain)
    beam = _slab(4.0, 0.26, Pose.from_xyz_rpy((1.0, 0.01, 0.0)))
    goal = sub_goal(straight_path(np.zeros(3), np.array((3.0, 0.0, 0.0))), stance, configuration.sub_goal)
    terrain = terrain_ahead(PlanarRegions((beam,), 0.0, 0), stance, goal, parameters, configuration.terrain)
    plan = plan_footsteps(terrain, stance, Side.LEFT, goal, parameters)
    plan_footsteps(terrain, stance, Side.LEFT, goal, parameters, reference=plan)


if __name__ == "__main__":
    gc.disable()
    warm_up_beside(load_configuration())
