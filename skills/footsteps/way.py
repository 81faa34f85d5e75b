"""Ways of footholds from a stance, as a planner weighs them: allowed or not, how dear, how far on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.footstep import PlanOutcome, Side, Stance
from skills.footsteps.footstep_parameters import FootstepParameters
from skills.footsteps.path_progress import judge
from skills.footsteps.rejections import REASONS
from skills.footsteps.search_request import goal_record, step_limits
from skills.footsteps.search_space import GROUND, NODE, STAND
from skills.footsteps.search_target import SearchTarget
from skills.footsteps.terrain import Foothold, Terrain, slopes
from skills.footsteps.way_check import check_way
from skills.geometry.pose import Array, Pose

_REACHED = (PlanOutcome.GOAL_REACHED, PlanOutcome.ENOUGH_STEPS)


@dataclass(frozen=True, slots=True, eq=False)
class Way:
    """Footholds from a stance towards a target.

    Attributes:
        footholds: in order, all usable.
        kept: how many of the first are those of the plan before.
        outcome: how the search for them ended; BLOCKED where they make no progress.
        reason: one sentence for the operator on why; empty where the target is reached.
        cost: sum of what the steps cost.
        progress: how far on they get [m].
        expansions: nodes that were expanded for them.
        rejections: edges rejected meanwhile, by reason.
    """

    footholds: tuple[Foothold, ...]
    kept: int
    outcome: PlanOutcome
    reason: str
    cost: float
    progress: float
    expansions: int
    rejections: NDArray[np.int64]

    @property
    def reached(self) -> bool:
        """Whether it ends where it was to go."""
        return self.outcome in _REACHED

    @property
    def rank(self) -> tuple[int, float, float]:
        """Order of ways, the best lowest: by outcome, then a partial way's progress, then cost."""
        order = (*_REACHED, PlanOutcome.PARTIAL, PlanOutcome.BLOCKED)
        progress = self.progress if self.outcome is PlanOutcome.PARTIAL else 0.0
        return order.index(self.outcome), -progress, self.cost


class WayRules:
    """What steps from one stance towards one target must keep to, and what they cost."""

    def __init__(
        self, terrain: Terrain, stance: Stance, first_side: Side, target: SearchTarget, parameters: FootstepParameters
    ) -> None:
        self._corner = terrain.corner_world
        self._sign = first_side.sign
        feet = (stance.sole(first_side), stance.sole(first_side.opposite))
        self._feet = [self._row(T_world_sole, 1.0) for T_world_sole in feet]
        path = target.path_world - (*self._corner, 0.0, 0.0)
        limits = step_limits(parameters)[0]
        self._request = (terrain.raster, limits, goal_record(target)[0], path, target.field)
        self._scratch = tuple(np.zeros(1, dtype=layout)[0] for layout in (STAND, GROUND, NODE))

    def cost(self, footholds: list[Foothold] | tuple[Foothold, ...]) -> float:
        """What a way costs; infinite where a step is not allowed."""
        checked = self._check(footholds, 0, len(footholds) - 1)
        return checked if checked >= 0.0 else np.inf

    def rejection(self, footholds: list[Foothold], first: int, last: int) -> str:
        """Why one of the steps from the first to the last must not be made; empty where all may."""
        checked = self._check(footholds, first, min(last, len(footholds) - 1))
        return REASONS[int(-checked)] if checked < 0.0 else ""

    def left(self, footholds: list[Foothold] | tuple[Foothold, ...]) -> float:
        """The part of the cost to go from the end of a way that progress takes off."""
        x, y, z, yaw, *_ = self._sole(footholds, len(footholds) + 1)
        sign = self._sign if len(footholds) % 2 else -self._sign
        _, limits, goal, path, field = self._request
        node = self._scratch[2]
        judge(limits, goal, path, field, x, y, z, np.array((yaw, np.cos(yaw), np.sin(yaw))), sign, node)
        return float(node["left"])

    def _check(self, footholds: list[Foothold] | tuple[Foothold, ...], first: int, last: int) -> float:
        rows = np.array([self._sole(footholds, k) for k in range(first, last + 3)])
        sign = -self._sign if first % 2 else self._sign
        return check_way(*self._request, rows, sign, *self._scratch)

    def _sole(self, footholds: list[Foothold] | tuple[Foothold, ...], index: int) -> tuple[float, ...]:
        """A sole as `check_way` takes it: the swing foot and the stance foot come before the footholds."""
        if index < 2:
            return self._feet[index]
        foothold = footholds[index - 2]
        return self._row(sole_of(foothold), foothold.share)

    def _row(self, T_world_sole: Pose, share: float) -> tuple[float, ...]:
        x, y, z = T_world_sole.p
        return x - self._corner[0], y - self._corner[1], z, T_world_sole.yaw, *slopes(T_world_sole), share


def sole_of(foothold: Foothold) -> Pose:
    """The pose of a usable foothold."""
    assert foothold.T_world_sole is not None, "a usable foothold has a pose"
    return foothold.T_world_sole


def after(stance: Stance, first_side: Side, footholds: list[Foothold] | tuple[Foothold, ...]) -> tuple[Stance, Side]:
    """The stance after a way, and the foot that goes on."""
    side = first_side
    for foothold in footholds:
        stance, side = stance.with_sole(side, sole_of(foothold)), side.opposite
    return stance, side


def body_beside(T_world_sole: Pose, side: Side, parameters: FootstepParameters) -> Array:
    """Where the middle of the body is when a foot stands and the other beside it, (2,) in the world [m]."""
    half = 0.5 * side.sign * parameters.ideal_width
    return T_world_sole.p[:2] + half * np.array((np.sin(T_world_sole.yaw), -np.cos(T_world_sole.yaw)))
