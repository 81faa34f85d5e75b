"""Plans on random ground before an independent judge."""

import dataclasses

import numpy as np
import pytest
from plan_judge import PlanJudge
from random_scenes import TERRAIN, Scene, random_scene

from skills.footsteps import FootstepPlan, Side, plan_footsteps, terrain_ahead
from skills.geometry.pose import Pose


def planned(scene: Scene) -> FootstepPlan:
    terrain = terrain_ahead(scene.regions, scene.stance, scene.sub_goal, scene.parameters, TERRAIN)
    return plan_footsteps(terrain, scene.stance, Side.LEFT, scene.sub_goal, scene.parameters)


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
