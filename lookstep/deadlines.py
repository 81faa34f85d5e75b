"""Accounts of the leaves that compute: what each may take, what it took, and what was left before the foot landed."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from behaviors import JobOutcome, JobRecord

# A computation that needs more than this share of its budget is in time, but not by much.
TIGHT = 0.8


@dataclass(frozen=True, slots=True, kw_only=True)
class LeafDeadlines:
    """The accounts of one leaf over a run.

    Attributes:
        leaf: its path.
        count: computations that ended with a result; cancelled: those whose leaf was preempted before.
        budget_ms: least of their budgets, the leaf's latency.
        used_ms_median, used_ms_p99, used_ms_most: compute times.
        margin_ms_least: least of budget less compute time; negative where one was missed.
        misses: computations over their budget.
        landing_s_median, landing_s_least: robot time from delivery until the foot in the air landed; None where the
            leaf has no such deadline, or was never asked during a swing.
        late: results that came after the landing.
    """

    leaf: str
    count: int
    cancelled: int
    budget_ms: float | None
    used_ms_median: float | None
    used_ms_p99: float | None
    used_ms_most: float | None
    margin_ms_least: float | None
    misses: int
    landing_s_median: float | None
    landing_s_least: float | None
    late: int


class DeadlineAccounts:
    """Gathers the records of a run's computations."""

    def __init__(self) -> None:
        self._jobs: dict[str, list[JobRecord]] = {}

    def take(self, jobs: Iterable[JobRecord]) -> None:
        """Take note of computations that have ended."""
        for job in jobs:
            self._jobs.setdefault(job.path, []).append(job.bare)

    def report(self) -> tuple[LeafDeadlines, ...]:
        """One account a leaf, by path."""
        return tuple(_account(path, self._jobs[path]) for path in sorted(self._jobs))


def verdict(job: JobRecord) -> str:
    """How a computation stands to its budget, in one word: "in time", "tight", "missed" or "cancelled"."""
    if job.outcome is JobOutcome.CANCELLED or job.compute_seconds is None:
        return "cancelled"
    if job.missed or (job.deadline_margin is not None and job.deadline_margin < 0.0):
        return "missed"
    return "tight" if job.compute_seconds > TIGHT * job.budget else "in time"


def _account(path: str, jobs: list[JobRecord]) -> LeafDeadlines:
    ended = [job for job in jobs if job.compute_seconds is not None]
    used = np.array([job.compute_seconds for job in ended]) * 1e3
    margins = [margin for job in ended if (margin := job.deadline_margin) is not None]
    return LeafDeadlines(
        leaf=path,
        count=len(ended),
        cancelled=len(jobs) - len(ended),
        budget_ms=round(1e3 * min(job.budget for job in ended), 3) if ended else None,
        used_ms_median=round(float(np.median(used)), 3) if ended else None,
        used_ms_p99=round(float(np.percentile(used, 99)), 3) if ended else None,
        used_ms_most=round(float(np.max(used)), 3) if ended else None,
        margin_ms_least=round(1e3 * min(job.margin or 0.0 for job in ended), 3) if ended else None,
        misses=sum(job.missed for job in ended),
        landing_s_median=round(float(np.median(margins)), 3) if margins else None,
        landing_s_least=round(min(margins), 3) if margins else None,
        late=sum(margin < 0.0 for margin in margins),
    )
