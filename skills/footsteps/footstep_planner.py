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
from skills.footsteps.footstep_parameters import FootstepParameters, TerrainParameters
from skills.footsteps.footstep_search import (
    OUT_OF_BUDGET,
    REACHED,
    REASONS,
    SearchGoal,
    SearchSpace,
    StepLimits,
    search_footsteps,
)
from skills.footsteps.swing_clearance import swing_clearance
from skills.footsteps.terrain import RegionTerrain, Terrain, region_terrain, slopes, snap_limits, sole_on_slope
from skills.geometry.pose import Array, Pose
from skills.regions.planar_region import PlanarRegions

if TYPE_CHECKING:
    from skills.body_path.sub_goal import SubGoal

_SAME_PLACE = 0.03


def terrain_ahead(
    regions: PlanarRegions,
    imminent_stance: Stance,
    goal: SubGoal,
    parameters: FootstepParameters,
    terrain_parameters: TerrainParameters,
) -> RegionTerrain:
    """Draw the regions on which the steps to a sub-goal can lie."""
    low, high = _window(imminent_stance, goal, parameters)
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
    left, right = (
        plan_footsteps(
            terrain,
            stance,
            side,
            goal,
            parameters,
            plan_id=plan_id,
            first_sequence_id=first_sequence_id,
            reference=reference,
            max_expansions=max_expansions,
        )
        for side in (Side.LEFT, Side.RIGHT)
    )
    return left if _rank(left, goal) <= _rank(right, goal) else right


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
    budget = parameters.max_expansions if max_expansions is None else max_expansions
    search = _Search.prepare(terrain, imminent_stance, first_side, goal, parameters, reference)
    rejections = np.zeros(len(REASONS), dtype=np.int64)
    ended, best, expansions, to_go_before, to_go = search_footsteps(
        terrain.cells,
        terrain.planes,
        terrain.resolution,
        snap_limits(parameters),
        _step_limits(parameters),
        search.goal,
        search.feet,
        budget,
        search.space,
        rejections,
    )
    counted = _counted(rejections)
    progress = (to_go_before - to_go) / parameters.step_cost * parameters.reach
    if ended == REACHED:
        outcome = PlanOutcome.GOAL_REACHED if goal.final else PlanOutcome.ENOUGH_STEPS
        reason = ""
    elif progress >= parameters.minimum_progress:
        outcome = PlanOutcome.PARTIAL
        reason = _why(ended, budget, counted)
    else:
        outcome = PlanOutcome.BLOCKED
        reason = f"no steps get on: {_why(ended, budget, counted)}"
        return FootstepPlan(plan_id, terrain.frame_id, outcome, reason, (), 0.0, expansions, counted)
    steps = _steps(search, best, terrain, imminent_stance, first_side, parameters, first_sequence_id)
    cost = float(search.space.cost[best])
    return FootstepPlan(plan_id, terrain.frame_id, outcome, reason, steps, cost, expansions, counted)


