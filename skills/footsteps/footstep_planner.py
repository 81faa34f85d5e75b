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
    EDGE,
    GROUND,
    NODE,
    OUT_OF_BUDGET,
    REACHED,
    REASONS,
    SEARCH_GOAL,
    STEP_LIMITS,
    search_footsteps,
)
from skills.footsteps.swing_clearance import swing_clearance
from skills.footsteps.terrain import RegionTerrain, Terrain, foothold_rules, pack, region_terrain, slopes, sole_on_slope
from skills.geometry.pose import Array, Pose, wrap_angle
from skills.regions.planar_region import PlanarRegions

if TYPE_CHECKING:
    from skills.body_path.sub_goal import SubGoal

_SAME_PLACE = 0.03
_OPEN_LIST = 16384


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
    lattice = _Lattice.around(imminent_stance, first_side, goal, parameters)
    corner = terrain.corner_world
    stances = int(np.prod(lattice.shape))
    nodes, grounds = np.zeros(2 * stances + 1, dtype=NODE), np.zeros(stances, dtype=GROUND)
    rejections = np.zeros(len(REASONS), dtype=np.int64)
    ended, last, before_last, cost, expansions, saved = search_footsteps(
        terrain.cells,
        terrain.planes,
        terrain.resolution,
        *foothold_rules(parameters),
        _step_limits(parameters),
        np.array([(goal.search_arc_length, goal.final)], dtype=SEARCH_GOAL),
        goal.searched_world - (*corner, 0.0, 0.0),
        _reference_places(reference, imminent_stance, first_side, parameters.reference_steps) - corner,
        np.array([_foot(imminent_stance, side, corner) for side in (first_side.opposite, first_side)]),
        np.array((*lattice.shape, *lattice.start)),
        budget,
        nodes,
        grounds,
        np.empty(_OPEN_LIST, dtype=EDGE),
        rejections,
    )
    counted = _counted(rejections)
    reason = "" if ended == REACHED else _why(ended, budget, counted)
    outcome = _outcome(ended, saved / parameters.step_cost * parameters.reach, goal, parameters)
    if outcome is PlanOutcome.BLOCKED:
        return FootstepPlan(plan_id, terrain.frame_id, outcome, f"no way on: {reason}", (), 0.0, expansions, counted)
    way = _way(nodes["parent"], last, before_last)
    landings = [lattice.pose(node, grounds) for node in way]
    shares = [float(grounds[node % stances]["share"]) for node in way]
    steps = _steps(landings, shares, terrain, imminent_stance, first_side, parameters, first_sequence_id)
    return FootstepPlan(plan_id, terrain.frame_id, outcome, reason, steps, float(cost), expansions, counted)


@dataclass(frozen=True, slots=True, eq=False)
class _Lattice:
    """Where the nodes of a search lie.

    Attributes:
        shape: number of headings, ny, nx.
        start: heading, iy and ix of the stance foot.
        anchor_world: where the stance foot is, (3,) [m].
        yaw: its heading [rad].
        spacing: distance of two nodes [m].
        turn: angle between two headings [rad].
    """

    shape: tuple[int, int, int]
    start: tuple[int, int, int]
    anchor_world: Array
    yaw: float
    spacing: float
    turn: float

    @classmethod
    def around(cls, stance: Stance, first_side: Side, goal: SubGoal, parameters: FootstepParameters) -> _Lattice:
        """The lattice through the stance foot that covers the ground and the headings to a sub-goal."""
        anchor = stance.sole(first_side.opposite)
        low, high = _window(stance, goal, parameters)
        x_before, y_before = (int(n) for n in (anchor.p[:2] - low) / parameters.lattice)
        x_after, y_after = (int(n) for n in (high - anchor.p[:2]) / parameters.lattice)
        turn = 2 * np.pi / parameters.headings
        most = max(abs(wrap_angle(yaw - anchor.yaw)) for yaw in goal.searched_world[:, 2])
        headings = min(2 * int(np.ceil((most + parameters.heading_margin) / turn)) + 1, parameters.headings)
        shape = (headings, y_before + y_after + 1, x_before + x_after + 1)
        start = (headings // 2, y_before, x_before)
        return cls(shape, start, anchor.p, anchor.yaw, parameters.lattice, turn)

    def pose(self, node: int, grounds: NDArray[np.void]) -> Pose:
        """Sole frame of a node."""
        _, ny, nx = self.shape
        snap = node % len(grounds)
        heading, iy, ix = snap // (ny * nx), snap // nx % ny, snap % nx
        x = self.anchor_world[0] + (ix - self.start[2]) * self.spacing
        y = self.anchor_world[1] + (iy - self.start[1]) * self.spacing
        z, a, b = (float(grounds[snap][name]) for name in ("z", "a", "b"))
        return sole_on_slope(x, y, z, self.yaw + (heading - self.start[0]) * self.turn, a, b)


def _window(stance: Stance, goal: SubGoal, parameters: FootstepParameters) -> tuple[Array, Array]:
    """Corners of the ground that is searched."""
    points = np.vstack((goal.searched_world[:, :2], stance.T_world_left.p[:2], stance.T_world_right.p[:2]))
    return points.min(axis=0) - parameters.window_margin, points.max(axis=0) + parameters.window_margin


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


def _step_limits(parameters: FootstepParameters) -> NDArray[np.void]:
    """Limits, costs and settings, as the search takes them: one `STEP_LIMITS`."""
    turn = max(parameters.inward_yaw, parameters.outward_yaw)
    derived = {
        "half_length": 0.5 * parameters.sole_length,
        "half_width": 0.5 * parameters.sole_width,
        "uphill_tangent": np.tan(parameters.uphill_slope),
        # The body beside a foot moves on by the reach, and a little more where the foot turns.
        "stride": parameters.reach + 0.5 * parameters.ideal_width * turn,
        "turn": turn,
        "heading": 2 * np.pi / parameters.headings,
    }
    return pack(STEP_LIMITS, parameters, derived)


def _outcome(ended: int, progress: float, goal: SubGoal, parameters: FootstepParameters) -> PlanOutcome:
    if ended == REACHED:
        return PlanOutcome.GOAL_REACHED if goal.final else PlanOutcome.ENOUGH_STEPS
    return PlanOutcome.PARTIAL if progress >= parameters.minimum_progress else PlanOutcome.BLOCKED


def _way(parents: NDArray[np.int64], last: int, before_last: int) -> list[int]:
    """Nodes from the first step to the last; the stance foot's node, whose parent is past the end, is left out."""
    way = [last, before_last]
    while way[-1] < len(parents) - 1:
        way.append(int(parents[way[-1]]))
    return way[-3::-1]


def _steps(
    landings: list[Pose],
    shares: list[float],
    terrain: Terrain,
    stance: Stance,
    first_side: Side,
    parameters: FootstepParameters,
    first_sequence_id: int,
) -> tuple[Footstep, ...]:
    """Landings as steps, each with its foothold and its swing."""
    steps: list[Footstep] = []
    side = first_side
    for i, (landing, share) in enumerate(zip(landings, shares, strict=True)):
        swing = swing_clearance(terrain, stance.sole(side), landing, parameters)
        steps.append(
            Footstep(
                sequence_id=first_sequence_id + i,
                side=side,
                T_world_sole=landing,
                foothold_sole=whole_sole(parameters) if share >= 1.0 else terrain.foothold_polygon(landing, parameters),
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
