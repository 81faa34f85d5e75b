"""Footstep planning: the next steps along a body path, by weighted A* over footholds on a terrain.

The search starts from the imminent stance, snaps every sole to the ground, and ends when the body has made enough
progress along the path, or, at its end, when both feet stand at the goal. Whatever ends it, the best steps so far are
the plan, as long as they get the robot on (after Calvert et al., 2022, and Griffin et al., 2019).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.footstep import Footstep, FootstepPlan, PlanOutcome, Side, Stance
from skills.footsteps.footstep_lattice import FootstepLattice
from skills.footsteps.footstep_parameters import FootstepParameters, TerrainParameters
from skills.footsteps.footstep_search import OUT_OF_BUDGET, REACHED, search_footsteps
from skills.footsteps.open_list import EDGE
from skills.footsteps.search_request import search_space
from skills.footsteps.search_target import SearchTarget, search_window
from skills.footsteps.step_cost import REASONS
from skills.footsteps.swing_clearance import swing_clearance
from skills.footsteps.terrain import Foothold, RegionTerrain, Terrain, region_terrain
from skills.footsteps.wiggled_steps import wiggle_steps
from skills.geometry.pose import Array
from skills.regions.planar_region import PlanarRegions

if TYPE_CHECKING:
    from skills.body_path.sub_goal import SubGoal

_OPEN_LIST = 16384


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
) -> FootstepPlan:
    """Plan from a stance that may start with either foot, and keep the better plan; see `plan_footsteps`."""
    target = SearchTarget.on_path(goal, stance, parameters)
    ids = {"plan_id": plan_id, "first_sequence_id": first_sequence_id}
    left, right = (
        search_plan(terrain, stance, side, target, parameters, reference, max_expansions, **ids) for side in Side
    )
    return min(left, right, key=lambda found: found.rank).plan


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
        reference: the plan before; the first steps are drawn weakly to its steps.
        max_expansions: nodes that the search may expand; None for the parameters' number.

    Returns:
        The plan. Its outcome is GOAL_REACHED with both feet at the end of the path, ENOUGH_STEPS at the sub-goal,
        PARTIAL where the search ended before but its best steps make progress, BLOCKED without steps where not.
    """
    target = SearchTarget.on_path(goal, imminent_stance, parameters)
    ids = {"plan_id": plan_id, "first_sequence_id": first_sequence_id}
    return search_plan(terrain, imminent_stance, first_side, target, parameters, reference, max_expansions, **ids).plan


@dataclass(frozen=True, slots=True, eq=False)
class FoundPlan:
    """A plan, and how far on it gets [m]."""

    plan: FootstepPlan
    progress: float

    @property
    def rank(self) -> tuple[int, float, float]:
        """Order of plans, the best lowest: by outcome, then a partial plan's progress, then cost."""
        order = (PlanOutcome.GOAL_REACHED, PlanOutcome.ENOUGH_STEPS, PlanOutcome.PARTIAL, PlanOutcome.BLOCKED)
        progress = self.progress if self.plan.outcome is PlanOutcome.PARTIAL else 0.0
        return order.index(self.plan.outcome), -progress, self.plan.cost


