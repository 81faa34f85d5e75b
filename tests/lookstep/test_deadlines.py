"""The accounts of leaves that compute: budget, use, margin, and what is left of a swing."""

from __future__ import annotations

import pytest

from behaviors import JobOutcome, JobRecord
from lookstep.deadlines import DeadlineAccounts, verdict


def job(path: str, used: float | None, *, ended: float = 1.0, deadline: float | None = None) -> JobRecord:
    outcome = JobOutcome.CANCELLED if used is None else JobOutcome.DELIVERED
    return JobRecord(0, path, 0.8, 1.0, ended, 0.2, deadline, used, used, outcome)


def test_accounts_tell_budget_use_margin_and_what_is_left_of_the_swing():
    accounts = DeadlineAccounts()
    accounts.take([job("/b", 0.01, deadline=1.4), job("/a", None), job("/b", 0.25, deadline=0.9)])
    accounts.take([job("/b", 0.03), job("/b", None)])
    a, b = accounts.report()
    assert (a.leaf, a.count, a.cancelled, a.budget_ms, a.used_ms_median) == ("/a", 0, 1, None, None)
    assert (b.leaf, b.count, b.cancelled, b.budget_ms) == ("/b", 3, 1, 200.0)
    assert (b.used_ms_median, b.used_ms_most, b.margin_ms_least, b.misses) == (30.0, 250.0, -50.0, 1)
    assert (b.landing_s_median, b.landing_s_least, b.late) == (pytest.approx(0.15), pytest.approx(-0.1), 1)


@pytest.mark.parametrize(
    ("record", "said"),
    [
        (job("/a", 0.05), "in time"),
        (job("/a", 0.17), "tight"),
        (job("/a", 0.21), "missed"),
        (job("/a", 0.05, deadline=0.99), "missed"),
        (job("/a", 0.05, deadline=1.01), "in time"),
        (job("/a", None), "cancelled"),
    ],
)
def test_a_computation_is_judged_in_one_word(record: JobRecord, said: str):
    assert verdict(record) == said
