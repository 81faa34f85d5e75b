"""How long every stage of perception takes on the frames of a walk, beside the paper's own method in the same run.

Each frame goes once through every stage, ours and the baseline in turn, so that what else runs on the machine meets
both. One thread; time of the thread is what counts, wall time is told beside it.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from typing import TypeVar

import cv2

from lookstep.bench.perception.rapid_regions_baseline import find_regions
from lookstep.bench.perception.walk_frames import WalkFrames
from lookstep.bench.subject import Progress
from lookstep.bench.timing import Timing
from lookstep.configuration import Configuration
from skills.height_map import HeightMapper
from skills.regions import MapParameters, RegionMemory, examine_regions, remember
from skills.regions.extraction import polygons_of
from skills.regions.growing import grow_regions
from skills.regions.patches import fit_patches
from skills.regions.refinement import refine_regions

T = TypeVar("T")

STAGES = {
    "depth": "depth image, robot in view",
    "depth_noise": "the same with noise",
    "patches": "regions: patches",
    "growing": "regions: growing",
    "refinement": "regions: pixels and planes",
    "polygons": "regions: polygons, convex parts",
    "extract": "regions, whole",
    "baseline": "regions, the paper's method",
    "memory": "region memory update",
    "lidar": "lidar scan with noise",
    "height_map": "height map update",
}
"""What is timed, and how people call it."""

_WARM_UP = 3  # frames that do not count


class StageTimes:
    """Collects times by stage."""

    def __init__(self) -> None:
        self._thread: dict[str, list[float]] = {stage: [] for stage in STAGES}
        self._wall: dict[str, list[float]] = {stage: [] for stage in STAGES}

    def timed(self, stage: str, function: Callable[..., T], *arguments: object) -> T:
        """Call a function and note how long it took."""
        wall, thread = time.perf_counter(), time.thread_time()
        result = function(*arguments)
        self._thread[stage].append(time.thread_time() - thread)
        self._wall[stage].append(time.perf_counter() - wall)
        return result

    def by_stage(self, *, wall: bool = False) -> dict[str, Timing]:
        """Median and 99th percentile of each stage, without the frames that warm up."""
        times = self._wall if wall else self._thread
        return {stage: Timing.of(values[_WARM_UP:] or values) for stage, values in times.items()}


def time_stages(walked: WalkFrames, configuration: Configuration, progress: Progress) -> StageTimes:
    """Send every frame of a walk through every stage, in the order of the walk."""
    times = StageTimes()
    memory, mapper = RegionMemory(), HeightMapper(configuration.height_map)
    of_map = MapParameters.of(configuration.region_memory, configuration.registration, configuration.footsteps)
    threads = cv2.getNumThreads()
    cv2.setNumThreads(1)
    try:
        for index, frame in enumerate(walked.frames):
            progress("timing every stage", index, len(walked.frames))
            camera, parameters = walked.camera, configuration.regions
            depth = frame.depth
            times.timed("depth", camera.render, depth.geom_positions, depth.geom_rotations, depth.T_world_sensor)
            image = times.timed("depth_noise", camera.capture, depth)
            extraction = times.timed("extract", examine_regions, image, parameters)
            times.timed("baseline", find_regions, image, parameters)
            patches = times.timed("patches", fit_patches, image, parameters)
            coarse = times.timed("growing", grow_regions, patches, parameters, parameters.patches_min)
            fine = times.timed("refinement", refine_regions, image, patches, coarse, parameters)
            pieces = (fine.labels, fine.planes, fine.sigma, fine.bend, parameters, fine.noise)
            times.timed("polygons", polygons_of, image, *pieces)
            memory = times.timed("memory", remember, memory, extraction.regions, frame.stance, image, of_map)
            scan = times.timed("lidar", walked.lidar.capture, frame.lidar)
            times.timed("height_map", mapper.update, scan, frame.stance.mid_feet, walked.goal[:2])
    finally:
        cv2.setNumThreads(threads)
    return times


def baseline_ratio(times: Mapping[str, Timing]) -> float:
    """How many times longer the paper's method takes."""
    return times["baseline"].median_ms / times["extract"].median_ms