def search_plan(
    terrain: Terrain,
    stance: Stance,
    first_side: Side,
    target: SearchTarget,
    parameters: FootstepParameters,
    reference: FootstepPlan | None,
    max_expansions: int | None,
    *,
    plan_id: int,
    first_sequence_id: int,
) -> FoundPlan:
    """Search for the steps from a stance to a target; see `plan_footsteps`."""
    budget = parameters.max_expansions if max_expansions is None else max_expansions
    lattice = FootstepLattice.around(terrain, stance, first_side, target, parameters)
    space = search_space(terrain, lattice, stance, first_side, target, reference, parameters)
    open_list = np.empty(_OPEN_LIST, dtype=EDGE)
    ended, last, before_last, cost, expansions, saved = search_footsteps(space, open_list, budget)
    counted = _counted(space.rejections)
    reason = "" if ended == REACHED else _why(ended, budget, counted)
    progress = saved / parameters.step_cost * parameters.reach
    outcome = _outcome(ended, progress, target, parameters)
    if outcome is PlanOutcome.BLOCKED:
        reason = f"no way on: {reason}"
        return FoundPlan(
            FootstepPlan(plan_id, terrain.frame_id, outcome, reason, (), 0.0, expansions, counted), progress
        )
    way = _way(space.nodes["parent"], last, before_last)
    footholds = [lattice.foothold(node, space.grounds) for node in way]
    goal_xy = target.path_world[-1, :2] if outcome is PlanOutcome.GOAL_REACHED else None
    footholds = wiggle_steps(terrain, stance, first_side, footholds, parameters, goal_xy)
    steps = _steps(footholds, terrain, stance, first_side, parameters, first_sequence_id)
    plan = FootstepPlan(plan_id, terrain.frame_id, outcome, reason, steps, float(cost), expansions, counted)
    return FoundPlan(plan, progress)


def _outcome(ended: int, progress: float, target: SearchTarget, parameters: FootstepParameters) -> PlanOutcome:
    if ended == REACHED:
        return PlanOutcome.GOAL_REACHED if target.final else PlanOutcome.ENOUGH_STEPS
    return PlanOutcome.PARTIAL if progress >= parameters.minimum_progress else PlanOutcome.BLOCKED


def _way(parents: NDArray[np.int64], last: int, before_last: int) -> list[int]:
    """Nodes from the first step to the last; the stance foot's node, whose parent is past the end, is left out."""
    way = [last, before_last]
    while way[-1] < len(parents) - 1:
        way.append(int(parents[way[-1]]))
    return way[-3::-1]


def _steps(
    footholds: list[Foothold],
    terrain: Terrain,
    stance: Stance,
    first_side: Side,
    parameters: FootstepParameters,
    first_sequence_id: int,
) -> tuple[Footstep, ...]:
    """Footholds as steps, each with its swing."""
    steps: list[Footstep] = []
    side = first_side
    for i, foothold in enumerate(footholds):
        landing, whole = foothold.T_world_sole, foothold.share >= 1.0
        assert landing is not None, "a usable foothold has a pose"
        swing = swing_clearance(terrain, stance.sole(side), landing, parameters)
        steps.append(
            Footstep(
                sequence_id=first_sequence_id + i,
                side=side,
                T_world_sole=landing,
                foothold_sole=whole_sole(parameters) if whole else terrain.foothold_polygon(landing, parameters),
                swing_duration=parameters.swing_duration,
                transfer_duration=parameters.transfer_duration,
                swing_height=swing.height,
                swing_waypoints_world=swing.waypoints_world,
            )
        )
        stance = stance.with_sole(side, landing)
        side = side.opposite
    return tuple(steps)


def whole_sole(parameters: FootstepParameters) -> Array:
    """The sole's outline in its frame, (4, 2) counter-clockwise [m]."""
    x, y = 0.5 * parameters.sole_length, 0.5 * parameters.sole_width
    return np.array(((-x, -y), (x, -y), (x, y), (-x, y)))


def _counted(rejections: NDArray[np.int64]) -> tuple[tuple[str, int], ...]:
    """Reasons and their counts, the most frequent first."""
    counts = [(reason, int(n)) for reason, n in zip(REASONS, rejections, strict=True) if n > 0]
    return tuple(sorted(counts, key=lambda item: -item[1]))


def _why(ended: int, budget: int, rejections: tuple[tuple[str, int], ...]) -> str:
    """One sentence on why a search ended without its goal."""
    most = f", most rejected: {rejections[0][0]} ({rejections[0][1]} times)" if rejections else ""
    if ended == OUT_OF_BUDGET:
        return f"the sub-goal was not found within {budget} expansions{most}"
    return f"no footholds lead to the sub-goal{most}"
