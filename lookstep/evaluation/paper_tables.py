"""The paper's two tables with ours beside them: durations of the parts, and statistics of runs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from rich.table import Table
from rich.text import Text

from lookstep.evaluation.paper import PART_DURATIONS, ROBOT_RUNS, PartDuration
from lookstep.evaluation.suite import Case
from lookstep.summary import SkillTiming, Summary

_PARTS = {"regions": "Rapid regions", "plan": "Footstep planning"}
_TERRAINS = {"uneven_flat": "Uneven flat", "rough": "Rough"}
_NONE = "-"

Walks = tuple[Case, str, list[Summary]]
"""A case, a world, and the figures of its walks."""


def duration_of(part: str, summaries: Sequence[Summary]) -> PartDuration | None:
    """Mean and standard deviation of a part over all computations of some walks [s]; None where there was none."""
    timings: list[SkillTiming] = [getattr(summary, part) for summary in summaries]
    rows = [(t.count, t.mean_ms, t.sd_ms) for t in timings if t.mean_ms is not None and t.sd_ms is not None]
    if not rows:
        return None
    counts, means, deviations = np.array(rows).T
    mean = np.average(means, weights=counts)
    # Of all computations: the walks' variances, and how far their means lie apart.
    variance = np.average(deviations**2 + (means - mean) ** 2, weights=counts)
    return PartDuration(1e-3 * float(mean), 1e-3 * float(np.sqrt(variance)))


def durations_as_json(summaries: Sequence[Summary]) -> dict[str, Any]:
    """Mean and standard deviation by part [s]."""
    durations = {part: duration_of(part, summaries) for part in _PARTS}
    return {
        part: None if it is None else {"mean_s": round(it.mean, 6), "sd_s": round(it.sd, 6)}
        for part, it in durations.items()
    }


def run_means(summaries: Sequence[Summary]) -> dict[str, float] | None:
    """Mean of each column of the run statistics; step length is distance over steps, as in the paper."""
    if not summaries:
        return None
    steps = [summary.steps for summary in summaries]
    figures = {
        "steps": [it.total for it in steps],
        "flat": [it.flat for it in steps],
        "uneven_flat": [it.uneven_flat for it in steps],
        "rough": [it.rough for it in steps],
        "ramp": [it.ramp for it in steps],
        "reactive": [it.reactive for it in steps],
        "duration_s": [summary.duration_s for summary in summaries],
        "distance_m": [summary.distance_m for summary in summaries],
        "speed_mps": [summary.speed_mps for summary in summaries],
        "step_length_m": [summary.distance_m / max(summary.steps.total, 1) for summary in summaries],
    }
    return {name: round(float(np.mean(values)), 4) for name, values in figures.items()}


def duration_table(walks: Sequence[Walks]) -> Table:
    """Table I of the paper, and ours below each of its lines."""
    ours = {
        (case.course, world): summaries
        for case, world, summaries in walks
        if case.course in _TERRAINS and not _changed(case) and summaries
    }
    steps = [summary.steps.total for summaries in ours.values() for summary in summaries]
    caption = "mean and standard deviation of the wall time of one computation; the paper: 22-step walks in simulation"
    if steps:
        caption += f"; ours: {len(steps)} walks of {np.mean(steps):.0f} steps in the mean"
    table = figure_table("Durations of the parts [s]", caption, ("part", "of"), tuple(_TERRAINS.values()))
    for part, title in _PARTS.items():
        table.add_row(title, "paper", *(_duration(PART_DURATIONS[part][terrain]) for terrain in _TERRAINS))
        for world in dict.fromkeys(world for _, world in ours):
            cells = (duration_of(part, ours.get((terrain, world), [])) for terrain in _TERRAINS)
            table.add_row(title, f"lookstep, {world}", *map(_duration, cells))
    return table


def run_table(walks: Sequence[Walks]) -> Table:
    """Table II of the paper, and the means of our walks below it."""
    caption = (
        "reactive steps are counted among the others, too; the paper has no ramps; time from the goal to "
        "standing; m/s: way over time; m/step: way over steps; the paper: single runs of a real robot; ours: means "
        "of simulated walks"
    )
    names = ("steps", "flat", "uneven flat", "rough", "ramp", "reactive", "time [s]", "way [m]", "m/s", "m/step")
    table = figure_table("Statistics of runs", caption, ("run",), names)
    for number, run in enumerate(ROBOT_RUNS, 1):
        table.add_row(
            f"paper {number}",
            *(str(count) for count in (run.steps, run.flat, run.uneven_flat, run.rough)),
            _NONE,
            str(run.reactive),
            f"{run.duration:.0f}",
            f"{run.distance:.1f}",
            f"{run.speed:.3f}",
            f"{run.step_length:.3f}",
        )
    for case, world, summaries in walks:
        means = run_means(summaries)
        if means is None:
            continue
        counts = ("steps", "flat", "uneven_flat", "rough", "ramp", "reactive")
        table.add_row(
            f"{case.name}, {world}, {len(summaries)}",
            *(f"{means[name]:.1f}" for name in counts),
            f"{means['duration_s']:.1f}",
            f"{means['distance_m']:.1f}",
            f"{means['speed_mps']:.3f}",
            f"{means['step_length_m']:.3f}",
        )
    return table


def figure_table(title: str, caption: str, texts: Sequence[str], numbers: Sequence[str]) -> Table:
    """An empty table with columns of texts, then of numbers; brackets in names are units, not markup."""
    table = Table(title=Text(title), title_justify="left", caption=Text(caption), caption_justify="left")
    for name in texts:
        table.add_column(Text(name), overflow="fold")
    for name in numbers:
        table.add_column(Text(name), justify="right", overflow="fold")
    return table


def _changed(case: Case) -> bool:
    """Whether the ground is not that of the course by default; a shorter one is."""
    return any(text.startswith("course.") and not text.startswith("course.rows=") for text in case.set)


def _duration(duration: PartDuration | None) -> str:
    return _NONE if duration is None else f"{duration.mean:.4f} ± {duration.sd:.4f}"
