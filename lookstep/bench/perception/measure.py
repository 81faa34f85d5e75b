"""Let an extractor look at many scenes and judge what it finds.

From Python, on scenes that may be used for tuning:

    measure_quality(extractor(), "scattered", "standard", TUNING_SEEDS[:12])
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from lookstep.bench.perception.ground_cells import GroundCells, TrueGround, ground_figures, judge_ground, true_ground
from lookstep.bench.perception.quality import Quality, figures, judge, pool
from lookstep.bench.perception.rapid_regions_baseline import find_regions
from lookstep.bench.perception.scenes import CAMERA, NOISES, SCENES, scene
from lookstep.bench.perception.truth import Truth, true_view
from lookstep.bench.subject import Progress
from sim_envs.courses import Ground
from sim_envs.sensors.depth_noise import DepthNoiseModel
from skills.geometry.camera import DepthImage
from skills.regions import PlanarRegions, RegionParameters, examine_regions

Extractor = Callable[[DepthImage], tuple[PlanarRegions, NDArray[np.integer]]]
"""Finds regions in an image, and says which label each pixel has, (height, width), negative for none."""


@dataclass(frozen=True, slots=True, eq=False)
class TrueFrame:
    """What a camera truly sees, and the ground around it on the contiguous course."""

    truth: Truth
    ground: TrueGround | None


def every_plane(parameters: RegionParameters) -> RegionParameters:
    """The same parameters, but walls and overhangs, what is near and what is small are regions too."""
    return dataclasses.replace(parameters, slope_max=np.pi, distance_min=0.0, area_min=0.0)


def extractor(parameters: RegionParameters | None = None) -> Extractor:
    """The extraction of `skills.regions` without its limits on slope and nearness."""
    chosen = every_plane(parameters or RegionParameters())

    def extract(image: DepthImage) -> tuple[PlanarRegions, NDArray[np.integer]]:
        extraction = examine_regions(image, chosen)
        return extraction.regions, extraction.labels

    return extract


def baseline_extractor(parameters: RegionParameters | None = None) -> Extractor:
    """The paper's own method, with the same limits lifted."""
    chosen = every_plane(parameters or RegionParameters())
    return lambda image: find_regions(image, chosen)


def measure_quality(
    extract: Extractor,
    scene_name: str,
    noise: str,
    seeds: Iterable[int],
    depth_max: float = RegionParameters().depth_max,
) -> dict[str, float]:
    """Figures of an extractor over scenes of one name, by the names in `figures` and `ground_figures`.

    Args:
        extract: what is judged.
        scene_name: of `SCENES`.
        noise: of `NOISES`.
        seeds: of the scenes.
        depth_max: surfaces deeper than this are not judged [m].
    """
    frames = [judge_frame(extract, true_frame(scene_name, seed, depth_max), noise) for seed in seeds]
    return frame_figures(frames)


def compare_methods(
    methods: Mapping[str, Extractor], seeds: Sequence[int], depth_max: float, progress: Progress
) -> dict[tuple[str, str, str], dict[str, float]]:
    """Figures by method, scene and noise, on these seeds of every scene; every method sees the same images."""
    judged: dict[tuple[str, str, str], list[tuple[Quality, GroundCells | None]]] = {}
    for scene_name in SCENES:
        for index, seed in enumerate(seeds):
            progress(f"judging regions of {scene_name} scenes", index, len(seeds))
            frame = true_frame(scene_name, seed, depth_max)
            for noise in NOISES:
                for method, extract in methods.items():
                    judged.setdefault((method, scene_name, noise), []).append(judge_frame(extract, frame, noise))
    return {key: frame_figures(frames) for key, frames in judged.items()}


def frame_figures(frames: Sequence[tuple[Quality, GroundCells | None]]) -> dict[str, float]:
    """Figures of several frames."""
    grounds = [cells for _, cells in frames if cells is not None]
    return figures(pool([quality for quality, _ in frames])) | (ground_figures(grounds) if grounds else {})


def true_frame(scene_name: str, seed: int, depth_max: float) -> TrueFrame:
    """A scene and what its camera truly sees, down to a depth [m]."""
    looked_at = scene(scene_name, seed)
    truth = true_view(looked_at, depth_max)
    return TrueFrame(truth, true_ground(truth, Ground(looked_at.boxes)) if scene_name == "contiguous" else None)


def judge_frame(extract: Extractor, frame: TrueFrame, noise: str) -> tuple[Quality, GroundCells | None]:
    """What an extractor makes of one frame; cells of ground on the contiguous course only."""
    regions, labels = extract(noisy(frame.truth.image, noise))
    cells = None if frame.ground is None else judge_ground(frame.ground, regions)
    return judge(frame.truth, regions, labels), cells


def noisy(image: DepthImage, noise: str) -> DepthImage:
    """An image as the sensor measures it; its frame number alone determines the noise."""
    return dataclasses.replace(image, depth=_noise_model(noise).corrupt(image.depth, image.frame_id))


@lru_cache
def _noise_model(noise: str) -> DepthNoiseModel:
    return DepthNoiseModel(NOISES[noise], CAMERA, seed=0)
