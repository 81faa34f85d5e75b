"""The figures of `lookstep bench body_path`."""

from __future__ import annotations

import dataclasses
import time
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from rich.table import Table

from lookstep.bench.body_path.compare import Trial, longest_search
from lookstep.bench.body_path.random_maps import RandomMap, random_map
from lookstep.bench.body_path.wall_check import touches
from lookstep.bench.machine import machine
from lookstep.bench.subject import Progress
from lookstep.bench.timing import Timing
from lookstep.summary import installed_versions
from skills.body_path import BodyPathParameters, PathEnd, PathPlan, PathRequest, plan_body_path

_MARGIN = 0.1  # The judge's body is so much smaller than the planner's, which counts whole cells [m].


@dataclass(frozen=True, slots=True)
class Extent:
    """How much is measured.

    Attributes:
        maps: on which planners are compared.
        seconds: that each may search on a map.
        walls: maps on which paths are judged.
    """

    maps: int
    seconds: float
    walls: int


FULL, QUICK = Extent(5, 10.0, 1000), Extent(1, 0.5, 60)


@dataclass(frozen=True, slots=True)
class WallFigures:
    """What became of paths over many maps.

    Attributes:
        paths: how many were planned.
        touched: seeds of the maps on which one leads through an obstacle.
        short: how many end short of the goal.
    """

    paths: int
    touched: tuple[int, ...]
    short: int


@dataclass(frozen=True, slots=True)
class PathReport:
    """Figures of the planners of the body path.

    Attributes:
        extent: how much was measured.
        plan: time of a path; plan_again: of looking again at one that is walked.
        costs: of our paths, by map.
        trials: of the others, by map.
        walls: whether paths touch.
    """

    extent: Extent
    plan: Timing
    plan_again: Timing
    costs: tuple[float, ...]
    trials: tuple[tuple[Trial, ...], ...]
    walls: WallFigures

    @property
    def over_best(self) -> list[float]:
        """Our cost over the least that any planner finds, ours included, by map."""
        pairs = zip(self.costs, self.trials, strict=True)
        return [cost / min(cost, *(trial.cost for trial in trials)) for cost, trials in pairs]

    def as_json(self) -> dict[str, Any]:
        """The figures under the names that programs read."""
        over = self.over_best
        return {
            "plan_ms": {"median": self.plan.median_ms, "p99": self.plan.p99_ms},
            "plan_again_ms": {"median": self.plan_again.median_ms, "p99": self.plan_again.p99_ms},
            "cost_over_best": {"median": round(float(np.median(over)), 4), "most": round(max(over), 4)},
            "planners": {name: _figures(trials, self.costs) for name, trials in self._by_planner()},
            "walls": {
                "maps": self.walls.paths,
                "touched": len(self.walls.touched),
                "seeds": list(self.walls.touched),
                "short": self.walls.short,
            },
            "compared": {"maps": self.extent.maps, "seconds": self.extent.seconds},
            "machine": machine(),
            "versions": installed_versions(),
        }

    def tables(self) -> Sequence[Table]:
        """The figures for people."""
        return self._planners_table(), self._walls_table()

    def _by_planner(self) -> list[tuple[str, list[Trial]]]:
        names = [trial.planner for trial in self.trials[0]]
        return [(name, [trials[i] for trials in self.trials]) for i, name in enumerate(names)]

    def _planners_table(self) -> Table:
        title = f"{len(self.costs)} maps of 10 x 10 m; cost after smoothing, over ours"
        over = self.over_best
        caption = f"ours over the best of all: median {np.median(over):.3f}, most {max(over):.3f}"
        table = Table(title=title, title_justify="left", caption=caption, caption_justify="left")
        table.add_column("planner")
        for name in ("solved", "cost", "least", "time [s]"):
            table.add_column(name, justify="right")
        table.add_row("lattice", str(len(self.costs)), "1.000", "1.000", f"{1e-3 * self.plan.median_ms:.3f}")
        for name, trials in self._by_planner():
            figures = _figures(trials, self.costs)
            median, least = (
                "-" if ratio is None else f"{ratio:.3f}" for ratio in (figures["cost_ratio"], figures["least"])
            )
            table.add_row(name, str(figures["solved"]), median, least, f"{figures['seconds']:.2f}")
        return table

    def _walls_table(self) -> Table:
        table = Table(title="Paths over random maps", title_justify="left")
        for name in ("maps", "through a wall", "short of the goal", "plan [ms]", "p99", "again [ms]", "p99"):
            table.add_column(name, justify="right")
        times = (self.plan.median_ms, self.plan.p99_ms, self.plan_again.median_ms, self.plan_again.p99_ms)
        walls = self.walls
        table.add_row(str(walls.paths), str(len(walls.touched)), str(walls.short), *(f"{time:.1f}" for time in times))
        return table


