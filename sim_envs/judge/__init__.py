"""The judge, who knows the truth: what kind of steps they were, how well the ground carried them, and every pause."""

from sim_envs.judge.parameters import JudgeParameters
from sim_envs.judge.pauses import Pause, PauseCause, PhaseSample, find_pauses
from sim_envs.judge.steps import (
    BoxMoved,
    StepCounts,
    StepJudgement,
    StepKind,
    TrueStep,
    classify_step,
    count_steps,
    judge_step,
)
from sim_envs.judge.support import Support, sole_support, support_fraction

__all__ = [
    "BoxMoved",
    "JudgeParameters",
    "Pause",
    "PauseCause",
    "PhaseSample",
    "StepCounts",
    "StepJudgement",
    "StepKind",
    "Support",
    "TrueStep",
    "classify_step",
    "count_steps",
    "find_pauses",
    "judge_step",
    "sole_support",
    "support_fraction",
]
