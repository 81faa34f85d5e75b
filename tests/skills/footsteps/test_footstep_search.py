import heapq
import math

import numpy as np
import pytest
from open_loop import random_field, rectangle, region_map, standing

from skills.body_path import SubGoal, SubGoalParameters, straight_path, sub_goal
from skills.footsteps import (
    FootstepParameters,
    PlanOutcome,
    Side,
    Stance,
    Terrain,
    TerrainParameters,
    plan_footsteps,
    plan_from_stance,
    terrain_ahead,
)
from skills.geometry.pose import Pose

Foot = tuple[int, int, int]
State = tuple[Foot, Foot | None, int]


def ahead(stance: Stance, distance: float = 3.0) -> SubGoal:
    start = np.array((*stance.mid_feet[:2], stance.yaw))
    direction = np.array((np.cos(stance.yaw), np.sin(stance.yaw), 0.0))
    return sub_goal(straight_path(start, start + distance * direction), stance, SubGoalParameters())


class Oracle:
    """Uniform-cost search over pairs of feet, written anew in plain Python: exact, slow, without estimate."""

    def __init__(self, terrain: Terrain, stance: Stance, side: Side, goal: SubGoal, parameters: FootstepParameters):
        self.terrain, self.goal, self.p = terrain, goal, parameters
        self.side, self.stance, self.swing = side, stance.sole(side.opposite), stance.sole(side)
        self.spacing, self.turn = parameters.lattice, 2 * math.pi / parameters.headings
        self.snapped: dict[Foot, tuple[Pose | None, float]] = {(0, 0, 0): (self.stance, 1.0)}

    def sole(self, foot: Foot) -> tuple[Pose | None, float]:
        if foot not in self.snapped:
            x, y = self.stance.p[0] + foot[0] * self.spacing, self.stance.p[1] + foot[1] * self.spacing
            found = self.terrain.snap(x, y, self.stance.yaw + foot[2] * self.turn, self.p)
            self.snapped[foot] = (found.T_world_sole if found.usable else None, found.share)
        return self.snapped[foot]

    def cost(self) -> float:
        root: State = ((0, 0, 0), None, 0)
        queue: list[tuple[float, int, State]] = [(0.0, 0, root)]
        best: dict[State, float] = {root: 0.0}
        count = 0
        while queue:
            cost, _, state = heapq.heappop(queue)
            if cost > best[state]:
                continue
            foot, before, depth = state
            if depth >= self.p.minimum_steps and self.arrived(foot, depth):
                return cost
            for child in self.children(foot, depth):
                edge = self.edge(foot, before, child, depth)
                following = (child, foot, min(depth + 1, 4 + depth % 2))
                if edge is not None and cost + edge < best.get(following, math.inf):
                    best[following] = cost + edge
                    count += 1
                    heapq.heappush(queue, (cost + edge, count, following))
        return math.inf

    def sign(self, depth: int) -> float:
        return self.side.sign if depth % 2 else -self.side.sign

    def body(self, foot: Foot, depth: int) -> tuple[float, float, float]:
        sole = self.sole(foot)[0]
        assert sole is not None
        half = 0.5 * self.sign(depth) * self.p.ideal_width
        return sole.p[0] + half * math.sin(sole.yaw), sole.p[1] - half * math.cos(sole.yaw), sole.yaw

    def arrived(self, foot: Foot, depth: int) -> bool:
        x, y, yaw = self.body(foot, depth)
        left = max(self.goal.search_arc_length - self.goal.path.project(np.array((x, y))), 0.0)
        inside = (left / self.p.along_tolerance) ** 2 + (y / self.p.across_tolerance) ** 2
        return inside <= 1.0 and abs(yaw) <= self.p.heading_tolerance

    def children(self, foot: Foot, depth: int) -> list[Foot]:
        most = math.ceil((self.p.reach + self.p.maximum_width) / self.spacing)
        offsets = range(-most, most + 1)
        return [
            (foot[0] + i, foot[1] + j, foot[2] + k)
            for i in offsets
            for j in offsets
            for k in (-1, 0, 1)
            if self.within(i, j, k, foot[2], -self.sign(depth))
        ]

    def within(self, i: int, j: int, k: int, heading: int, sign: float) -> bool:
        yaw = self.stance.yaw + heading * self.turn
        dx, dy = i * self.spacing, j * self.spacing
        length = math.cos(yaw) * dx + math.sin(yaw) * dy
        width = sign * (math.cos(yaw) * dy - math.sin(yaw) * dx)
        return (
            length >= -self.p.back_reach
            and self.p.minimum_width <= width <= self.p.maximum_width
            and math.hypot(length, width - self.p.ideal_width) <= self.p.reach
            and -self.p.inward_yaw - 1e-9 <= sign * k * self.turn <= self.p.outward_yaw + 1e-9
        )

    def edge(self, foot: Foot, before: Foot | None, child: Foot, depth: int) -> float | None:
        p, stance, (landing, share) = self.p, self.sole(foot)[0], self.sole(child)
        start = self.swing if before is None else self.sole(before)[0]
        if landing is None or stance is None or start is None:
            return None
        offset, yaw = landing.p - stance.p, stance.yaw
        length = math.cos(yaw) * offset[0] + math.sin(yaw) * offset[1]
        width = abs(math.cos(yaw) * offset[1] - math.sin(yaw) * offset[0])
        reach, rise = math.hypot(length, width - p.ideal_width), offset[2]
        if (
            abs(rise) > p.max_step_height
            or (rise > p.reach_up_height and reach > p.reach_up)
            or (rise < -p.reach_down_height and reach > p.reach_down)
            or (rise < -p.uphill_drop and math.asin(stance.R[2, 0]) > p.uphill_slope)
            or math.hypot(*(landing.p - start.p)[:2]) > p.swing_reach
            or abs(landing.p[2] - start.p[2]) > p.swing_height_change
        ):
            return None
        x, y, heading = self.body(child, depth + 1)
        off_path = np.linalg.norm(self.goal.path.at(self.goal.path.project(np.array((x, y))))[:2] - (x, y))
        return (
            p.step_cost
            + p.height_cost * abs(rise)
            + p.tilt_cost * math.tan(math.acos(landing.R[2, 2]))
            + p.yaw_cost * abs(heading)
            + p.width_cost * abs(width - p.ideal_width)
            + p.path_cost * float(off_path)
            + p.share_cost * (1.0 - share)
        )


