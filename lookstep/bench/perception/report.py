"""The figures of `lookstep bench perception`, gathered, for people and for programs."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from rich.table import Table

from lookstep.bench.perception.measure import Extractor, extractor, frame_figures, judge_frame, true_frame
from lookstep.bench.perception.scenes import HELD_OUT_SEEDS, NOISES, SCENES
from lookstep.bench.subject import Progress
from lookstep.summary import installed_versions
from skills.regions import RegionParameters

Figures = Mapping[str, float]

_QUALITY_COLUMNS = {
    "recall": ("recall", ".3f"),
    "iou": ("IoU", ".3f"),
    "normal_deg_median": ("normal [deg]", ".2f"),
    "normal_deg_p90": ("90 %", ".2f"),
    "offset_mm_median": ("offset [mm]", ".2f"),
    "offset_mm_p90": ("90 %", ".2f"),
    "false_area": ("false area", ".1%"),
}
_GROUND_COLUMNS = {
    "coverage": ("covered", ".1%"),
    "wrong_height": ("> 15 mm off", ".2%"),
    "wrong_slope": ("> 5 deg off", ".2%"),
}


@dataclass(frozen=True, slots=True)
class PerceptionReport:
    """Figures of perception.

    Attributes:
        quality: by method, scene and noise.
        seeds: of the scenes.
    """

    quality: Mapping[tuple[str, str, str], Figures]
    seeds: range

    def as_json(self) -> dict[str, Any]:
        """The figures under the names that programs read."""
        ours = {(scene, noise): _plain(self.quality["lookstep", scene, noise]) for scene in SCENES for noise in NOISES}
        return {
            "quality": {noise: ours["scattered", noise] for noise in NOISES},
            "contiguous": {noise: ours["contiguous", noise] for noise in NOISES},
            "seeds": [self.seeds.start, self.seeds.stop - 1],
            "versions": installed_versions(),
        }

    def tables(self) -> Sequence[Table]:
        """One table of quality a scene."""
        return [self._quality_table(scene) for scene in SCENES]

    def _quality_table(self, scene: str) -> Table:
        columns = _QUALITY_COLUMNS | (_GROUND_COLUMNS if scene == "contiguous" else {})
        some = next(figures for (_, name, _), figures in self.quality.items() if name == scene)
        table = Table(title=f"{scene}: {some['faces']:.0f} faces in {len(self.seeds)} scenes", title_justify="left")
        table.add_column("noise")
        table.add_column("method")
        for header, _ in columns.values():
            table.add_column(header, justify="right")
        for (method, name, noise), figures in self.quality.items():
            if name == scene:
                cells = (format(figures[column], form) for column, (_, form) in columns.items())
                table.add_row(noise, method, *cells)
        return table


def bench_perception(frames: int, progress: Progress) -> PerceptionReport:
    """Judge regions on this many scenes of each kind."""
    seeds = HELD_OUT_SEEDS[:frames]
    return PerceptionReport(_quality({"lookstep": extractor()}, seeds, progress), seeds)


def _quality(
    extractors: Mapping[str, Extractor], seeds: range, progress: Progress
) -> dict[tuple[str, str, str], Figures]:
    """Figures by method, scene and noise; every method sees the same images."""
    depth_max = RegionParameters().depth_max
    judged: dict[tuple[str, str, str], Any] = {}
    for scene in SCENES:
        for index, seed in enumerate(seeds):
            progress(f"judging regions of {scene} scenes", index, len(seeds))
            frame = true_frame(scene, seed, depth_max)
            for noise in NOISES:
                for method, extract in extractors.items():
                    judged.setdefault((method, scene, noise), []).append(judge_frame(extract, frame, noise))
    return {key: frame_figures(frames) for key, frames in judged.items()}


def _plain(figures: Figures) -> dict[str, float | None]:
    """Figures that JSON can hold, without more digits than they are worth."""
    return {name: None if math.isnan(value) else float(f"{value:.6g}") for name, value in figures.items()}
