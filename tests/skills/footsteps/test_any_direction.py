"""Sideways, backward and around in place over rough ground: step by step to the goal, every third judged on its own."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from open_loop import generated
from plan_judge import PlanJudge

from skills.body_path import Goal, SubGoalParameters, facing_path, goal_reached, sub_goal
from skills.footsteps import (
    Footstep,
    FootstepParameters,
    Stance,
    TerrainParameters,
    plan_footsteps,
    plan_from_stance,
    stand_on,
    terrain_ahead,
)
from skills.geometry.pose import wrap_angle

PARAMETERS = FootstepParameters(back_reach=0.3)
TERRAIN, SUB_GOAL = TerrainParameters(), SubGoalParameters(goal_distance=0.2)
SIDEWAYS = ("rough_wide", (2.4, -1.0, 0.2, 0.0), Goal(2.4, 1.0, 0.0))
BACKWARD = ("rough_wide", (3.4, 0.2, 0.2, 0.0), Goal(1.4, 0.2, 0.0))
AROUND = ("rough", (3.4, 0.0, 0.4, 0.0), Goal(3.4, 0.0, np.pi))


def step_to(course: str, seed: int, start: tuple[float, ...], goal: Goal) -> list[tuple[Footstep, Stance]]:
    """The steps to a goal, each with the stance before it; a turn may end where it leads to."""
    regions, _, _ = generated(course, seed)
    judge = PlanJudge(regions, PARAMETERS)
    stance, plan, taken = stand_on(regions, np.array(start), PARAMETERS, TERRAIN), None, []
    turns = abs(wrap_angle(goal.yaw - start[3])) > 1.0
    while not (faces(stance, goal) if turns else goal_reached(goal, stance, SUB_GOAL)):
        path = facing_path(np.array((*start[:2], stance.yaw)), goal.xyyaw_world, 0.7)
        ahead = sub_goal(path, stance, SUB_GOAL)
        terrain = terrain_ahead(regions, stance, ahead, PARAMETERS, TERRAIN)
        if taken:
            side = taken[-1][0].side.opposite
            plan = plan_footsteps(terrain, stance, side, ahead, PARAMETERS, reference=plan)
        else:
            plan = plan_from_stance(terrain, stance, ahead, PARAMETERS)
        assert plan.steps and len(taken) < 40, plan.reason
        if len(taken) % 3 == 0:
            first = replace(plan, steps=plan.steps[:1])
            assert judge.violations(first, stance, None) == []
        taken.append((plan.steps[0], stance))
        stance = stance.with_sole(plan.steps[0].side, plan.steps[0].T_world_sole)
    return taken


def faces(stance: Stance, goal: Goal) -> bool:
    return abs(wrap_angle(stance.yaw - goal.yaw)) <= SUB_GOAL.goal_yaw


@pytest.mark.parametrize(("task", "most"), [(SIDEWAYS, 24), (BACKWARD, 20), (AROUND, 20)])
def test_it_gets_there_in_few_allowed_steps(task, most):
    course, start, goal = task
    taken = step_to(course, 1, start, goal)
    assert len(taken) <= most
    if task is not AROUND:
        assert all(abs(wrap_angle(stance.yaw)) < 0.4 for _, stance in taken), "it faces ahead all the way"


@pytest.mark.sweep
@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("task", [SIDEWAYS, BACKWARD, AROUND])
def test_it_gets_there_on_most_seeds(task, seed):
    course, start, goal = task
    assert len(step_to(course, seed, start, goal)) <= 40
