"""Load every compiled kernel before the clock starts, so that no walk pays for compiling.

The whole chain runs once on a small flat course: one image, its regions, one scan, its heights, one plan, one control
step. The first time on a machine this compiles, later it loads from the disk cache. Compiling is work for one core, so
the first time a second process sees to about half of the kernels, and leaves them in the cache.
"""

from __future__ import annotations

import dataclasses
import fcntl
import gc
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np

from lookstep.configuration import Configuration, load_configuration
from lookstep.world import build_world
from sim_envs.courses import load_course
from skills.body_path import Goal, PathRequest, plan_body_path, straight_path, sub_goal
from skills.footsteps import Side, plan_footsteps, plan_from_stance, stand_on, terrain_ahead
from skills.geometry import DepthImage, Pose
from skills.height_map import HeightMapper
from skills.kernel_locator import kernels_hash
from skills.kernels import kernel_cache
from skills.regions import MapParameters, PlanarRegion, PlanarRegions, RegionMemory, examine_regions, remember
from skills.regions.extraction import polygons_of
from skills.regions.growing import grow_regions
from skills.regions.own_body import without_body
from skills.regions.patches import fit_patches
from skills.regions.refinement import refine_regions


def warm_up(configuration: Configuration) -> None:
    """Run each kernel once with the types that a walk uses; a run that begins meanwhile waits for its kernels."""
    with _alone():
        _run_kernels(configuration)


def _run_kernels(configuration: Configuration) -> None:
    course = load_course("flat")
    world = build_world(course, configuration, "kinematic")
    parameters = MapParameters.of(configuration.region_memory, configuration.registration, configuration.footsteps)
    with _second_process():
        image = world.depth_image(world.depth_cameras.names[0])
        scan, stance = world.lidar_scan(), world.status().imminent_stance
        assert image is not None and scan is not None, "the world takes its first frames when it is made"
        height_map = HeightMapper(configuration.height_map).update(scan, stance.mid_feet)
        request = PathRequest(height_map, np.array(course.start), Goal(3.0, 0.0, 0.0), configuration.body_path)
        # The second path is planned while the first is walked.
        plan_body_path(dataclasses.replace(request, walked=plan_body_path(request).path))
        patches = fit_patches(without_body(image), configuration.regions)
        coarse = grow_regions(patches, configuration.regions, configuration.regions.patches_min)
        refine_regions(image, patches, coarse, configuration.regions)
        memory = remember(RegionMemory(), PlanarRegions((_slab(4.0, 4.0),), 0.0, 0), stance, image, parameters)
    # The second look is registered against the first.
    memory = remember(memory, examine_regions(image, configuration.regions).regions, stance, image, parameters)
    assert memory.ground is not None, "it has just been looked at"
    warm_up_planner(configuration)
    goal = sub_goal(straight_path(np.array(course.start), np.array(course.goal)), stance, configuration.sub_goal)
    terrain = terrain_ahead(memory.ground, stance, goal, configuration.footsteps, configuration.terrain)
    plan = plan_from_stance(terrain, stance, goal, configuration.footsteps)
    world.send_footsteps(plan.steps)
    world.advance(0.1)
    compiled_mark().touch()


def compiled_mark() -> Path:
    """Empty file in the cache of kernels: all of them are in there as they are now."""
    return kernel_cache() / f"compiled-{kernels_hash()}"


@contextmanager
def _alone() -> Iterator[None]:
    """Keep other runs from writing the cache at the same time: numba's index takes one writer."""
    if compiled_mark().exists():
        yield
        return
    kernel_cache().mkdir(parents=True, exist_ok=True)
    with open(kernel_cache() / "lock", "w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        yield


@contextmanager
def _second_process() -> Iterator[None]:
    """Let another process compile what it can meanwhile, where there is something to compile and a core to do it."""
    if compiled_mark().exists() or len(os.sched_getaffinity(0)) < 2:
        yield
        return
    # What a compiler makes is kept; looking again and again for what of it is garbage takes a tenth of the time.
    gc.disable()
    # Two processes must not write one cache at a time: each names what it writes without asking the other.
    beside = kernel_cache() / "beside"
    # What a run that was killed has left there is worth nothing.
    shutil.rmtree(beside, ignore_errors=True)
    try:
        shutil.rmtree(beside, ignore_errors=True)  # What a run left there that was killed.
        link_known(beside)
        environment = {**os.environ, "NUMBA_CACHE_DIR": str(beside)}
        # Where the other fails, its kernels are compiled here.
        command = (sys.executable, "-m", __name__)
        with subprocess.Popen(command, env=environment, stdin=subprocess.DEVNULL, stderr=subprocess.DEVNULL):
            yield
        take_over(beside)
    finally:
        gc.enable()
        shutil.rmtree(beside, ignore_errors=True)


def link_known(beside: Path) -> None:
    """Give another cache what is compiled already; numba replaces files and never writes into one."""
    for folder in kernel_cache().iterdir():
        if folder.is_dir() and folder != beside:
            shutil.copytree(folder, beside / folder.name, copy_function=os.link, dirs_exist_ok=True)


def take_over(beside: Path) -> None:
    """Move the kernels of another cache into ours, but for those that are there: an index and its data at a time."""
    for index in sorted(beside.rglob("*.nbi")):
        target = kernel_cache() / index.parent.relative_to(beside)
        target.mkdir(parents=True, exist_ok=True)
        if (target / index.name).exists():
            continue
        for data in index.parent.iterdir():
            if data.suffix == ".nbc" and data.name.startswith(index.stem + "."):
                data.replace(target / data.name)
        index.replace(target / index.name)


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
