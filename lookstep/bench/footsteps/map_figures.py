"""Whole plans over planar-region maps: solved or why not, and how long it took."""

from __future__ import annotations

from dataclasses import dataclass

from lookstep.bench.footsteps.reference_times import reference_ms
from lookstep.bench.timing import Timing, timed
from skills.footsteps import (
    FootstepParameters,
    FootstepPlan,
    PlanOutcome,
    Stance,
    TerrainParameters,
    plan_whole_way,
    stand_on,
)
from skills.footsteps.region_map import RegionMap

_LONGEST = 5.0


@dataclass(frozen=True, slots=True)
class MapFigures:
    """What planning the whole way over one map gave.

    Attributes:
        region_map: the map.
        stance: the stance at its start.
        plan: the plan.
        timing: of planning, from the regions to the last swing.
    """

    region_map: RegionMap
    stance: Stance
    plan: FootstepPlan
    timing: Timing

    @property
    def solved(self) -> bool:
        """Whether both feet end at the goal."""
        return self.plan.outcome is PlanOutcome.GOAL_REACHED

    @property
    def times_faster(self) -> float | None:
        """The reference time over ours; None where there is none, or no plan."""
        reference = reference_ms(self.region_map.name)
        return reference / self.timing.median_ms if reference is not None and self.solved else None

    def as_json(self) -> dict[str, str | int | float | None]:
        """The figures under the names that programs read."""
        return {
            "outcome": self.plan.outcome.value,
            "reason": self.plan.reason,
            "steps": len(self.plan.steps),
            "cost": round(self.plan.cost, 4),
            "median_ms": self.timing.median_ms,
            "p99_ms": self.timing.p99_ms,
            "expansions": self.plan.expansions,
            "times_faster": None if self.times_faster is None else round(self.times_faster, 2),
        }


def measure_map(
    region_map: RegionMap, parameters: FootstepParameters, terrain_parameters: TerrainParameters, repeats: int
) -> MapFigures:
    """Plan the whole way over a map, again and again."""
    stance = stand_on(region_map.regions, region_map.start_world, parameters, terrain_parameters)
    plan, times = timed(
        lambda: plan_whole_way(region_map.regions, stance, region_map.goal_world, parameters, terrain_parameters),
        repeats,
        _LONGEST,
    )
    return MapFigures(region_map, stance, plan, Timing.of(times))
