"""The figures of one run, as they go to people in a table and to programs as `summary.json`."""

from __future__ import annotations

import dataclasses
import json
import math
from dataclasses import dataclass
from enum import Enum
from importlib.metadata import version
from pathlib import Path
from typing import Any, get_args, get_origin, get_type_hints

import numpy as np

from lookstep.control_health import ControlFigures
from lookstep.deadlines import LeafDeadlines
from sim_envs.judge import StepCounts

_VERSIONED = ("lookstep", "dm-control", "mujoco", "numba", "numpy", "opencv-python-headless", "pin", "py-trees")


class Outcome(Enum):
    """How a run ended."""

    GOAL_REACHED = "goal_reached"
    FELL = "fell"
    BLOCKED = "blocked"
    TIMEOUT = "timeout"
    STOPPED = "stopped"
    ERROR = "error"


@dataclass(frozen=True, slots=True)
class PauseCounts:
    """Double support longer than 1.5 times the nominal transfer while a goal is active."""

    count: int
    total_s: float
    causes: dict[str, int]


@dataclass(frozen=True, slots=True)
class SkillTiming:
    """Compute times of one skill; a deadline miss is a compute time over its budget."""

    count: int
    mean_ms: float | None
    sd_ms: float | None
    median_ms: float | None
    p99_ms: float | None
    budget_ms: float | None
    deadline_misses: int

    @classmethod
    def of(cls, compute_times: list[float], budgets: list[float]) -> SkillTiming:
        """The statistics of jobs by their compute times and budgets [s]."""
        if not compute_times:
            return cls(0, None, None, None, None, None, 0)
        misses = sum(used > budget for used, budget in zip(compute_times, budgets, strict=True))
        return cls(
            count=len(compute_times),
            mean_ms=round(1e3 * float(np.mean(compute_times)), 3),
            sd_ms=round(1e3 * float(np.std(compute_times)), 3),
            median_ms=round(1e3 * float(np.median(compute_times)), 3),
            p99_ms=round(1e3 * float(np.percentile(compute_times, 99)), 3),
            budget_ms=round(1e3 * min(budgets), 3),
            deadline_misses=misses,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Figures:
    """What was measured in a run.

    Attributes:
        duration_s: robot time from the first to the last tick.
        distance_m: straight way of the true mid-feet from first to last; speed_mps: distance over duration.
        walking_speed_mps: the same from the first lift-off to the last touchdown; None where no step has landed.
        steps: by the paper's definitions (section Results), judged on the truth; pauses likewise.
        first_transfer_after_s: robot time from the goal until weight shifts to the first stance foot;
            first_step_after_s: until the first lift-off; None where no step was made.
        plan, regions: compute times of footstep planning and of region extraction.
        deadlines: budget, use and margin of every leaf that computes.
        min_support_fraction: smallest share of a stance sole's area within 1 cm of true ground at mid-stance.
        view_fraction: share of plans whose footholds all lie on regions of the newest depth image.
        lateral_error_m: mean distance of the true mid-feet from the way on which a carrot leads, while the robot walks;
            None where the course has none.
        foothold_error_m: median distance of a landed sole's centre from its commanded foothold.
        control: how well the walking controller did.
    """

    duration_s: float
    distance_m: float
    speed_mps: float
    walking_speed_mps: float | None
    steps: StepCounts
    pauses: PauseCounts
    first_transfer_after_s: float | None
    first_step_after_s: float | None
    plan: SkillTiming
    regions: SkillTiming
    deadlines: tuple[LeafDeadlines, ...]
    min_support_fraction: float | None
    view_fraction: float | None
    lateral_error_m: float | None
    foothold_error_m: float | None
    control: ControlFigures


@dataclass(frozen=True, slots=True, kw_only=True)
class Summary(Figures):
    """The figures of one run, and what it takes to get the same run again.

    Attributes:
        outcome, reason: how it ended, and why in one sentence.
        course, tree, world, executor, robot, preset, seed: what ran.
        wall_s: wall time of the run, without set-up.
        versions: of the packages that can change a figure.
        trace_hash: equal if and only if two runs were the same to the bit.
    """

    outcome: Outcome
    reason: str
    course: str
    tree: str
    world: str
    executor: str
    robot: str
    preset: str | None
    seed: int
    wall_s: float
    versions: dict[str, str]
    trace_hash: str

    @property
    def real_time_factor(self) -> float:
        """Robot time per wall time."""
        return self.duration_s / self.wall_s if self.wall_s > 0 else math.inf

    def to_json(self) -> str:
        """The summary as JSON text; how it ended and what ran come before the figures."""
        table = dataclasses.asdict(self)
        measured = {field.name: table.pop(field.name) for field in dataclasses.fields(Figures)}
        table["outcome"] = self.outcome.value
        return json.dumps({**table, **measured}, indent=2, allow_nan=False) + "\n"

    @classmethod
    def from_json(cls, text: str) -> Summary:
        """Read what `to_json` wrote.

        Raises:
            ValueError: where it is not the summary of a run by this version.
        """
        try:
            return _restored(cls, json.loads(text))
        except (AttributeError, KeyError, TypeError) as error:
            raise ValueError(f"not a summary of this version of lookstep: {error}") from error

    def write(self, path: Path) -> None:
        """Write the JSON in one go, so that nobody ever reads half a file."""
        partial = path.with_suffix(path.suffix + ".partial")
        partial.write_text(self.to_json())
        partial.replace(path)


def _restored(hint: Any, value: Any) -> Any:
    """A value of a type from what JSON has kept of it."""
    arguments = get_args(hint)
    if dataclasses.is_dataclass(hint) and isinstance(hint, type):
        hints = get_type_hints(hint)
        return hint(**{key: _restored(hints[key], part) for key, part in value.items()})
    if isinstance(hint, type) and issubclass(hint, Enum):
        return hint(value)
    if get_origin(hint) is tuple:
        return tuple(_restored(arguments[0], part) for part in value)
    if type(None) in arguments:
        return None if value is None else _restored(arguments[0], value)
    return value


def installed_versions() -> dict[str, str]:
    """Versions of the packages that can change a figure."""
    return {name: version(name) for name in _VERSIONED}