@pytest.mark.parametrize("seed", [0])
def test_unweighted_search_finds_the_cost_of_an_exhaustive_one(seed: int):
    # A least number of steps, and a limit between two steps, depend on the way to a node; without them it is exact.
    parameters = FootstepParameters(
        heuristic_weight=1.0,
        lattice=0.1,
        headings=24,
        inward_yaw=0.1,
        outward_yaw=0.1,
        minimum_steps=1,
        swing_reach=2.0,
        in_place=0.0,
        wiggle_margin=0.0,
    )
    regions = random_field(seed, tilted=0.3, spread=0.02)
    stance = standing(0.4)
    goal = sub_goal(straight_path(np.zeros(3), np.array((4.0, 0.0, 0.0))), stance, SubGoalParameters(ahead=0.5))
    terrain = terrain_ahead(regions, stance, goal, parameters, TerrainParameters())
    plan = plan_footsteps(terrain, stance, Side.LEFT, goal, parameters)
    assert plan.outcome is PlanOutcome.ENOUGH_STEPS
    assert plan.cost == pytest.approx(Oracle(terrain, stance, Side.LEFT, goal, parameters).cost(), abs=1e-9)


def same_bits(a, b) -> bool:
    return all(
        x.T_world_sole.p.tobytes() == y.T_world_sole.p.tobytes()
        and x.T_world_sole.R.tobytes() == y.T_world_sole.R.tobytes()
        and x.swing_waypoints_world.tobytes() == y.swing_waypoints_world.tobytes()
        for x, y in zip(a.steps, b.steps, strict=True)
    )


def plan_on_field(shift: float = 0.0):
    stance = standing(0.3 + shift)
    goal = ahead(stance)
    parameters = FootstepParameters()
    terrain = terrain_ahead(random_field(5), stance, goal, parameters, TerrainParameters())
    return plan_footsteps(terrain, stance, Side.RIGHT, goal, parameters, plan_id=7, first_sequence_id=40)


def test_same_request_gives_the_same_bits():
    a, b = plan_on_field(), plan_on_field()
    assert (a.cost, a.expansions, a.rejections) == (b.cost, b.expansions, b.rejections)
    assert same_bits(a, b)


def test_a_change_of_a_picometre_reaches_the_plan():
    a, b = plan_on_field(), plan_on_field(1e-12)
    assert not same_bits(a, b)
    np.testing.assert_allclose(a.steps[0].T_world_sole.p, b.steps[0].T_world_sole.p, atol=1e-11)


def test_ids_count_on_from_the_first():
    plan = plan_on_field()
    assert plan.plan_id == 7
    assert [step.sequence_id for step in plan.steps] == [40 + i for i in range(len(plan.steps))]
    assert plan.steps[0].side is Side.RIGHT


