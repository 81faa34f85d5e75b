"""Walks that were never made: rows with figures as a test wants them."""

from __future__ import annotations

from typing import Any

import numpy as np

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
        deadlines=(),
        min_support_fraction=0.95,
        view_fraction=0.8,
        foothold_error_m=0.001,
    )
    return Summary(**(known | figures))


def timing(seconds: np.ndarray) -> SkillTiming:
    """Statistics of computations."""
    return SkillTiming.of(seconds.tolist(), [1.0] * len(seconds))
