"""What kind of step it was, by the definitions of the look-and-step paper (Calvert et al., 2022, Results).

A step is judged on its three true footholds: the stance foot, and the swing foot's before and after. All level and
coplanar is flat; all level is uneven flat; all coplanar but tilted is a ramp; anything else is rough. Beside these, a
step is reactive where its foothold lies on a box that moved while the robot was approaching it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from sim_envs.courses import Ground
from sim_envs.judge.parameters import JudgeParameters
from sim_envs.judge.support import sole_support
from skills.footsteps.footstep import Side
from skills.geometry.pose import Pose


class StepKind(Enum):
    """The ground of a step."""

    FLAT = "flat"
    UNEVEN_FLAT = "uneven_flat"
    ROUGH = "rough"
    RAMP = "ramp"


@dataclass(frozen=True, slots=True, eq=False)
class TrueStep:
    """A step as it truly was.

    Attributes:
        sequence_id, side: of the footstep.
        start_time, end_time: lift-off and landing [s].
        T_world_stance: sole of the other foot.
        T_world_swing_start, T_world_swing_end: sole of the swing foot before lift-off and after landing.
    """

    sequence_id: int
    side: Side
    start_time: float
    end_time: float
    T_world_stance: Pose
    T_world_swing_start: Pose
    T_world_swing_end: Pose


@dataclass(frozen=True, slots=True)
class BoxMoved:
    """A box began to move.

    Attributes:
        box: its name.
        time: robot time [s].
        robot_distance: horizontal distance between robot and box centre [m].
    """

    box: str
    time: float
    robot_distance: float


@dataclass(frozen=True, slots=True)
class StepJudgement:
    """What the judge says of a step.

    Attributes:
        sequence_id, side, start_time, end_time: of the step.
        kind: its ground.
        reactive: whether its foothold moved while the robot was approaching.
        support_fraction: share of the landed sole's area on true ground.
        boxes: names of the boxes under the landed sole.
        tilt: of the landed sole [rad].
        length: horizontal distance from the stance sole to the landed sole [m].
        max_step_height: landed sole above the stance sole [m].
    """

    sequence_id: int
    side: Side
    start_time: float
    end_time: float
    kind: StepKind
    reactive: bool
    support_fraction: float
    boxes: tuple[str, ...]
    tilt: float
    length: float
    max_step_height: float


@dataclass(frozen=True, slots=True)
class StepCounts:
    """Number of steps of each kind; reactive overlaps the others."""

    total: int = 0
    flat: int = 0
    uneven_flat: int = 0
    rough: int = 0
    ramp: int = 0
    reactive: int = 0


def judge_step(
    step: TrueStep,
    sole_size: tuple[float, float],
    ground: Ground,
    moves: Iterable[BoxMoved] = (),
    parameters: JudgeParameters | None = None,
) -> StepJudgement:
    """Judge one step.

    Args:
        step: the true footholds.
        sole_size: length and width of the sole [m].
        ground: the true ground at landing.
        moves: every box motion of the run so far.
        parameters: tolerances.
    """
    limits = parameters or JudgeParameters()
    landed = step.T_world_swing_end
    support = sole_support(landed, sole_size, ground, limits)
    moved = {m.box for m in moves if m.time <= step.end_time and m.robot_distance <= limits.approach_distance}
    offset = landed.p - step.T_world_stance.p
    return StepJudgement(
        sequence_id=step.sequence_id,
        side=step.side,
        start_time=step.start_time,
        end_time=step.end_time,
        kind=classify_step(step.T_world_stance, step.T_world_swing_start, landed, limits),
        reactive=not moved.isdisjoint(support.boxes),
        support_fraction=support.fraction,
        boxes=support.boxes,
        tilt=_angle(landed, _UPRIGHT),
        length=math.hypot(offset[0], offset[1]),
        max_step_height=float(offset[2]),
    )


def classify_step(
    T_world_stance: Pose, T_world_swing_start: Pose, T_world_swing_end: Pose, parameters: JudgeParameters | None = None
) -> StepKind:
    """The kind of ground that three sole poses lie on."""
    limits = parameters or JudgeParameters()
    soles = (T_world_stance, T_world_swing_start, T_world_swing_end)
    level = all(_angle(sole, _UPRIGHT) < limits.level_tilt for sole in soles)
    if _coplanar(soles, level, limits):
        return StepKind.FLAT if level else StepKind.RAMP
    return StepKind.UNEVEN_FLAT if level else StepKind.ROUGH


def count_steps(judgements: Sequence[StepJudgement]) -> StepCounts:
    """Count judged steps by kind."""
    kinds = [judgement.kind for judgement in judgements]
    return StepCounts(
        total=len(judgements),
        flat=kinds.count(StepKind.FLAT),
        uneven_flat=kinds.count(StepKind.UNEVEN_FLAT),
        rough=kinds.count(StepKind.ROUGH),
        ramp=kinds.count(StepKind.RAMP),
        reactive=sum(judgement.reactive for judgement in judgements),
    )


_UPRIGHT = Pose.identity()


def _coplanar(soles: Sequence[Pose], level: bool, limits: JudgeParameters) -> bool:
    pairs = ((0, 1), (0, 2), (1, 2))
    if any(_angle(soles[i], soles[j]) >= limits.coplanar_tilt for i, j in pairs):
        return False
    # Level soles are compared in height: their own small tilts, half a metre apart, would count as offsets.
    normal = _UPRIGHT.R[:, 2] if level else np.mean([sole.R[:, 2] for sole in soles], axis=0)
    offsets = [float(sole.p @ normal) / float(np.linalg.norm(normal)) for sole in soles]
    return max(offsets) - min(offsets) < limits.coplanar_distance


def _angle(a: Pose, b: Pose) -> float:
    """Angle between the normals of two soles [rad]."""
    n_a, n_b = a.R[:, 2], b.R[:, 2]
    return math.atan2(float(np.linalg.norm(np.cross(n_a, n_b))), float(n_a @ n_b))
