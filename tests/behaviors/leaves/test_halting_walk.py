"""The shipped tree halts: each time for a named reason, finishing its step, and it goes on only when it should."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scripted_walk import PARAMETERS, WalkingRobot, blocked_plan, goal, ground, plan, step, tick

from behaviors import JobOutcome, Outcome, Tree, load_tree
from behaviors.faults import Fault, FaultMode
from behaviors.faulty_leaf import break_leaf
from behaviors.halt import HaltCause
from behaviors.leaves import guards, look, plan_steps
from behaviors.operator import (
    Approve,
    PauseWalk,
    Reject,
    ResetBehavior,
    ResumeWalk,
    ReviewParameters,
    StopNow,
    SwitchImpassability,
)
from skills.body_path import Obstacle
from skills.height_map import HeightMapParameters
from skills.regions import NoiseLevel, PlanarRegions, RegionExtraction

SPEC = load_tree(Path(__file__).parents[3] / "trees" / "look_and_step.yaml")
SECOND = 50


class Walk:
    """The shipped tree on a scripted robot that sees ten frames and scans a second, unless it is told otherwise."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch, **parameters) -> None:
        self.robot = WalkingRobot()
        small_map = HeightMapParameters(size=4.0, resolution=0.1, border=1.9)
        self.tree = Tree(SPEC, self.robot, parameters={**PARAMETERS, "height_map": small_map, **parameters})
        self.sees = self.scans = True
        self.regions = True
        self.planner = lambda request: plan(request.first_sequence_id, plan_id=request.plan_id)
        self.obstacle: Obstacle | None = None
        self.log: list[str] = []

        def examine(image, parameters):
            seen = ground(image.time) if self.regions else PlanarRegions((), image.time, image.frame_id)
            return RegionExtraction(image, seen, np.zeros((1, 1), np.int16), (0,), (), parameters, NoiseLevel())

        def answer(request):
            return self.planner(request)

        monkeypatch.setattr(plan_steps, "plan_on_request", answer)
        monkeypatch.setattr(look, "examine_regions", examine)
        monkeypatch.setattr(guards, "find_obstacle", lambda *given, halted: self.obstacle)
        monkeypatch.setattr(Obstacle, "has_come_since", lambda obstacle, before: True)

    def go(self, seconds: float) -> None:
        for _ in range(round(seconds * SECOND)):
            if self.tree.context.tick % 5 == 0:
                if self.sees:
                    self.robot.frame_id = 0 if self.robot.frame_id is None else self.robot.frame_id + 1
                if self.scans:
                    self.robot.scan_id = 0 if self.robot.scan_id is None else self.robot.scan_id + 1
            tick(self.tree)
            self.log += [line.text for line in self.tree.drain_log()]

    def begin(self) -> None:
        """Walk until the first step swings, with two more queued."""
        self.go(0.5)
        self.tree.send(goal())
        self.go(1.0)
        assert [sent.sequence_id for sent in self.robot.queue] == [0, 1, 2]
        self.robot.swing(step(0), 0.1)
        self.go(0.1)
        self.robot.commands.clear()
        self.log.clear()

    @property
    def causes(self) -> list[HaltCause]:
        return [halt.cause for halt in self.tree.context.halts]


@pytest.fixture
def walk(monkeypatch: pytest.MonkeyPatch):
    walk = Walk(monkeypatch)
    yield walk
    walk.tree.shutdown()


def halts_and_goes_on(walk: Walk, begin, end, reason: str, cause: HaltCause) -> None:
    """The robot is held once, while it swings, and is sent steps again only when the reason is gone."""
    walk.begin()
    begin()
    walk.go(2.0)
    assert walk.robot.commands == ["pause_walking"] and walk.robot.queue == ()
    assert [text for text in walk.log if text.startswith("halted: ")] == [f"halted: {reason}"]
    assert walk.causes == [cause]
    walk.robot.stand(x=0.4, last=step(0))
    walk.go(5.0)
    assert walk.robot.commands == ["pause_walking"] and walk.tree.outcome is Outcome.RUNNING
    end()
    walk.go(1.0)
    assert walk.robot.commands == ["pause_walking", "send_footsteps"] and walk.causes == []
    assert [text.rpartition(" after ")[0] for text in walk.log if text.startswith("goes on")] == ["goes on"]


