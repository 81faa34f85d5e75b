"""The figures of `lookstep bench walking`, for people and for programs."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from rich.table import Table

from lookstep.bench.machine import machine
from lookstep.bench.walking.cases import Case
from lookstep.bench.walking.maps import WalkingMap
from lookstep.bench.walking.solvers import SolverFigures
from lookstep.bench.walking.tick_times import RealtimeFactor, TickTimes
from lookstep.bench.walking.trial import TrialResult
from lookstep.summary import installed_versions
from lookstep.wilson_interval import wilson_interval


@dataclass(frozen=True, slots=True)
class Success:
    """How often a case succeeded.

    Attributes:
        case: the case.
        results: of its trials, by seed.
    """

    case: Case
    results: Sequence[TrialResult]

    @property
    def ok(self) -> int:
        """Number of trials in which the robot made all steps and then stood."""
        return sum(result.ok for result in self.results)

    @property
    def landing_rms(self) -> float:
        """Root mean square of the horizontal distance of landed soles from their footholds [m]."""
        errors = [error for result in self.results if result.ok for error in result.landing_errors]
        return float(np.sqrt(np.mean(np.square(errors)))) if errors else float("nan")

    @property
    def dcm_error(self) -> float:
        """Median over trials of the largest distance of the DCM from its plan [m]."""
        return float(np.median([result.dcm_error for result in self.results]))

    def as_json(self) -> dict[str, Any]:
        """The figures under the names that programs read."""
        low, high = wilson_interval(self.ok, len(self.results))
        rms = self.landing_rms
        return {
            "ok": self.ok,
            "of": len(self.results),
            "low": round(low, 4),
            "high": round(high, 4),
            "wanted": self.case.wanted,
            "landing_rms_m": None if np.isnan(rms) else round(rms, 5),
            "dcm_error_m": round(self.dcm_error, 4),
            "steps": sum(result.steps for result in self.results),
            "failures": [
                {"seed": result.seed, "steps": result.steps, "why": result.failure}
                for result in self.results
                if not result.ok
            ],
        }


@dataclass(frozen=True, slots=True)
class WalkingReport:
    """Figures of the walking controller.

    Attributes:
        successes: by case.
        ticks: compute times of ticks.
        realtime: of both worlds.
        solvers: side by side.
        maps: of pushes and of speeds, where asked for.
    """

    successes: Sequence[Success]
    ticks: TickTimes
    realtime: Sequence[RealtimeFactor]
    solvers: Sequence[SolverFigures]
    maps: Sequence[WalkingMap] = ()

    def as_json(self) -> dict[str, Any]:
        """The figures under the names that programs read."""
        return {
            **self.ticks.as_json(),
            "realtime_factor": {factor.world: factor.factor for factor in self.realtime},
            "success": {success.case.name: success.as_json() for success in self.successes},
            "solvers": {figures.name: figures.as_json() for figures in self.solvers},
            **{walking_map.name: walking_map.as_json() for walking_map in self.maps},
            "machine": machine(),
            "versions": installed_versions(),
        }

    def tables(self) -> Sequence[Table]:
        """The figures for people."""
        return (
            _success_table(self.successes),
            *_failure_table(self.successes),
            _tick_table(self.ticks, self.realtime),
            _solver_table(self.solvers),
            *(walking_map.table() for walking_map in self.maps),
        )


def successes_of(cases: Iterable[Case], results: Iterable[TrialResult]) -> list[Success]:
    """Results by case, in the order of their seeds."""
    by_case: Mapping[str, list[TrialResult]] = defaultdict(list)
    for result in results:
        by_case[result.case].append(result)
    return [Success(case, sorted(by_case[case.name], key=lambda result: result.seed)) for case in cases]


def _success_table(successes: Sequence[Success]) -> Table:
    caption = (
        "ok: all steps were made and the robot then stood; 95 % intervals by Wilson; "
        "RMS: landed soles from their footholds; DCM: largest error of a trial, median"
    )
    table = _table("Walking over known footsteps in physics", caption, ("case", "what"))
    table.columns[0].no_wrap = True
    for name in ("ok", "95 %", "goal", "RMS [mm]", "DCM [mm]"):
        table.add_column(name, justify="right")
    for success in successes:
        low, high = wilson_interval(success.ok, len(success.results))
        table.add_row(
            success.case.name,
            success.case.meaning,
            f"{success.ok}/{len(success.results)}",
            f"{100 * low:.0f}-{100 * high:.0f} %",
            f"{100 * success.case.wanted:.0f} %",
            "-" if np.isnan(success.landing_rms) else f"{1e3 * success.landing_rms:.1f}",
            f"{1e3 * success.dcm_error:.0f}",
        )
    return table


def _failure_table(successes: Sequence[Success]) -> tuple[Table, ...]:
    """What went wrong, where something did."""
    failed = [(success, result) for success in successes for result in success.results if not result.ok]
    if not failed:
        return ()
    table = _table("Failures", "", ("case", "seed", "steps made", "why"))
    for success, result in failed:
        table.add_row(success.case.name, str(result.seed), str(result.steps), result.failure)
    return (table,)


def _tick_table(ticks: TickTimes, realtime: Sequence[RealtimeFactor]) -> Table:
    factors = ", ".join(f"{it.world} at {it.rate:g} Hz {it.factor:.1f}" for it in realtime)
    caption = (
        f"{ticks.ticks} ticks, time of the thread; median by the calibration kernel: {ticks.ratio:.2f}; "
        f"times real time: {factors}"
    )
    table = _table("One tick of the controller", caption, ("part",))
    for name in ("median [ms]", "p99 [ms]"):
        table.add_column(name, justify="right")
    rows = {"tick": ticks.tick, **ticks.parts, "calibration kernel": ticks.calibration}
    for name, timing in rows.items():
        table.add_row(name.replace("_", " "), f"{timing.median_ms:.3f}", f"{timing.p99_ms:.3f}")
    return table


def _solver_table(solvers: Sequence[SolverFigures]) -> Table:
    caption = "errors are distances from DAQP's solution: accelerations as the objective weighs them, net ground force"
    table = _table("Solvers on the programs of a walk", caption, ("solver",))
    for name in ("median [ms]", "p99 [ms]", "task p50 [m/s^2]", "p99", "force p50 [N]", "p99", "failed"):
        table.add_column(name, justify="right")
    for it in solvers:
        errors = (f"{error:.2g}" for error in (*it.task_error, *it.force_error))
        table.add_row(it.name, f"{it.timing.median_ms:.3f}", f"{it.timing.p99_ms:.3f}", *errors, str(it.failed))
    return table


def _table(title: str, caption: str, columns: Sequence[str]) -> Table:
    table = Table(title=title, title_justify="left", caption=caption or None, caption_justify="left")
    for column in columns:
        table.add_column(column)
    return table
