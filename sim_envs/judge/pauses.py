"""Where the robot stood when it should have walked, and why.

A pause is double support that lasts longer than a multiple of the nominal transfer while a goal is active. The double
support before the first step is not a pause but the time to the first step.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

from sim_envs.judge.parameters import JudgeParameters
from skills.walking.walking_state import WalkingPhase


class PauseCause(Enum):
    """What the robot waited for."""

    REVIEW = "review"
    BLOCKED = "blocked"
    OPERATOR = "operator"
    OLD_DATA = "old_data"
    DCM_HOLD = "dcm_hold"
    NO_PLAN = "no_plan"


@dataclass(frozen=True, slots=True)
class PhaseSample:
    """What the robot did at one time.

    Attributes:
        time: robot time [s].
        phase: of the walk.
        transfer_overdue: whether the transfer lasts longer than it was commanded to.
        goal_active: whether a goal is set and not reached.
        blocked: whether the path is blocked.
        in_review: whether an operator is asked.
        paused: whether an operator has paused the walk.
        old_data: whether what the robot knows of itself or of the ground is too old to walk on.
    """

    time: float
    phase: WalkingPhase
    transfer_overdue: bool = False
    goal_active: bool = True
    blocked: bool = False
    in_review: bool = False
    paused: bool = False
    old_data: bool = False


@dataclass(frozen=True, slots=True)
class Pause:
    """One pause, from touchdown to the next lift-off, or to the last sample [s], and its cause."""

    start: float
    end: float
    cause: PauseCause

    @property
    def duration(self) -> float:
        """How long both feet were down [s]."""
        return self.end - self.start


def find_pauses(
    samples: Sequence[PhaseSample], nominal_transfer: float, parameters: JudgeParameters | None = None
) -> tuple[Pause, ...]:
    """Find the pauses in a walk.

    Args:
        samples: in the order of time.
        nominal_transfer: commanded duration of a transfer [s].
        parameters: when double support is a pause.
    """
    longest = (parameters or JudgeParameters()).pause_ratio * nominal_transfer
    pauses = []
    for span, end in _double_supports(samples):
        start = span[0].time
        # Times are sums of ticks: a rounding error over the limit is no pause.
        if end - start > longest + 1e-9:
            pauses.append(Pause(start, end, _cause(span, end)))
    return tuple(pauses)


def _double_supports(samples: Sequence[PhaseSample]) -> list[tuple[list[PhaseSample], float]]:
    """Runs of samples with both feet down after the first swing and a goal active, and when each ended."""
    spans: list[tuple[list[PhaseSample], float]] = []
    span: list[PhaseSample] = []
    walked = False
    for sample in samples:
        if walked and sample.goal_active and sample.phase in (WalkingPhase.STANDING, WalkingPhase.TRANSFER):
            span.append(sample)
            continue
        if span:
            spans.append((span, sample.time))
            span = []
        # A goal that is reached ends the walk; the next one has a first step of its own.
        walked = sample.goal_active and (walked or sample.phase is WalkingPhase.SWING)
    if span:
        spans.append((span, span[-1].time))
    return spans


def _cause(span: list[PhaseSample], end: float) -> PauseCause:
    """What the robot waited for during most of the span, apart from transfers that ran on time."""
    waited = dict.fromkeys(PauseCause, 0.0)
    times = [sample.time for sample in span] + [end]
    for sample, begin, finish in zip(span, times[:-1], times[1:], strict=True):
        if sample.in_review:
            waited[PauseCause.REVIEW] += finish - begin
        elif sample.blocked:
            waited[PauseCause.BLOCKED] += finish - begin
        elif sample.paused:
            waited[PauseCause.OPERATOR] += finish - begin
        elif sample.old_data:
            waited[PauseCause.OLD_DATA] += finish - begin
        elif sample.transfer_overdue:
            waited[PauseCause.DCM_HOLD] += finish - begin
        elif sample.phase is WalkingPhase.STANDING:
            waited[PauseCause.NO_PLAN] += finish - begin
    return max(waited, key=lambda cause: waited[cause]) if any(waited.values()) else PauseCause.NO_PLAN
