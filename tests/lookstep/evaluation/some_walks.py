"""Walks that were never made: rows with figures as a test wants them."""

from __future__ import annotations

from typing import Any

import numpy as np

from lookstep.control_health import ControlFigures
from lookstep.deadlines import LeafDeadlines
from lookstep.evaluation.run_row import RunRow
from lookstep.options import RunOptions
from lookstep.summary import Outcome, PauseCounts, SkillTiming, Summary
from sim_envs.judge import StepCounts


def row(options: RunOptions, **figures) -> RunRow:
    """A row of a walk that reached its goal, but for what is given."""
    return RunRow(options=options, code="0", summary=summary(options, **figures))


def summary(options: RunOptions, **figures) -> Summary:
    """Figures of a walk of 20 steps, but for what is given."""
    timing = SkillTiming.of([0.01, 0.02, 0.03], [0.1, 0.1, 0.1])
    account = LeafDeadlines(
        leaf="/walk/plan",
        count=3,
        cancelled=0,
        budget_ms=200.0,
        used_ms_median=20.0,
        used_ms_p99=30.0,
        used_ms_most=30.0,
        margin_ms_least=170.0,
        misses=0,
        landing_s_median=None,
        landing_s_least=None,
        late=0,
    )
    known: dict[str, Any] = dict(
        outcome=Outcome.GOAL_REACHED,
        reason="the robot stands at the goal",
        course=options.course,
        tree=options.tree,
        world=options.world,
        executor=options.executor,
        robot=options.robot,
        preset=options.preset,
        seed=options.seed,
        wall_s=10.0,
        versions={"lookstep": "0"},
        trace_hash="abc",
        duration_s=20.0,
        distance_m=8.0,
        speed_mps=0.4,
        walking_speed_mps=0.42,
        steps=StepCounts(total=20, flat=8, uneven_flat=2, rough=10, ramp=0, reactive=0),
        pauses=PauseCounts(0, 0.0, {}),
        first_transfer_after_s=0.3,
        first_step_after_s=0.6,
        plan=timing,
        regions=timing,
        deadlines=(account,),
        control=ControlFigures(10_000, 1, 0, 0.05, 0.002, 0.02, 0, 0.6),
        min_support_fraction=0.95,
        view_fraction=0.8,
        lateral_error_m=None,
        foothold_error_m=0.001,
    )
    return Summary(**(known | figures))


def timing(seconds: np.ndarray) -> SkillTiming:
    """Statistics of computations."""
    return SkillTiming.of(seconds.tolist(), [1.0] * len(seconds))
