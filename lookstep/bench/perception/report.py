"""The figures of `lookstep bench perception`, gathered, for people and for programs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rich.box import SIMPLE
from rich.table import Table
from rich.text import Text

from lookstep.bench.machine import machine
from lookstep.bench.perception.measure import Extractor, baseline_extractor, compare_methods, extractor
from lookstep.bench.perception.scenes import HELD_OUT_SEEDS, NOISES, SCENES
from lookstep.bench.perception.stage_times import STAGES, StageTimes, baseline_ratio, time_stages
from lookstep.bench.perception.walk_frames import walk_frames
from lookstep.bench.subject import Progress
from lookstep.bench.timing import Timing
from lookstep.configuration import load_configuration
from lookstep.summary import installed_versions

Figures = Mapping[str, float]

OURS, BASELINE = "lookstep", "paper"
_JSON_STAGES = ("depth", "depth_noise", "extract", "memory", "lidar", "height_map")
_PARTS = ("patches", "growing", "refinement", "polygons")


@dataclass(frozen=True, slots=True)
class Extent:
    """How much is measured.

    Attributes:
        scenes: of each kind, judged with each noise.
        frames: of the walk.
        duration: of the walk, at most [s].
    """

    scenes: int
    frames: int
    duration: float


FULL, QUICK = Extent(50, 200, 60.0), Extent(3, 30, 6.0)


@dataclass(frozen=True, slots=True)
class PerceptionReport:
    """Figures of perception.

    Attributes:
        quality: by method, scene and noise.
        seeds: of the scenes.
        times: of every stage.
        frames: on which those were taken.
        walk_seed: of the walk that they come from.
    """

    quality: Mapping[tuple[str, str, str], Figures]
    seeds: range
    times: StageTimes
    frames: int
    walk_seed: int

    def as_json(self) -> dict[str, Any]:
        """The figures under the names that programs read."""
        times, wall = self.times.by_stage(), self.times.by_stage(wall=True)
        return {
            **{f"{stage}_ms": _json_timing(times[stage]) for stage in _JSON_STAGES},
            "extract_parts_ms": {part: _json_timing(times[part]) for part in _PARTS},
            "baseline_ms": _json_timing(times["baseline"]),
            "baseline_ratio": round(baseline_ratio(times), 3),
            "wall_ms": {stage: _json_timing(timing) for stage, timing in wall.items()},
            "quality": self._json_quality(OURS, "scattered"),
            "contiguous": self._json_quality(OURS, "contiguous"),
            "baseline_quality": self._json_quality(BASELINE, "scattered"),
            "baseline_contiguous": self._json_quality(BASELINE, "contiguous"),
            "seeds": {"scenes": [self.seeds.start, self.seeds.stop - 1], "walk": self.walk_seed},
            "scenes": len(self.seeds),
            "frames": self.frames,
            "machine": machine(),
            "versions": installed_versions(),
        }

    def tables(self) -> Sequence[Table]:
        """Times, quality on both kinds of scenes, and the ground of the contiguous one."""
        return [
            self._time_table(),
            *(self._quality_table(scene) for scene in SCENES),
            self._ground_table(),
        ]

    def _json_quality(self, method: str, scene: str) -> dict[str, dict[str, float | None]]:
        return {noise: _plain(self.quality[method, scene, noise]) for noise in NOISES}

    def _time_table(self) -> Table:
        times, wall = self.times.by_stage(), self.times.by_stage(wall=True)
        title = f"time on one core [ms], {self.frames} frames of a walk over the rough course"
        about = machine()
        caption = (
            f"the paper's method takes {baseline_ratio(times):.2f} x as long; "
            f"{about['processor']}, {about['cores']} cores"
        )
        table = _table(title, ("stage",), ("median", "p99", "wall median", "wall p99"), caption)
        for stage, name in STAGES.items():
            both = (times[stage], wall[stage])
            table.add_row(name, *(f"{value:.2f}" for timing in both for value in (timing.median_ms, timing.p99_ms)))
        return table

    def _quality_table(self, scene: str) -> Table:
        faces = next(figures["faces"] for (_, name, _), figures in self.quality.items() if name == scene)
        title = f"{scene}: {faces:.0f} planar faces in {len(self.seeds)} scenes not used for tuning"
        columns = ("recall", "IoU", "normal [deg]", "offset [mm]", "false")
        table = _table(title, ("noise", "method"), columns, "normal and offset: median / 90 %; false: share of area")
        for noise, method, figures in self._rows(scene):
            table.add_row(
                noise,
                method,
                f"{figures['recall']:.3f}",
                f"{figures['iou']:.3f}",
                f"{figures['normal_deg_median']:.2f} / {figures['normal_deg_p90']:.2f}",
                f"{figures['offset_mm_median']:.2f} / {figures['offset_mm_p90']:.2f}",
                f"{figures['false_area']:.1%}",
            )
        return table

    def _ground_table(self) -> Table:
        title = "contiguous: cells of ground within 2 m"
        table = _table(title, ("noise", "method"), ("covered", "> 15 mm off", "> 5 deg off"))
        for noise, method, figures in self._rows("contiguous"):
            shares = (figures["coverage"], figures["wrong_height"], figures["wrong_slope"])
            table.add_row(noise, method, *(f"{share:.2%}" for share in shares))
        return table

    def _rows(self, scene: str) -> list[tuple[str, str, Figures]]:
        return [(noise, method, self.quality[method, scene, noise]) for noise in NOISES for method in (OURS, BASELINE)]


def bench_perception(extent: Extent, progress: Progress) -> PerceptionReport:
    """Judge regions on scenes that were not used for tuning, and time every stage on the frames of a walk."""
    configuration = load_configuration()
    seeds = HELD_OUT_SEEDS[: extent.scenes]
    methods: dict[str, Extractor] = {
        OURS: extractor(configuration.regions),
        BASELINE: baseline_extractor(configuration.regions),
    }
    walked = walk_frames(extent.frames, extent.duration, seeds[0], progress)
    times = time_stages(walked, configuration, progress)
    quality = compare_methods(methods, seeds, configuration.regions.depth_max, progress)
    return PerceptionReport(quality, seeds, times, len(walked.frames), walked.seed)


def _table(title: str, names: Sequence[str], columns: Sequence[str], caption: str = "") -> Table:
    # As Text, because a unit in brackets would be taken for markup.
    table = Table(
        title=Text(title), caption=Text(caption), title_justify="left", caption_justify="left",
        box=SIMPLE, pad_edge=False, collapse_padding=True,
    )  # fmt: skip
    for name in names:
        table.add_column(Text(name), no_wrap=True)
    for name in columns:
        table.add_column(Text(name), justify="right", no_wrap=True)
    return table


def _json_timing(timing: Timing) -> dict[str, float]:
    return {"median": timing.median_ms, "p99": timing.p99_ms}


def _plain(figures: Figures) -> dict[str, float | None]:
    """Figures that JSON can hold, without more digits than they are worth."""
    return {name: None if math.isnan(value) else float(f"{value:.6g}") for name, value in figures.items()}
