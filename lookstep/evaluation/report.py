"""What the walks of an evaluation add up to: success with intervals, every failure, the paper's tables."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from rich.table import Table
from rich.text import Text

from lookstep.bench.machine import machine
from lookstep.evaluation import paper_tables
from lookstep.evaluation.run_row import RunRow
from lookstep.evaluation.suite import Case
from lookstep.summary import Summary, installed_versions
from lookstep.wilson_interval import wilson_interval

_NONE = "-"


@dataclass(frozen=True, slots=True)
class Group:
    """The walks of one case in one world.

    Attributes:
        case: the case.
        world: kind of simulation.
        rows: one a seed.
    """

    case: Case
    world: str
    rows: tuple[RunRow, ...]

    @property
    def failures(self) -> list[tuple[RunRow, str]]:
        """Walks that did not go as they should, and why."""
        judged = [(row, why_failed(row, self.case)) for row in self.rows]
        return [(row, why) for row, why in judged if why]

    @property
    def ok(self) -> int:
        """Number of walks that went as they should."""
        return len(self.rows) - len(self.failures)

    @property
    def missed(self) -> bool:
        """Whether more walks failed than may."""
        may_fail = self.case.may_fail.in_world(self.world)
        return may_fail is not None and len(self.failures) > may_fail

    @property
    def summaries(self) -> list[Summary]:
        """Of the walks that did not break off."""
        return [row.summary for row in self.rows if row.summary is not None]

    @property
    def pauses(self) -> dict[str, int]:
        """Number of pauses by cause."""
        counts: Counter[str] = Counter()
        for summary in self.summaries:
            counts.update(summary.pauses.causes)
        return dict(sorted(counts.items()))

    @property
    def speed(self) -> float | None:
        """Mean speed of the walks that succeeded, from the first lift-off to the last touchdown [m/s]."""
        return _mean(row.summary.walking_speed_mps for row in self._succeeded if row.summary is not None)

    @property
    def first_transfer(self) -> float | None:
        """Longest time from the goal to the first transfer [s]."""
        return max(_known(summary.first_transfer_after_s for summary in self.summaries), default=None)

    @property
    def least_support(self) -> float | None:
        """Least share of a stance sole on true ground."""
        return min(_known(summary.min_support_fraction for summary in self.summaries), default=None)

    @property
    def _succeeded(self) -> list[RunRow]:
        return [row for row in self.rows if not why_failed(row, self.case)]

    def as_json(self) -> dict[str, Any]:
        """The figures under the names that programs read."""
        low, high = wilson_interval(self.ok, len(self.rows))
        return {
            "ok": self.ok,
            "of": len(self.rows),
            "low": round(low, 4),
            "high": round(high, 4),
            "may_fail": self.case.may_fail.in_world(self.world),
            "missed": self.missed,
            "walking_speed_mps": None if self.speed is None else round(self.speed, 4),
            "first_transfer_after_s_most": self.first_transfer,
            "min_support_fraction": self.least_support,
            "pauses": self.pauses,
            "failures": [
                {"seed": row.options.seed, "outcome": row.outcome.value, "why": why} for row, why in self.failures
            ],
            "durations": paper_tables.durations_as_json(self.summaries),
            "runs": paper_tables.run_means(self.summaries),
        }


def why_failed(row: RunRow, case: Case) -> str:
    """Why a walk did not go as its case wants; empty where it did."""
    if row.outcome not in case.ends:
        return row.reason if row.reason.startswith(row.outcome.value) else f"{row.outcome.value}: {row.reason}"
    reactive = 0 if row.summary is None else row.summary.steps.reactive
    if reactive < case.least_reactive:
        return f"{reactive} reactive steps, needs {case.least_reactive}"
    return ""


@dataclass(frozen=True, slots=True)
class EvaluationReport:
    """Figures of an evaluation.

    Attributes:
        about: what was evaluated, one line.
        groups: by case and world.
        workers: processes that walked at the same time.
    """

    about: str
    groups: Sequence[Group]
    workers: int

    @property
    def missed(self) -> bool:
        """Whether a case has more failures than it may."""
        return any(group.missed for group in self.groups)

    def as_json(self) -> dict[str, Any]:
        """The figures under the names that programs read."""
        cases: dict[str, dict[str, Any]] = {}
        for group in self.groups:
            cases.setdefault(group.case.name, {})[group.world] = group.as_json()
        return {
            "cases": cases,
            "missed": self.missed,
            "code": sorted({row.code for group in self.groups for row in group.rows}),
            "workers": self.workers,
            "machine": machine(),
            "versions": installed_versions(),
        }

    def tables(self) -> Sequence[Table]:
        """The figures for people."""
        groups = [(group.case, group.world, group.summaries) for group in self.groups]
        return (
            self._success_table(),
            *self._failure_table(),
            paper_tables.duration_table(groups),
            paper_tables.run_table(groups),
        )

    def _success_table(self) -> Table:
        codes = len({row.code for group in self.groups for row in group.rows})
        caption = (
            "95 % intervals by Wilson; speed: mean of the walks that succeeded, straight way from the first lift-off "
            "to the last touchdown over the time between; transfer: longest time from the goal until weight shifts "
            "for the first step; support: least share of a stance sole on true ground at mid-swing"
        )
        if codes > 1:
            caption += f"; made by {codes} versions of the code"
        numbers = ("ok", "95 %", "may fail", "speed [m/s]", "transfer [s]", "support", "pauses")
        table = paper_tables.figure_table(self.about or "Walks", caption, ("case", "world"), numbers)
        for group in self.groups:
            low, high = wilson_interval(group.ok, len(group.rows))
            may_fail = group.case.may_fail.in_world(group.world)
            table.add_row(
                group.case.name,
                group.world,
                f"{group.ok}/{len(group.rows)}",
                f"{100 * low:.0f}-{100 * high:.0f} %",
                _NONE if may_fail is None else str(may_fail),
                _number(group.speed, 3),
                _number(group.first_transfer, 2),
                _number(group.least_support, 2),
                ", ".join(f"{cause} {count}" for cause, count in group.pauses.items()) or "0",
            )
        return table

    def _failure_table(self) -> tuple[Table, ...]:
        """What went wrong, where something did."""
        failed = [(group, row, why) for group in self.groups for row, why in group.failures]
        if not failed:
            return ()
        table = paper_tables.figure_table("Failures", "", ("case", "world", "why"), ("seed", "steps", "came [m]"))
        for group, row, why in failed:
            summary = row.summary
            table.add_row(
                group.case.name,
                group.world,
                Text(why),
                str(row.options.seed),
                _NONE if summary is None else str(summary.steps.total),
                _NONE if summary is None else f"{summary.distance_m:.1f}",
            )
        return (table,)


def _known(values: Iterable[float | None]) -> list[float]:
    return [value for value in values if value is not None]


def _mean(values: Iterable[float | None]) -> float | None:
    known = _known(values)
    return float(np.mean(known)) if known else None


def _number(value: float | None, digits: int) -> str:
    return _NONE if value is None else f"{value:.{digits}f}"
