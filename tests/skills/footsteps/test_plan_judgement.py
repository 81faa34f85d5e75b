"""Plans on random ground before an independent judge."""

import dataclasses

import numpy as np
import pytest
from numpy.typing import NDArray
from plan_judge import PlanJudge
from random_scenes import TERRAIN, Scene, random_scene

from skills.footsteps import FootstepPlan, PlanOutcome, Side, plan_footsteps, terrain_ahead
from skills.geometry.pose import Pose

REACHED = (PlanOutcome.GOAL_REACHED, PlanOutcome.ENOUGH_STEPS)


def planned(scene: Scene, **options: float) -> FootstepPlan:
    parameters = dataclasses.replace(scene.parameters, **options)
    terrain = terrain_ahead(scene.regions, scene.stance, scene.sub_goal, parameters, TERRAIN)
    return plan_footsteps(terrain, scene.stance, Side.LEFT, scene.sub_goal, parameters)


def judged(scene: Scene, plan: FootstepPlan) -> list[str]:
    return PlanJudge(scene.regions, scene.parameters).violations(
        plan, scene.stance, Side.LEFT, scene.goal_world[[0, 1, 3]]
    )


@pytest.mark.parametrize("seed", range(12))
def test_plans_on_random_ground_keep_every_limit(seed: int):
    scene = random_scene(seed)
    assert judged(scene, planned(scene)) == []


@pytest.mark.sweep
@pytest.mark.parametrize("seed", range(1000))
def test_a_thousand_plans_on_random_ground_keep_every_limit(seed: int):
    scene = random_scene(seed)
    assert judged(scene, planned(scene)) == []


def dearer(seeds: range, most: int) -> tuple[NDArray[np.float64], int]:
    """Costs over those of the best plans on the lattice, where there are such; how many the budget did not find."""
    ratios, missed = [], 0
    for seed in seeds:
        scene = random_scene(seed)
        plan, best = planned(scene), planned(scene, heuristic_weight=1.0, max_expansions=most)
        if best.outcome not in REACHED:
            assert plan.outcome not in REACHED or best.expansions >= most, (seed, plan.outcome, best.reason)
        elif plan.outcome in REACHED:
            ratios.append(plan.cost / best.cost if best.cost > 0.0 else 1.0)
        else:
            assert plan.expansions >= scene.parameters.max_expansions, (seed, plan.reason)
            missed += 1
    return np.array(ratios), missed


def test_plans_cost_little_more_than_the_best_on_random_ground():
    ratios, missed = dearer(range(12), 3000)
    assert len(ratios) >= 6 and missed <= 1
    assert np.median(ratios) < 1.05 and np.max(ratios) < 1.25


@pytest.mark.sweep
def test_a_thousand_plans_cost_little_more_than_the_best():
    ratios, missed = dearer(range(1000), 100_000)
    print(f"{len(ratios)} of 1000 reach the sub-goal, {missed} not in 3000 expansions; costs over the best,")
    print("median, 95 %, most:", *np.percentile(ratios, (50, 95, 100)).round(4))
    assert missed < 150
    assert np.median(ratios) < 1.05
    assert np.percentile(ratios, 95) < 1.15


def test_random_scenes_can_mostly_be_walked():
    steps = [len(planned(random_scene(seed)).steps) for seed in range(12)]
    assert np.count_nonzero(steps) >= 10


@pytest.mark.parametrize("seed", range(2))
def test_the_judge_notices_a_step_that_is_moved(seed: int):
    scene = random_scene(seed)
    plan = planned(scene)
    for offset in ((0.6, 0.0, 0.0), (0.0, 0.0, 0.02), (-0.25, 0.2, 0.0)):
        T = plan.steps[1].T_world_sole
        moved = dataclasses.replace(plan.steps[1], T_world_sole=Pose(T.R, T.p + offset))
        assert judged(scene, dataclasses.replace(plan, steps=(plan.steps[0], moved, *plan.steps[2:])))
