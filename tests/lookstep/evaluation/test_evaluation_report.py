"""What walks add up to: success as the case wants it, and durations pooled over walks."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import pytest
from some_walks import row, summary, timing

from lookstep.bench.markdown import markdown
from lookstep.evaluation.paper import ROBOT_RUNS
from lookstep.evaluation.paper_tables import duration_of
from lookstep.evaluation.report import EvaluationReport, Group, why_failed
from lookstep.evaluation.suite import Case, Failures
from lookstep.options import RunOptions
from lookstep.summary import Outcome, PauseCounts
from sim_envs.judge import StepCounts

FELL = {"outcome": Outcome.FELL, "reason": "the DCM is 6 cm outside the support polygon"}


def group(*walks: dict, **case: Any) -> Group:
    known: dict[str, Any] = {"name": "rough", "course": "rough", "preset": "fast"}
    whole = Case(**(known | case))
    return Group(whole, "physics", tuple(row(whole.options(i, "physics"), **walk) for i, walk in enumerate(walks)))


def test_a_walk_fails_where_it_does_not_end_as_its_case_wants():
    case, blocked = Case(name="a", course="rough"), Case(name="b", course="rough", ends=(Outcome.BLOCKED,))
    options = RunOptions()
    assert why_failed(row(options), case) == ""
    assert why_failed(row(options, **FELL), case) == "fell: the DCM is 6 cm outside the support polygon"
    assert why_failed(row(options), blocked).startswith("goal_reached: ")
    assert why_failed(row(options, outcome=Outcome.BLOCKED, reason="blocked: no ground"), case) == "blocked: no ground"
    assert why_failed(row(options, outcome=Outcome.BLOCKED, reason="blocked"), blocked) == ""


def test_a_walk_without_its_reactive_steps_fails():
    case = Case(name="a", course="moved_blocks", least_reactive=2)
    one, two = (StepCounts(total=20, rough=20, reactive=count) for count in (1, 2))
    assert why_failed(row(RunOptions(), steps=one), case) == "1 reactive steps, needs 2"
    assert why_failed(row(RunOptions(), steps=two), case) == ""


@pytest.mark.parametrize(("may_fail", "missed"), [(None, False), (0, True), (1, False)])
def test_more_failures_than_may_be_are_a_miss(may_fail, missed):
    walks = group({}, FELL, {}, may_fail=Failures(physics=may_fail))
    assert walks.missed is missed and EvaluationReport("", [walks], 1).missed is missed
    assert walks.ok == 2 and [failed.options.seed for failed, _ in walks.failures] == [1]


def test_figures_of_a_group_are_the_worst_and_the_mean_of_its_walks():
    slow = {"walking_speed_mps": 0.3, "first_transfer_after_s": 0.4, "pauses": PauseCounts(2, 1.0, {"no_plan": 2})}
    # The speed of a walk that fell says nothing of the walks that succeed.
    figures = group({"walking_speed_mps": 0.5}, slow, FELL | {"walking_speed_mps": 3.0, "min_support_fraction": 0.2})
    assert figures.speed == pytest.approx(0.4)
    assert (figures.first_transfer, figures.least_support, figures.pauses) == (0.4, 0.2, {"no_plan": 2})


def test_durations_are_those_of_all_computations_together():
    rng = np.random.default_rng(0)
    walks = [rng.uniform(0.01, 0.05, count) for count in (3, 40, 7)]
    pooled = duration_of("plan", [summary(RunOptions(), plan=timing(walk)) for walk in walks])
    together = np.concatenate(walks)
    assert pooled is not None
    assert pooled.mean == pytest.approx(together.mean(), abs=1e-6)
    assert pooled.sd == pytest.approx(together.std(), abs=1e-6)
    assert duration_of("plan", []) is None


def test_speed_and_step_length_of_the_papers_runs_are_what_they_say():
    for run in ROBOT_RUNS:
        assert run.flat + run.uneven_flat + run.rough == run.steps
        assert run.distance / run.steps == pytest.approx(run.step_length, abs=6e-4)
        assert run.distance / run.duration == pytest.approx(run.speed, abs=6e-4)


def test_tables_show_the_paper_ours_and_every_failure():
    quick = {"regions": timing(np.array([0.008, 0.010])), "plan": timing(np.array([0.004, 0.006]))}
    level = dataclasses.replace(group(quick), case=Case(name="uneven_flat", course="uneven_flat"))
    harder = group(quick | {"plan": timing(np.array([9.0]))}, name="tilted", set=("course.tilted_share=1.0",))
    told = markdown(EvaluationReport("Walks", [group(quick, FELL), level, harder], 2).tables())
    assert "| rough | physics | fell: the DCM is 6 cm outside the support polygon | 1 | 20 | 8.0 |" in told
    assert "| Rapid regions | paper | 0.0870 ± 0.0363 | 0.0790 ± 0.0296 |" in told
    # A harder course is not the paper's terrain.
    assert "9.0" not in told[told.index("Durations") : told.index("Statistics")]
    assert "| Footstep planning | lookstep, physics | 0.0050 ± 0.0010 |" in told
    assert "| paper 9 | 18 | 7 | 11 | 0 | - | 0 | 42 | 5.5 | 0.131 | 0.306 |" in told
    assert "| rough, physics, 2 | 20.0 | 8.0 | 2.0 | 10.0 | 0.0 | 0.0 | 20.0 | 8.0 | 0.400 | 0.400 |" in told
