"""The figures of `lookstep bench footsteps`: every map, then plans of three steps; for people and for programs."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.table import Table

from lookstep.bench.footsteps.map_figures import MapFigures, measure_map
from lookstep.bench.footsteps.plan_picture import write_plan_picture
from lookstep.bench.footsteps.three_steps import measure_three_steps
from lookstep.bench.subject import Progress
from lookstep.bench.timing import Timing
from lookstep.errors import UserError
from skills.footsteps import FootstepParameters, TerrainParameters, whole_sole
from skills.footsteps.region_map import RegionMapError, map_files, read_region_map

DATA_VARIABLE = "LOOKSTEP_DATA"
_REPEATS, _QUICK_REPEATS = 20, 3


@dataclass(frozen=True, slots=True)
class FootstepReport:
    """Figures of the footstep planner.

    Attributes:
        maps: one a map.
        three_steps: time of plans of three steps.
    """

    maps: tuple[MapFigures, ...]
    three_steps: Timing

    @property
    def solved(self) -> int:
        """Number of maps on which both feet end at the goal."""
        return sum(figures.solved for figures in self.maps)

    def as_json(self) -> dict[str, Any]:
        """The figures under the names that programs read."""
        return {
            "solved": self.solved,
            "total": len(self.maps),
            "maps": {figures.region_map.name: figures.as_json() for figures in self.maps},
            "three_step_ms": {"median": self.three_steps.median_ms, "p99": self.three_steps.p99_ms},
        }

    def tables(self) -> tuple[Table]:
        """The figures for people."""
        title = f"{self.solved} of {len(self.maps)} maps solved"
        caption = f"three steps: median {self.three_steps.median_ms:.2f} ms, p99 {self.three_steps.p99_ms:.2f} ms"
        table = Table(title=title, title_justify="left", caption=caption, caption_justify="left")
        for name in ("map", "outcome"):
            table.add_column(name)
        for name in ("steps", "cost", "median ms", "p99 ms", "expansions"):
            table.add_column(name, justify="right")
        table.add_column("why not")
        for figures in self.maps:
            plan, timing = figures.plan, figures.timing
            numbers = (len(plan.steps), f"{plan.cost:.2f}", f"{timing.median_ms:.1f}", f"{timing.p99_ms:.1f}")
            table.add_row(
                figures.region_map.name, plan.outcome.value, *(str(n) for n in numbers), str(plan.expansions),
                plan.reason,
            )  # fmt: skip
        return (table,)


def bench_footsteps(
    data: Path | None,
    parameters: FootstepParameters,
    terrain_parameters: TerrainParameters,
    progress: Progress,
    *,
    quick: bool = False,
    pictures: Path | None = None,
) -> FootstepReport:
    """Measure the footstep planner.

    Args:
        data: folder with planar-region maps; None for the one that LOOKSTEP_DATA names.
        parameters: limits, costs and search settings.
        terrain_parameters: how regions become ground.
        progress: is told how far it is.
        quick: few repeats.
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
    measured = []
    for region_map in region_maps:
        progress(region_map.name, len(measured), len(region_maps) + 1)
        figures = measure_map(region_map, parameters, terrain_parameters, repeats)
        measured.append(figures)
        if pictures is not None:
            file = pictures / f"{region_map.name}.png"
            write_plan_picture(file, region_map, figures.stance, figures.plan, whole_sole(parameters))
    progress("three steps", len(measured), len(region_maps) + 1)
    return FootstepReport(tuple(measured), measure_three_steps(parameters, terrain_parameters, repeats))


def _data_folder() -> Path:
    folder = os.environ.get(DATA_VARIABLE)
    if folder is None:
        raise UserError(f"--data: not given, and {DATA_VARIABLE} is not set; needs a folder of planar-region maps")
    return Path(folder)
