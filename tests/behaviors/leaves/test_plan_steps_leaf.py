"""What a plan is asked for: from the imminent stance, with the right foot, with ids that follow on."""

from __future__ import annotations

import pytest
from scripted_walk import PARAMETERS, SWING, WalkingRobot, blocked_plan, ground, path, plan, step, tick

from behaviors import Outcome, Status, Tree, parse_tree
from behaviors.leaves import plan_steps
from behaviors.leaves.plan_steps import PlanRequest
from skills.body_path import sub_goal
from skills.footsteps import FootstepPlan, Side

PLAN = """
tree: planning
ports: {in: {ground: PlanarRegions, sub_goal: SubGoal}}
root:
  loop_forever:
    PlanFootsteps: {in: [ground, sub_goal], out: [plan, vain], latency: 0.2}
"""


def swinging(robot: WalkingRobot) -> None:
    robot.swing(step(4), 0.6)


@pytest.fixture
def requests(monkeypatch: pytest.MonkeyPatch) -> list[PlanRequest]:
    """What plans were asked for; each is answered by three steps."""
    asked: list[PlanRequest] = []

    def answer(request: PlanRequest) -> FootstepPlan:
        asked.append(request)
        return plan(request.first_sequence_id, plan_id=request.plan_id)

    monkeypatch.setattr(plan_steps, "plan_on_request", answer)
    return asked


@pytest.fixture
def robot() -> WalkingRobot:
    return WalkingRobot()


@pytest.fixture
def tree(robot, requests):
    tree = Tree(parse_tree(PLAN), robot, parameters=dict(PARAMETERS))
    tree.set_input("ground", ground())
    tree.set_input("sub_goal", sub_goal(path(), robot.status().imminent_stance, PARAMETERS["sub_goal"]))
    yield tree
    tree.shutdown()


def test_a_standing_robot_may_begin_with_either_foot(tree, robot, requests):
    robot.stand(last=step(4))
    finish(tree)
    assert requests[0].first_side is None
    assert requests[0].stance is robot.status().imminent_stance


def test_a_robot_that_never_made_a_step_begins_with_id_0(tree, requests):
    finish(tree)
    assert (requests[0].first_side, requests[0].first_sequence_id) == (None, 0)


@pytest.mark.parametrize("do", [WalkingRobot.transfer, WalkingRobot.swing, WalkingRobot.settle])
def test_a_walking_robot_goes_on_with_the_other_foot_from_the_imminent_stance(tree, robot, requests, do):
    under_way = step(4, x=0.8)
    do(robot, under_way)
    finish(tree)
    (request,) = requests
    assert under_way.side is Side.LEFT and request.first_side is Side.RIGHT
    assert request.stance.sole(Side.LEFT) is under_way.T_world_sole
    assert request.first_sequence_id == 5


def test_the_plan_is_the_one_asked_for_when_the_robot_has_moved_on_meanwhile(tree, robot, requests):
    robot.swing(step(4), 0.6)
    tick(tree, 5)
    robot.transfer(step(5))
    finish(tree)
    assert requests[0].first_sequence_id == 5
    assert [s.sequence_id for s in tree.blackboard["plan"].steps] == [5, 6, 7]


def test_a_plan_is_delivered_when_its_latency_has_passed(tree):
    tick(tree, 10)
    assert tree.blackboard["plan"] is None
    tick(tree)
    assert tree.context.time == pytest.approx(0.2)
    assert tree.blackboard["plan"] is not None


def test_plans_are_numbered_and_the_steps_not_begun_are_the_next_ones_reference(tree, robot, requests):
    finish(tree)
    robot.swing(step(0), 0.6)
    tick(tree)
    finish(tree)
    first, second = requests[0], requests[-1]
    assert first.reference is None
    assert second.plan_id > first.plan_id
    assert second.reference is not None
    assert [s.sequence_id for s in second.reference.steps] == [1, 2]


def test_a_plan_without_steps_fails_with_the_planners_reason(tree, monkeypatch):
    monkeypatch.setattr(plan_steps, "plan_on_request", lambda request: blocked_plan())
    finish(tree)
    node = tree.node("/planning/plan_footsteps")
    assert (node.status, node.reason) == (Status.FAILURE, "no way on: no footholds lead to the sub-goal")
    assert tree.blackboard["plan"] is None


@pytest.mark.parametrize(("do", "longer"), [(WalkingRobot.stand, (1.0, 1.5, 2.0, 2.0)), (swinging, (1.0,) * 4)])
def test_a_standing_robot_searches_longer_after_each_attempt_in_vain(tree, robot, monkeypatch, do, longer):
    asked: list[PlanRequest] = []
    monkeypatch.setattr(plan_steps, "plan_on_request", lambda request: asked.append(request) or blocked_plan())
    tree.set_parameter("/planning/plan_footsteps", "longest", 2.0)
    do(robot)
    tick(tree, 100)
    budgets = [job.budget for job in tree.drain_jobs()]
    assert budgets[:4] == pytest.approx([0.2 * factor for factor in longer])
    most = PARAMETERS["footsteps"].max_expansions
    assert [request.footsteps.max_expansions for request in asked[:4]] == [factor * most for factor in longer]


def test_attempts_in_vain_are_counted_until_a_plan_or_another_goal(tree, robot, requests, monkeypatch):
    answer = plan_steps.plan_on_request
    monkeypatch.setattr(plan_steps, "plan_on_request", lambda request: blocked_plan())
    tree.set_parameter("/planning/plan_footsteps", "longer", 0.0)
    counts = []
    for length in (4.0, 4.0, 4.3, 6.0, 6.0):
        tree.set_input("sub_goal", sub_goal(path(length), robot.status().imminent_stance, PARAMETERS["sub_goal"]))
        finish(tree)
        tick(tree)
        counts.append(tree.blackboard["vain"].count)
    # The fourth was asked for before the goal was another.
    assert counts == [1, 2, 3, 4, 1]
    assert tree.blackboard["vain"].reason == blocked_plan().reason
    monkeypatch.setattr(plan_steps, "plan_on_request", answer)
    finish(tree)
    tick(tree)
    finish(tree)
    assert tree.blackboard["vain"] is None


def test_a_plan_for_a_foot_in_the_air_is_needed_when_it_lands(tree, robot):
    robot.swing(step(4), 0.6)
    finish(tree)
    (job,) = tree.drain_jobs()
    assert job.deadline == pytest.approx(job.submitted + SWING - 0.6)
    assert job.deadline_margin == pytest.approx(SWING - 0.6 - 0.2)


def finish(tree: Tree) -> None:
    """Tick until the computation under way is delivered, 0.2 s after the tick that asked for it."""
    tick(tree, 11)
    assert tree.outcome is Outcome.RUNNING