def test_it_halts_for_what_stands_in_the_way_and_goes_on_when_it_is_gone(walk):
    thing = Obstacle(1.3, 1.7, np.zeros((4, 3)))
    halts_and_goes_on(
        walk,
        lambda: setattr(walk, "obstacle", thing),
        lambda: setattr(walk, "obstacle", None),
        "path blocked: something 1.7 m high stands 1.3 m ahead",
        HaltCause.BLOCKED,
    )


def test_the_operator_lets_it_go_on_past_what_stands_in_the_way(walk):
    thing = Obstacle(1.3, 1.7, np.zeros((4, 3)))
    halts_and_goes_on(
        walk,
        lambda: setattr(walk, "obstacle", thing),
        lambda: walk.tree.send(SwitchImpassability(halts=False)),
        "path blocked: something 1.7 m high stands 1.3 m ahead",
        HaltCause.BLOCKED,
    )


def test_it_halts_for_the_operators_pause_until_it_is_ended(walk):
    halts_and_goes_on(
        walk,
        lambda: walk.tree.send(PauseWalk()),
        lambda: walk.tree.send(ResumeWalk()),
        "paused by the operator",
        HaltCause.OPERATOR,
    )


@pytest.mark.parametrize(
    ("sense", "reason"),
    [
        ("sees", "regions are 1.5 s old, limit 1.5 s"),
        ("regions", "regions are 1.5 s old, limit 1.5 s"),
        ("scans", "the height map is 1.5 s old, limit 1.5 s"),
    ],
)
def test_it_halts_when_what_it_sees_is_old_and_goes_on_when_it_sees_again(walk, sense, reason):
    halts_and_goes_on(
        walk,
        lambda: setattr(walk, sense, False),
        lambda: setattr(walk, sense, True),
        reason,
        HaltCause.OLD_DATA,
    )


def test_it_halts_when_the_robot_says_nothing_new_of_itself(walk, monkeypatch):
    state, late = walk.robot.state, []

    def old_state():
        return late[0] if late else state()

    monkeypatch.setattr(walk.robot, "state", old_state)
    halts_and_goes_on(
        walk,
        lambda: late.append(state()),
        late.clear,
        "robot data is 0.5 s old, limit 0.5 s",
        HaltCause.OLD_DATA,
    )


def test_a_plan_that_fails_pauses_the_walk_and_the_next_one_resumes_it(walk):
    walk.begin()
    walk.planner = lambda request: blocked_plan()
    walk.robot.swing(step(0), 0.7)
    walk.go(0.4)
    assert walk.robot.commands == ["pause_walking"] and walk.robot.queue == ()
    assert walk.log == ["pauses: no way on: no footholds lead to the sub-goal"]
    walk.planner = lambda request: plan(request.first_sequence_id, plan_id=request.plan_id)
    walk.go(1.0)
    assert walk.robot.commands == ["pause_walking", "send_footsteps"]


def test_a_planner_that_gives_nothing_is_asked_again(walk):
    plan_footsteps = next(node for node in walk.tree.nodes if node.path.endswith("/plan_footsteps"))
    break_leaf(plan_footsteps, [Fault(plan_footsteps.path, FaultMode.WRONG, start=1.55, duration=1.0)])
    walk.begin()
    walk.robot.swing(step(0), 0.7)
    walk.go(0.5)
    assert walk.robot.commands == []
    walk.go(2.0)
    assert walk.robot.commands[-1] == "send_footsteps"