@dataclass(frozen=True, slots=True, eq=False)
class _Search:
    """What one search needs: where the lattice lies, its memory, the feet and the goal from the raster's corner."""

    anchor_world: Array
    yaw: float
    feet: Array
    goal: SearchGoal
    space: SearchSpace

    @classmethod
    def prepare(
        cls,
        terrain: Terrain,
        stance: Stance,
        first_side: Side,
        goal: SubGoal,
        parameters: FootstepParameters,
        reference: FootstepPlan | None,
    ) -> _Search:
        corner = terrain.corner_world
        anchor = stance.sole(first_side.opposite)
        low, high = _window(stance, goal, parameters)
        before = np.floor((anchor.p[:2] - low) / parameters.lattice).astype(np.int64)
        after = np.floor((high - anchor.p[:2]) / parameters.lattice).astype(np.int64)
        feet = np.array([_foot(stance, side, corner) for side in (first_side.opposite, first_side)])
        path = _path_piece(goal, corner)
        places = _reference_places(reference, stance, first_side, parameters.reference_steps) - corner
        return cls(
            anchor.p,
            anchor.yaw,
            feet,
            SearchGoal(path, goal.search_arc_length, float(goal.final), places),
            _space((before + after + 1)[::-1], before[::-1].copy(), parameters.headings),
        )

    def pose(self, node: int, parameters: FootstepParameters) -> Pose:
        """Sole frame of a node."""
        ny, nx, headings = (int(n) for n in self.space.shape)
        snap = node % (ny * nx * headings)
        heading, ix, iy = snap % headings, snap // headings % nx, snap // headings // nx
        x = self.anchor_world[0] + (ix - self.space.start[1]) * parameters.lattice
        y = self.anchor_world[1] + (iy - self.space.start[0]) * parameters.lattice
        turn = heading if 2 * heading < headings else heading - headings
        z, a, b, _ = self.space.ground[snap]
        return sole_on_slope(x, y, z, self.yaw + turn * 2 * np.pi / headings, a, b)

    def share(self, node: int) -> float:
        """Supported share of the sole at a node."""
        return float(self.space.ground[node % (len(self.space.cost) // 2), 3])


def _window(stance: Stance, goal: SubGoal, parameters: FootstepParameters) -> tuple[Array, Array]:
    """Corners of the ground that is searched."""
    piece = _path_piece(goal, np.zeros(2))[:, :2]
    points = np.vstack((piece, stance.T_world_left.p[:2], stance.T_world_right.p[:2]))
    return points.min(axis=0) - parameters.window_margin, points.max(axis=0) + parameters.window_margin


def _path_piece(goal: SubGoal, corner: Array) -> Array:
    """The path from the stance to the end of the search: (N, 4) x, y from the corner, heading, arc length."""
    arcs = goal.path.arc_lengths
    inner = [s for s in arcs if goal.start_arc_length < s < goal.search_arc_length]
    ends = [goal.start_arc_length, *inner, goal.search_arc_length]
    piece = np.array([(*goal.path.at(s), s) for s in ends])
    piece[:, :2] -= corner
    return piece


def _foot(stance: Stance, side: Side, corner: Array) -> tuple[float, ...]:
    sole = stance.sole(side)
    x, y = sole.p[:2] - corner
    return (x, y, sole.p[2], sole.yaw, *slopes(sole), side.sign)


def _reference_places(reference: FootstepPlan | None, stance: Stance, first_side: Side, count: int) -> Array:
    """Places of the first `count` steps in the plan before, (count, 2); NaN where it has none.

    They are the steps after the one that lands where the stance foot stands, or, where none does, its first steps.
    """
    places = np.full((count, 2), np.nan)
    steps = () if reference is None else reference.steps
    stance_xy = stance.sole(first_side.opposite).p[:2]
    for i, step in enumerate(steps):
        if step.side is not first_side and np.linalg.norm(step.T_world_sole.p[:2] - stance_xy) < _SAME_PLACE:
            steps = steps[i + 1 :]
            break
    if steps and steps[0].side is first_side:
        known = np.array([step.T_world_sole.p[:2] for step in steps[:count]])
        places[: len(known)] = known
    return places


def _space(shape: NDArray[np.int64], start: NDArray[np.int64], headings: int) -> SearchSpace:
    """Memory of a search; pages that it does not touch cost nothing."""
    stances = int(shape[0] * shape[1]) * headings
    return SearchSpace(
        shape=np.array((shape[0], shape[1], headings), dtype=np.int64),
        start=start,
        status=np.zeros(2 * stances, dtype=np.uint8),
        cost=np.empty(2 * stances),
        parent=np.empty(2 * stances, dtype=np.int32),
        depth=np.empty(2 * stances, dtype=np.int32),
        snap=np.zeros(stances, dtype=np.uint8),
        ground=np.empty((stances, 4)),
    )


def _step_limits(parameters: FootstepParameters) -> StepLimits:
    derived = {
        "half_length": 0.5 * parameters.sole_length,
        "half_width": 0.5 * parameters.sole_width,
        "uphill_slope": np.tan(parameters.uphill_slope),
        "turn_per_step": 0.5 * (parameters.inward_yaw + parameters.outward_yaw),
    }
    values = {name: derived[name] if name in derived else getattr(parameters, name) for name in StepLimits._fields}
    return StepLimits(**{name: float(value) for name, value in values.items()})


def _steps(
    search: _Search,
    last: int,
    terrain: Terrain,
    stance: Stance,
    first_side: Side,
    parameters: FootstepParameters,
    first_sequence_id: int,
) -> tuple[Footstep, ...]:
    """The way to a node as steps, each with its foothold and its swing."""
    nodes = [last]
    while search.space.parent[nodes[-1]] >= 0:
        nodes.append(int(search.space.parent[nodes[-1]]))
    steps: list[Footstep] = []
    side = first_side
    for i, node in enumerate(nodes[-2::-1]):
        landing = search.pose(node, parameters)
        whole = search.share(node) >= 1.0
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


def _rank(plan: FootstepPlan, goal: SubGoal) -> tuple[int, float, float]:
    """Order of plans, the best lowest: by outcome, then a partial plan's progress, then cost."""
    order = (PlanOutcome.GOAL_REACHED, PlanOutcome.ENOUGH_STEPS, PlanOutcome.PARTIAL, PlanOutcome.BLOCKED)
    progress = 0.0
    if plan.outcome is PlanOutcome.PARTIAL:
        progress = goal.path.project(plan.steps[-1].T_world_sole.p)
    return order.index(plan.outcome), -progress, plan.cost


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
