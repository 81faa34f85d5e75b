"""The figures of `lookstep bench footsteps`: every map with two feet, then plans in walks."""

from __future__ import annotations

import dataclasses
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rich.table import Table

from lookstep.bench.footsteps.loop_plans import LoopFigures, measure_loop
from lookstep.bench.footsteps.map_figures import MapFigures, measure_map
from lookstep.bench.footsteps.plan_picture import write_plan_picture
from lookstep.bench.subject import Progress
from lookstep.configuration import Configuration
from lookstep.errors import UserError
from skills.footsteps import whole_sole
from skills.footsteps.region_map import RegionMapError, map_files, read_region_map

DATA_VARIABLE = "LOOKSTEP_DATA"
_REPEATS, _QUICK_REPEATS = 20, 3
_WALKS, _DURATION, _QUICK_DURATION = 5, 120.0, 6.0
_QUICK_CAMERA = ("camera.resolution=0.3125",)
# The foot and the limits with which the reference times were taken.
_SMALL_FOOT = {"sole_length": 0.20, "sole_width": 0.10, "share": 0.9}


@dataclass(frozen=True, slots=True)
class FootstepReport:
    """Figures of the footstep planner.

    Attributes:
        maps: one a map, with our foot.
        small_foot: the same with the foot and the limits of the reference times.
        loop: plans of three steps and more in walks.
    """

    maps: tuple[MapFigures, ...]
    small_foot: tuple[MapFigures, ...]
    loop: LoopFigures

    def as_json(self) -> dict[str, Any]:
        """The figures under the names that programs read."""
        return {
            **_maps_json(self.maps),
            "small_foot": _maps_json(self.small_foot),
            "three_step_ms": self.loop.as_json(),
        }

    def tables(self) -> tuple[Table, ...]:
        """The figures for people."""
        return _maps_table(self.maps, "our foot"), _maps_table(self.small_foot, "small foot"), _loop_table(self.loop)


def _maps_json(maps: tuple[MapFigures, ...]) -> dict[str, Any]:
    return {
        "solved": sum(figures.solved for figures in maps),
        "total": len(maps),
        "times_faster_median": _times_faster(maps),
        "maps": {figures.region_map.name: figures.as_json() for figures in maps},
    }


def _times_faster(maps: tuple[MapFigures, ...]) -> float | None:
    """Median over the maps with a reference time of that time over ours."""
    ratios = [figures.times_faster for figures in maps if figures.times_faster is not None]
    return round(float(np.median(ratios)), 2) if ratios else None


def _maps_table(maps: tuple[MapFigures, ...], foot: str) -> Table:
    title = f"{sum(figures.solved for figures in maps)} of {len(maps)} maps solved, {foot}"
    ratio = _times_faster(maps)
    caption = "" if ratio is None else f"{ratio:.1f} x faster than the reference in the median"
    table = Table(title=title, title_justify="left", caption=caption, caption_justify="left")
    for name in ("map", "outcome"):
        table.add_column(name)
    for name in ("steps", "cost", "median ms", "p99 ms", "expansions", "x faster"):
        table.add_column(name, justify="right")
    table.add_column("why not")
    for figures in maps:
        plan, timing, ratio = figures.plan, figures.timing, figures.times_faster
        numbers = (len(plan.steps), f"{plan.cost:.2f}", f"{timing.median_ms:.1f}", f"{timing.p99_ms:.1f}")
        table.add_row(
            figures.region_map.name, plan.outcome.value, *(str(n) for n in numbers), str(plan.expansions),
            "-" if ratio is None else f"{ratio:.1f}", plan.reason,
        )  # fmt: skip
    return table


def _loop_table(loop: LoopFigures) -> Table:
    table = Table(title="Plans in walks over the rough course, from noisy images", title_justify="left")
    for name in ("plans", "median ms", "p99 ms", "keep steps", "next steps", "moved > 3 cm"):
        table.add_column(name, justify="right")
    share = 100.0 * loop.moved / max(loop.next_steps, 1)
    table.add_row(
        str(loop.plans), f"{loop.timing.median_ms:.2f}", f"{loop.timing.p99_ms:.2f}", str(loop.kept),
        str(loop.next_steps), f"{loop.moved} ({share:.1f} %)",
    )  # fmt: skip
    return table


def bench_footsteps(
    data: Path | None,
    configuration: Configuration,
    assignments: tuple[str, ...],
    progress: Progress,
    *,
    quick: bool = False,
    pictures: Path | None = None,
) -> FootstepReport:
    """Measure the footstep planner.

    Args:
        data: folder with planar-region maps; None for the one that LOOKSTEP_DATA names.
        configuration: limits, costs and search settings.
        assignments: how they were set, for the walks.
        progress: is told how far it is.
        quick: few repeats, a short walk with a small camera.
        pictures: folder for a picture of each plan from above.

    Raises:
        UserError: where there are no maps, or one cannot be read.
    """
    try:
        region_maps = [read_region_map(file) for file in map_files(data or _data_folder())]
    except RegionMapError as error:
        raise UserError(f"--data: {error}") from error
    repeats = _QUICK_REPEATS if quick else _REPEATS
    if pictures is not None:
        pictures.mkdir(parents=True, exist_ok=True)
    feet = (configuration.footsteps, dataclasses.replace(configuration.footsteps, **_SMALL_FOOT))
    measured: list[list[MapFigures]] = [[], []]
    for parameters, figures_of_foot in zip(feet, measured, strict=True):
        for region_map in region_maps:
            progress(region_map.name, sum(map(len, measured)), 2 * len(region_maps) + 1)
            figures = measure_map(region_map, parameters, configuration.terrain, repeats)
            figures_of_foot.append(figures)
            if pictures is not None and parameters is configuration.footsteps:
                file = pictures / f"{region_map.name}.png"
                write_plan_picture(file, region_map, figures.stance, figures.plan, whole_sole(parameters))
    progress("walks", 2 * len(region_maps), 2 * len(region_maps) + 1)
    seeds, duration = (range(1), _QUICK_DURATION) if quick else (range(_WALKS), _DURATION)
    walked = _QUICK_CAMERA if quick else ()
    return FootstepReport(
        tuple(measured[0]), tuple(measured[1]), measure_loop(seeds, duration, repeats, (*walked, *assignments))
    )


def _data_folder() -> Path:
    folder = os.environ.get(DATA_VARIABLE)
    if folder is None:
        raise UserError(f"--data: not given, and {DATA_VARIABLE} is not set; needs a folder of planar-region maps")
    return Path(folder)