def test_a_reset_forgets_goal_and_plans_and_waits_for_a_new_goal_however_often_it_is_asked(walk):
    walk.begin()
    walk.robot.swing(step(0), 0.7)
    walk.go(0.1)
    walk.tree.drain_jobs()
    for _ in range(3):
        walk.tree.send(ResetBehavior())
        walk.go(0.1)
    walk.go(3.0)
    assert walk.robot.queue == () and set(walk.robot.commands) == {"pause_walking"}
    planned = [job.outcome for job in walk.tree.drain_jobs() if job.path.endswith("plan_footsteps")]
    assert planned == [JobOutcome.CANCELLED]
    assert walk.tree.blackboard["goal"] is None and walk.tree.outcome is Outcome.RUNNING
    walk.robot.stand(last=step(0))
    walk.tree.send(goal())
    walk.go(1.0)
    assert walk.robot.commands[-1] == "send_footsteps"


def test_a_disabled_robot_forgets_its_goal_takes_no_other_and_never_resumes_by_itself(walk):
    walk.begin()
    walk.robot.disable()
    walk.go(0.5)
    walk.tree.send(goal())
    walk.go(0.5)
    assert "goal refused: the robot is disabled: motors off" in walk.log
    walk.robot.stand(last=step(0))
    walk.go(3.0)
    assert walk.robot.commands == ["pause_walking"] and walk.robot.queue == ()


def test_stop_now_ends_the_run_and_lets_the_robot_stand(walk):
    walk.begin()
    walk.tree.send(StopNow())
    walk.go(1.0)
    assert walk.tree.outcome is Outcome.STOPPED and walk.robot.commands == ["pause_walking"]


def asked(walk: Walk) -> list[tuple[str, int]]:
    return [(request.checkpoint, request.item_id) for request in walk.tree.context.reviews]


def test_a_silent_operator_leaves_it_standing_and_ten_rejections_lead_to_ten_plans_before_one_is_walked(monkeypatch):
    walk = Walk(monkeypatch, review=ReviewParameters())
    walk.go(0.5)
    walk.tree.send(goal())
    walk.robot.commands.clear()
    walk.go(5.0)
    assert asked(walk) == [("body_path", 0)] and walk.causes == [HaltCause.REVIEW]
    for item_id in range(10):
        assert asked(walk) == [("body_path", item_id)]
        walk.tree.send(Reject("body_path", item_id))
        walk.go(0.5)
    walk.tree.send(Approve("body_path", 10))
    walk.go(5.0)
    for item_id in range(10):
        assert asked(walk) == [("footsteps", item_id)]
        walk.tree.send(Reject("footsteps", item_id))
        walk.go(1.0)
    assert walk.robot.commands == [] and walk.tree.outcome is Outcome.RUNNING
    walk.tree.send(Approve("footsteps", 10))
    walk.go(0.1)
    assert walk.robot.commands == ["send_footsteps"]
    walk.tree.shutdown()


def test_a_new_plan_is_reviewed_while_the_robot_stands_where_the_plan_begins(monkeypatch):
    walk = Walk(monkeypatch, review=ReviewParameters(body_path=False))
    walk.go(0.5)
    walk.tree.send(goal())
    walk.go(1.0)
    walk.tree.send(Approve("footsteps", 0))
    walk.go(0.1)
    assert [sent.sequence_id for sent in walk.robot.queue] == [0, 1, 2]
    walk.robot.swing(step(0), 0.7)
    walk.robot.commands.clear()
    walk.go(1.0)
    assert asked(walk) == [("footsteps", 1)] and walk.robot.commands == ["pause_walking"] and walk.robot.queue == ()
    walk.robot.stand(x=0.4, last=step(0))
    walk.go(2.0)
    walk.tree.send(Approve("footsteps", 0))
    walk.go(0.1)
    assert walk.robot.queue == ()
    walk.tree.send(Approve("footsteps", 1))
    walk.go(0.1)
    assert [sent.sequence_id for sent in walk.robot.queue] == [1, 2, 3]
    walk.tree.shutdown()