def level(*regions, stance: Stance, distance: float = 3.0, parameters: FootstepParameters | None = None, **options):
    parameters = parameters or FootstepParameters()
    goal = ahead(stance, distance)
    terrain = terrain_ahead(region_map(*regions), stance, goal, parameters, TerrainParameters())
    return plan_from_stance(terrain, stance, goal, parameters, **options)


def test_no_ground_ahead_is_blocked_with_a_reason():
    plan = level(rectangle((0.0, 0.0, 0.0), size=(0.27, 0.6)), stance=standing())
    assert plan.outcome is PlanOutcome.BLOCKED
    assert not plan.steps
    assert "no ground" in plan.reason


def test_no_regions_at_all_is_blocked():
    assert level(stance=standing()).outcome is PlanOutcome.BLOCKED


def test_ground_that_ends_gives_a_partial_plan_to_its_edge():
    plan = level(rectangle((0.0, 0.0, 0.0), size=(1.4, 1.0)), stance=standing())
    assert plan.outcome is PlanOutcome.PARTIAL
    assert 0.3 < plan.steps[-1].T_world_sole.p[0] <= 0.7 - 0.13


def test_spent_budget_still_gives_steps_that_get_on():
    plan = level(rectangle((0.0, 0.0, 0.0), size=(6.0, 2.0)), stance=standing(), max_expansions=1)
    assert plan.outcome is PlanOutcome.PARTIAL
    assert plan.expansions == 1
    assert "1 expansions" in plan.reason


def test_wall_across_the_way_is_blocked_and_its_height_named():
    floor, block = rectangle((0.0, 0.0, 0.0), size=(6.0, 2.0)), rectangle((2.2, 0.0, 0.5), size=(4.0, 2.0))
    plan = level(floor, block, stance=standing())
    assert plan.outcome is not PlanOutcome.ENOUGH_STEPS
    assert "step too high" in dict(plan.rejections)


@pytest.mark.parametrize("yaw", [0.0, 0.7, -2.5])
def test_at_the_goal_both_feet_stand_square(yaw: float):
    stance = standing(yaw=yaw)
    plan = level(rectangle((0.0, 0.0, 0.0), size=(6.0, 6.0)), stance=stance, distance=0.9)
    assert plan.outcome is PlanOutcome.GOAL_REACHED
    for step in plan.steps:
        stance = stance.with_sole(step.side, step.T_world_sole)
    goal = 0.9 * np.array((np.cos(yaw), np.sin(yaw)))
    assert np.linalg.norm(stance.mid_feet[:2] - goal) <= FootstepParameters().goal_tolerance
    assert abs(stance.yaw - yaw) <= FootstepParameters().goal_yaw_tolerance
    square = np.linalg.norm(stance.T_world_left.p - stance.T_world_right.p)
    assert square == pytest.approx(FootstepParameters().ideal_width, abs=0.13)


def test_feet_at_the_goal_need_no_steps():
    stance = standing()
    path = straight_path(np.array((-0.3, 0.0, 0.0)), np.zeros(3))
    goal = sub_goal(path, stance, SubGoalParameters())
    parameters = FootstepParameters()
    terrain = terrain_ahead(
        region_map(rectangle((0.0, 0.0, 0.0), size=(3.0, 3.0))), stance, goal, parameters, TerrainParameters()
    )
    plan = plan_footsteps(terrain, stance, Side.LEFT, goal, parameters)
    assert plan.outcome is PlanOutcome.GOAL_REACHED
    assert plan.steps == ()


def test_robot_turns_on_the_spot_towards_a_goal_behind_it():
    stance, parameters = standing(), FootstepParameters()
    path = straight_path(np.zeros(3), np.array((-3.0, 0.0, np.pi)))
    ground = region_map(rectangle((0.0, 0.0, 0.0), size=(8.0, 8.0)))
    side, turned = None, [stance.yaw]
    for _ in range(14):
        goal = sub_goal(path, stance, SubGoalParameters())
        terrain = terrain_ahead(ground, stance, goal, parameters, TerrainParameters())
        if side is None:
            plan = plan_from_stance(terrain, stance, goal, parameters)
        else:
            plan = plan_footsteps(terrain, stance, side, goal, parameters)
        assert plan.outcome.executable, plan.reason
        step = plan.steps[0]
        stance, side = stance.with_sole(step.side, step.T_world_sole), step.side.opposite
        turned.append(stance.yaw)
    assert abs(abs(turned[-1]) - np.pi) < 0.2
    assert stance.mid_feet[0] < 0.1
