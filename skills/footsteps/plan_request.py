"""A request for a footstep plan: all that a plan depends on, in one value that can be kept and planned on again."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from skills.footsteps.footstep import FootstepPlan, Side, Stance
from skills.footsteps.footstep_parameters import FootstepParameters, TerrainParameters
from skills.footsteps.footstep_planner import plan_footsteps, plan_from_stance, terrain_ahead
from skills.footsteps.search_log import SearchLog
from skills.regions.planar_region import PlanarRegions

if TYPE_CHECKING:
    from skills.body_path.sub_goal import SubGoal


@dataclass(frozen=True, slots=True, eq=False)
class PlanRequest:
    """All that a plan depends on.

    Attributes:
        ground: planar regions around the robot.
        sub_goal: where the next steps should lead.
        stance: the stance from which the first step is made.
        first_side: the foot that makes it; None where either may.
        plan_id: of the plan.
        first_sequence_id: place of the first step in the walk.
        reference: the steps planned before that have not begun; None where there are none.
        footsteps, terrain: parameters.
    """

    ground: PlanarRegions
    sub_goal: SubGoal
    stance: Stance
    first_side: Side | None
    plan_id: int
    first_sequence_id: int
    reference: FootstepPlan | None
    footsteps: FootstepParameters
    terrain: TerrainParameters


def plan_on_request(
    request: PlanRequest, out_of_time: Callable[[], bool] | None = None, logs: list[SearchLog] | None = None
) -> FootstepPlan:
    """Draw the ground, then plan on it.

    Args:
        request: what to plan.
        out_of_time: whether the search must end now; None where time does not count.
        logs: takes the log of each search for a fresh plan; None for no log.
    """
    r = request
    terrain = terrain_ahead(r.ground, r.stance, r.sub_goal, r.footsteps, r.terrain)
    ids = {"plan_id": r.plan_id, "first_sequence_id": r.first_sequence_id}
    options: dict[str, Any] = {"reference": r.reference, "out_of_time": out_of_time, "logs": logs}
    if r.first_side is None:
        return plan_from_stance(terrain, r.stance, r.sub_goal, r.footsteps, **ids, **options)
    return plan_footsteps(terrain, r.stance, r.first_side, r.sub_goal, r.footsteps, **ids, **options)
