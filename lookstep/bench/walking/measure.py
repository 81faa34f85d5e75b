"""Runs the benchmark: trials of every case, maps where asked for, times and solvers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from lookstep.bench.subject import Progress
from lookstep.bench.walking.cases import CASES, DEFAULT, Case
from lookstep.bench.walking.known_walks import KnownWalk, block_walk
from lookstep.bench.walking.maps import maps_of, push_map_trials, speed_map_trials
from lookstep.bench.walking.report import WalkingReport, successes_of
from lookstep.bench.walking.solvers import compare_solvers, log_programs
from lookstep.bench.walking.tick_times import measure_realtime, measure_ticks
from lookstep.bench.walking.trial import Trial, run_trial
from lookstep.configuration import Configuration
from lookstep.process_pool import run_in_processes

_MAP_SEEDS = 3
_LEVELS, _TILT = (0.0, 0.1), float(np.deg2rad(15.0))  # of the blocks on which times are measured


@dataclass(frozen=True, slots=True)
class Extent:
    """How much is measured.

    Attributes:
        seeds: most trials of a case; None for as many as it asks for.
        steps: of every walk; None for the case's own.
        ticks: that are timed.
        realtime_steps: of the walk that is compared with real time.
        programs: that solvers solve.
    """

    seeds: int | None
    steps: int | None
    ticks: int
    realtime_steps: int
    programs: int


FULL = Extent(seeds=None, steps=None, ticks=20_000, realtime_steps=24, programs=2_000)
QUICK = Extent(seeds=1, steps=4, ticks=1_500, realtime_steps=4, programs=200)


def bench_walking(
    extent: Extent,
    configuration: Configuration,
    progress: Progress,
    *,
    cases: Sequence[str] = (),
    workers: int = 1,
    push_map: bool = False,
    speed_map: bool = False,
) -> WalkingReport:
    """Measure the walking controller.

    Args:
        extent: how much.
        configuration: of robot, world and controller.
        progress: is told how far it is.
        cases: by name; all where there are none.
        workers: processes that walk at the same time.
        push_map: whether to make the map of pushes.
        speed_map: whether to make the map of speeds.
    """
    chosen = [CASES[name] for name in (cases or CASES)]
    trials = [trial for case in chosen for trial in _trials_of(case, extent)]
    # Times first: nothing else of ours runs then.
    progress("timing ticks", 0, len(trials) + 3)
    ticks = measure_ticks(_timed_walks(), configuration, extent.ticks)
    progress("comparing with real time", 1, len(trials) + 3)
    walk = block_walk(extent.realtime_steps, DEFAULT, np.random.default_rng(0), levels=_LEVELS, tilt=_TILT)
    realtime = [measure_realtime(walk, configuration, kind) for kind in ("physics", "kinematic")]
    progress("comparing solvers", 2, len(trials) + 3)
    solvers = compare_solvers(log_programs(walk, configuration, extent.programs), configuration.whole_body)
    if push_map:
        trials += push_map_trials()
    if speed_map:
        trials += speed_map_trials(_MAP_SEEDS)
    results = []
    for result in run_in_processes(partial(run_trial, configuration=configuration), trials, workers):
        results.append(result)
        progress(f"walking: {result.case}", len(results) + 3, len(trials) + 3)
    return WalkingReport(successes_of(chosen, results), ticks, realtime, solvers, maps_of(results))


def _trials_of(case: Case, extent: Extent) -> list[Trial]:
    seeds = case.seeds if extent.seeds is None else min(extent.seeds, case.seeds)
    return [case.trial(seed, extent.steps) for seed in range(seeds)]


def _timed_walks() -> Iterator[KnownWalk]:
    seed = 0
    while True:
        yield block_walk(24, DEFAULT, np.random.default_rng(seed), levels=_LEVELS, tilt=_TILT)
        seed += 1
