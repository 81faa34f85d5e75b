"""Plans as the running loop asks for them: requests of walks over the rough course, on regions from noisy images."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lookstep.bench.timing import Timing, timed
from lookstep.moment import Moment
from lookstep.options import RunOptions
from lookstep.walk import walk
from skills.footsteps import FootstepPlan, PlanRequest, plan_on_request

# A next step that lands farther from where it was planned has moved [m].
_MOVED = 0.03


@dataclass(frozen=True, slots=True)
class LoopFigures:
    """Figures of plans in walks.

    Attributes:
        timing: of the plans, from the regions to the last swing.
        plans: how many there were.
        next_steps: steps that were second in a plan when the first was taken.
        moved: how many of these landed elsewhere in the plan after, by more than 3 cm.
        kept: plans that keep steps of the one before.
    """

    timing: Timing
    plans: int
    next_steps: int
    moved: int
    kept: int

    def as_json(self) -> dict[str, float | int]:
        """The figures under the names that programs read."""
        return {
            "median": self.timing.median_ms,
            "p99": self.timing.p99_ms,
            "plans": self.plans,
            "next_steps": self.next_steps,
            "moved": self.moved,
            "kept": self.kept,
        }


def measure_loop(seeds: range, duration: float, repeats: int, assignments: tuple[str, ...]) -> LoopFigures:
    """Walk the rough course with noise, no longer than a duration [s], then time every plan that was asked for."""
    times: list[float] = []
    plans, next_steps, moved, kept = 0, 0, 0, 0
    for seed in seeds:
        watcher = _Watcher()
        walk(_options(seed, duration, assignments), watcher)
        for request, plan in watcher.made:
            times += timed(lambda request=request: plan_on_request(request), repeats)[1]
            plans, kept = plans + 1, kept + (plan.kept_steps > 0)
            ahead = _next_step(request, plan)
            next_steps, moved = next_steps + (ahead is not None), moved + (ahead is not None and ahead > _MOVED)
    return LoopFigures(Timing.of(times), plans, next_steps, moved, kept)


def _options(seed: int, duration: float, assignments: tuple[str, ...]) -> RunOptions:
    """Plans see the same ground in both worlds; the kinematic one walks over it faster."""
    return RunOptions(course="rough", seed=seed, world="kinematic", time_limit=duration, assignments=assignments)


class _Watcher:
    """Gathers requests and plans."""

    def __init__(self) -> None:
        self.made: list[tuple[PlanRequest, FootstepPlan]] = []

    def observe(self, moment: Moment) -> None:
        """Take the plans of one tick."""
        for job in moment.jobs:
            if isinstance(job.result, FootstepPlan):
                self.made.append((job.arguments[0], job.result))


def _next_step(request: PlanRequest, plan: FootstepPlan) -> float | None:
    """How far the next step of a walking robot moved from where it was planned before [m]; None where it was not."""
    if request.reference is None or request.first_side is None or not plan.steps:
        return None
    before = [step for step in request.reference.steps if step.sequence_id == plan.steps[0].sequence_id]
    if not before:
        return None
    return float(np.linalg.norm(plan.steps[0].T_world_sole.p - before[0].T_world_sole.p))
