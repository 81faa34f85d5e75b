"""Footstep planning: the next steps along a body path, by weighted A* over footholds on a terrain.

The search starts from the imminent stance, snaps every sole to the ground, and ends when the body has made enough
progress along the path, or, at its end, when both feet stand at the goal. Whatever ends it, the best steps so far are
the plan, as long as they get the robot on (after Calvert et al., 2022, and Griffin et al., 2019). Steps of the plan
before are kept where they are still about as good.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING

from skills.footsteps.footstep import FootstepPlan, PlanOutcome, Side, Stance
from skills.footsteps.footstep_parameters import FootstepParameters, TerrainParameters
from skills.footsteps.kept_steps import holds, kept_footholds, nearly_kept, steps_ahead
from skills.footsteps.planned_steps import planned_steps
from skills.footsteps.rejections import counted
from skills.footsteps.search_log import SearchLog
from skills.footsteps.search_target import SearchTarget, search_window
from skills.footsteps.stride import stride_towards
from skills.footsteps.terrain import Foothold, RegionTerrain, Terrain, region_terrain
from skills.footsteps.way import Way, WayRules, after
from skills.footsteps.way_search import Found, SearchBudget, search_way
from skills.footsteps.wiggled_steps import wiggle_steps
from skills.regions.planar_region import PlanarRegions

if TYPE_CHECKING:
    from skills.body_path.sub_goal import SubGoal


def terrain_ahead(
    regions: PlanarRegions,
    imminent_stance: Stance,
    goal: SubGoal,
    parameters: FootstepParameters,
    terrain_parameters: TerrainParameters,
) -> RegionTerrain:
    """Draw the regions on which the steps to a sub-goal can lie."""
    low, high = search_window(imminent_stance, goal, parameters)
    overhang = parameters.sole_length
    return region_terrain(regions, low - overhang, high + overhang, terrain_parameters)


def plan_from_stance(
    terrain: Terrain,
    stance: Stance,
    goal: SubGoal,
    parameters: FootstepParameters,
    *,
    plan_id: int = 0,
    first_sequence_id: int = 0,
    reference: FootstepPlan | None = None,
    max_expansions: int | None = None,
    out_of_time: Callable[[], bool] | None = None,
    logs: list[SearchLog] | None = None,
) -> FootstepPlan:
    """Plan from a stance that may start with either foot, and keep the better plan; see `plan_footsteps`."""
    planners = [
        WayPlanner(terrain, stance, side, SearchTarget.on_path(goal, stance, parameters), parameters) for side in Side
    ]
    ways = [planner.way(reference, max_expansions, out_of_time, logs) for planner in planners]
    best = min(range(len(ways)), key=lambda i: ways[i].rank)
    return planners[best].plan(ways[best], plan_id, first_sequence_id)


def plan_footsteps(
    terrain: Terrain,
    imminent_stance: Stance,
    first_side: Side,
    goal: SubGoal,
    parameters: FootstepParameters,
    *,
    plan_id: int = 0,
    first_sequence_id: int = 0,
    reference: FootstepPlan | None = None,
    max_expansions: int | None = None,
    out_of_time: Callable[[], bool] | None = None,
    logs: list[SearchLog] | None = None,
) -> FootstepPlan:
    """Plan the next steps from a stance towards a sub-goal.

    Args:
        terrain: the ground, in the world.
        imminent_stance: the stance from which the first step is made.
        first_side: the foot that makes it.
        goal: how far along which path.
        parameters: limits, costs and search settings.
        plan_id: id of the plan.
        first_sequence_id: sequence id of its first step; the others count on.
        reference: the plan before; its steps are kept where they may still be made and are about as good.
        max_expansions: nodes that the search may expand; None for the parameters' number.
        out_of_time: whether the search must end now, whatever it has found; None where time does not count.
        logs: takes the log of the search for a fresh plan; None for no log.

    Returns:
        The plan. Its outcome is GOAL_REACHED with both feet at the end of the path, ENOUGH_STEPS at the sub-goal,
        PARTIAL where the search ended before but its best steps make progress, BLOCKED without steps where not.
    """
    target = SearchTarget.on_path(goal, imminent_stance, parameters)
    planner = WayPlanner(terrain, imminent_stance, first_side, target, parameters)
    way = planner.way(reference, max_expansions, out_of_time, logs)
    return planner.plan(way, plan_id, first_sequence_id)


class WayPlanner:
    """Plans from one stance with one foot first."""

    def __init__(
        self, terrain: Terrain, stance: Stance, first_side: Side, target: SearchTarget, parameters: FootstepParameters
    ) -> None:
        self._terrain, self._stance, self._first_side = terrain, stance, first_side
        self._target, self._parameters = target, parameters
        self._rules = WayRules(terrain, stance, first_side, target, parameters)

    def way(
        self,
        reference: FootstepPlan | None = None,
        max_expansions: int | None = None,
        out_of_time: Callable[[], bool] | None = None,
        logs: list[SearchLog] | None = None,
    ) -> Way:
        """The way to take: one that keeps steps of the plan before where one holds, or else a fresh one."""
        p = self._parameters
        budget = p.max_expansions if max_expansions is None else max_expansions
        steps = () if reference is None else steps_ahead(reference, self._stance, self._first_side)
        kept = tuple(kept_footholds(self._terrain, steps, self._rules, p))
        whole = self._kept_way(kept, budget, out_of_time) if kept else None
        if whole is not None and whole.reached:
            # There is a way; a search for another one must not take long.
            budget = min(budget, p.recheck_expansions)
        found = self._search((), SearchBudget(budget, out_of_time, p.minimum_steps), logged=logs is not None)
        if logs is not None and found.log is not None:
            logs.append(found.log)
        fresh = self._way((), found)
        expansions, tried = fresh.expansions, whole
        shorter = self._shorter(kept, fresh)
        while tried is not None:
            expansions += tried.expansions
            if holds(tried, fresh, p):
                return dataclasses.replace(tried, rejections=fresh.rejections, expansions=expansions)
            begun = next(shorter, None)
            tried = None if begun is None else self._kept_way(begun, budget, out_of_time)
        return dataclasses.replace(fresh, expansions=expansions)

    def _kept_way(self, kept: tuple[Foothold, ...], budget: int, out_of_time: Callable[[], bool] | None) -> Way:
        """The way that begins with kept steps."""
        p = self._parameters
        rest = SearchBudget(min(p.keep_expansions, budget), out_of_time, max(p.minimum_steps - len(kept), 0))
        return self._way(kept, self._search(kept, rest))

    def _shorter(self, kept: tuple[Foothold, ...], fresh: Way) -> Iterator[tuple[Foothold, ...]]:
        """What else may be kept of the plan before: fewer of its steps, then almost the first."""
        for count in range(len(kept) - 1, 0, -1):
            yield kept[:count]
        if kept and fresh.footholds:
            for foothold in nearly_kept(self._terrain, kept[0], fresh.footholds[0], self._rules, self._parameters):
                yield (foothold,)

    def plan(self, way: Way, plan_id: int, first_sequence_id: int) -> FootstepPlan:
        """A way as steps that can be sent."""
        blocked = way.outcome is PlanOutcome.BLOCKED
        footholds = () if blocked else way.footholds
        return FootstepPlan(
            plan_id=plan_id,
            frame_id=self._terrain.frame_id,
            outcome=way.outcome,
            reason=f"no way on: {way.reason}" if blocked else way.reason,
            steps=planned_steps(
                self._terrain, self._stance, self._first_side, footholds, self._parameters, first_sequence_id
            ),
            cost=0.0 if blocked else way.cost,
            expansions=way.expansions,
            rejections=counted(way.rejections),
            kept_steps=0 if blocked else way.kept,
        )

    def _search(
        self, kept: list[Foothold] | tuple[Foothold, ...], budget: SearchBudget, *, logged: bool = False
    ) -> Found:
        stance, side = after(self._stance, self._first_side, kept)
        return search_way(self._terrain, stance, side, self._target, self._parameters, budget, logged=logged)

    def _way(self, kept: tuple[Foothold, ...], found: Found) -> Way:
        p, final = self._parameters, self._target.final
        stride = p.reach * (self._target.stride / stride_towards(0.0, p))
        progress = (found.saved + self._saved(kept)) / p.step_cost * stride
        if found.reached:
            outcome = PlanOutcome.GOAL_REACHED if final else PlanOutcome.ENOUGH_STEPS
        else:
            outcome = PlanOutcome.PARTIAL if progress >= p.minimum_progress else PlanOutcome.BLOCKED
        goal_xy = self._target.path_world[-1, :2] if found.reached and final else None
        footholds = wiggle_steps(
            self._terrain, self._rules, self._first_side, [*kept, *found.footholds], len(kept), p, goal_xy
        )
        return Way(
            footholds=tuple(footholds),
            kept=len(kept),
            outcome=outcome,
            reason=found.reason,
            cost=self._rules.cost(footholds),
            progress=progress,
            expansions=found.expansions,
            rejections=found.rejections,
        )

    def _saved(self, kept: tuple[Foothold, ...]) -> float:
        """What kept steps save of the estimated cost to go."""
        return self._rules.left(kept[:0]) - self._rules.left(kept) if kept else 0.0