def _figures(trials: Sequence[Trial], costs: Sequence[float]) -> dict[str, Any]:
    """Of one planner."""
    ratios = [trial.cost / cost for trial, cost in zip(trials, costs, strict=True) if np.isfinite(trial.cost)]
    return {
        "solved": len(ratios),
        "cost_ratio": round(float(np.median(ratios)), 4) if ratios else None,
        "least": round(min(ratios), 4) if ratios else None,
        "seconds": round(float(np.median([trial.seconds for trial in trials])), 3),
    }


def bench_body_path(planners: Sequence[str], extent: Extent, progress: Progress) -> PathReport:
    """Compare planners, and judge paths over many maps."""
    parameters = BodyPathParameters()
    total = extent.maps * len(planners) + extent.walls
    progress("starting OMPL", 0, total)
    first = dataclasses.replace(parameters, planner=planners[0], termination_checks=1)
    plan_body_path(_request(random_map(0), first))
    done, costs, trials = 0, [], []
    for seed in range(extent.maps):
        request = _request(random_map(seed), parameters)
        ours = plan_body_path(request)
        costs.append(ours.cost)
        of_map = []
        for planner in planners:
            progress(planner, done, total)
            of_map.append(longest_search(planner, request, extent.seconds, ours))
            done += 1
        trials.append(tuple(of_map))
    times: list[float] = []
    times_again: list[float] = []
    touched, short = [], 0
    for seed in range(extent.walls):
        progress("walls", done, total)
        scene = random_map(seed)
        plan, again = _time(scene, parameters, times, times_again)
        short += plan.path is None or plan.path.end is not PathEnd.GOAL
        for path in {plan.path, again.path} - {None}:
            depth, width = parameters.body_depth - _MARGIN, parameters.body_width - _MARGIN
            if path is not None and touches(path, scene.obstacles, depth, width):
                touched.append(seed)
        done += 1
    walls = WallFigures(extent.walls, tuple(sorted(set(touched))), short)
    return PathReport(extent, Timing.of(times), Timing.of(times_again), tuple(costs), tuple(trials), walls)


def _request(scene: RandomMap, parameters: BodyPathParameters) -> PathRequest:
    return PathRequest(scene.height_map, scene.start, scene.goal, parameters)


def _time(
    scene: RandomMap, parameters: BodyPathParameters, times: list[float], times_again: list[float]
) -> tuple[PathPlan, PathPlan]:
    """A path from the start, and one while that is walked."""
    request = _request(scene, parameters)
    plan = _timed(request, times)
    if plan.path is None:
        return plan, plan
    return plan, _timed(dataclasses.replace(request, start=plan.path.at(1.0), walked=plan.path), times_again)


def _timed(request: PathRequest, times: list[float]) -> PathPlan:
    """In time of the thread: other programs on the machine do not count."""
    started = time.thread_time()
    plan = plan_body_path(request)
    times.append(time.thread_time() - started)
    return plan
