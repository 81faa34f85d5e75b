"""Decorators: what they make of a status, and timers that only know the robot's clock."""

from __future__ import annotations

import pytest
from scripted import calls, make, run

from behaviors import Outcome, Status


def outcome_of(text: str, ticks: int = 1) -> Outcome:
    tree, robot = make(f"{{tree: t, root: {text}}}")
    run(tree, robot, ticks)
    return tree.outcome


@pytest.mark.parametrize(
    ("kind", "says", "outcome"),
    [
        ("inverter", "S", Outcome.FAILURE),
        ("inverter", "F", Outcome.SUCCESS),
        ("inverter", "R", Outcome.RUNNING),
        ("force_success", "F", Outcome.SUCCESS),
        ("force_success", "R", Outcome.RUNNING),
        ("force_failure", "S", Outcome.FAILURE),
        ("force_failure", "R", Outcome.RUNNING),
        ("loop_forever", "S", Outcome.RUNNING),
        ("loop_forever", "F", Outcome.RUNNING),
    ],
)
def test_decorator_turns_one_status_into_another(kind: str, says: str, outcome: Outcome):
    assert outcome_of(f"{{{kind}: {{Scripted: {{says: {says}}}}}}}") is outcome


def test_retry_tries_again_once_a_tick_and_then_fails():
    assert outcome_of("{retry: {attempts: 3, Scripted: {says: FFS}}}", 3) is Outcome.SUCCESS
    assert outcome_of("{retry: {attempts: 2, Scripted: {says: FFS}}}", 2) is Outcome.FAILURE
    assert outcome_of("{retry: {attempts: 0, Scripted: {says: F}}}", 50) is Outcome.RUNNING


def test_retry_pauses_on_the_robots_clock():
    tree, robot = make("{tree: t, root: {retry: {attempts: 0, pause: 0.1, Scripted: {says: F}}}}")
    run(tree, robot, 11)
    assert calls(tree, "/t/scripted").count("tick") == 3
    assert tree.root.reason == "said F"


def test_repeat_counts_successes_and_fails_with_its_child():
    assert outcome_of("{repeat: {times: 3, Scripted}}".replace("Scripted", "Scripted: {}"), 3) is Outcome.SUCCESS
    assert outcome_of("{repeat: {Scripted: {says: SSF}}}", 3) is Outcome.FAILURE


def test_timeout_is_measured_on_the_robots_clock():
    tree, robot = make("{tree: t, root: {timeout: {after: 1.0, Scripted: {says: R}}}}")
    tree.tick()
    for _ in range(100):
        tree.tick()  # Any number of ticks at the same robot time is no time.
    assert tree.outcome is Outcome.RUNNING
    robot.time = 0.98
    tree.tick()
    assert tree.outcome is Outcome.RUNNING
    robot.time = 1.0
    tree.tick()
    assert tree.outcome is Outcome.FAILURE
    assert tree.reason == "took longer than 1 s"
    assert calls(tree, "/t/scripted").count("stop") == 1


def test_timeout_lets_a_child_end_at_the_last_moment():
    tree, robot = make("{tree: t, root: {timeout: {after: 0.04, Scripted: {says: RRS}}}}")
    run(tree, robot, 3)
    assert tree.outcome is Outcome.SUCCESS


def test_rate_limit_keeps_the_mean_rate_where_the_period_is_no_multiple_of_the_tick():
    tree, robot = make("{tree: t, root: {loop_forever: {rate_limit: {period: 0.03, Scripted: {}}}}}")
    run(tree, robot, 301)
    assert calls(tree, "/t/rate_limit/scripted").count("start") == pytest.approx(200, abs=1)


def test_rate_limit_ticks_a_running_child_at_every_tick():
    tree, robot = make("{tree: t, root: {loop_forever: {rate_limit: {period: 0.1, Scripted: {says: RRS}}}}}")
    run(tree, robot, 4)
    assert calls(tree, "/t/rate_limit/scripted") == ["start", "tick", "tick", "tick"]
    assert tree.root.reason == "starts every 0.1 s"


def test_run_while_stops_its_child_when_the_condition_no_longer_succeeds():
    tree, robot = make(
        "{tree: t, root: {run_while: {condition: {Scripted: {says: SSF}}, child: {Scripted: {name: work, says: R}}}}}"
    )
    run(tree, robot, 3)
    assert tree.outcome is Outcome.FAILURE
    assert tree.reason == "said F"
    assert calls(tree, "/t/work") == ["start", "tick", "tick", "stop"]


def test_run_while_waits_while_the_condition_runs():
    tree, robot = make("{tree: t, root: {run_while: {condition: {Scripted: {says: RS}}, Scripted: {name: work}}}}")
    run(tree, robot, 1)
    assert tree.node("/t/work").status is Status.INVALID
    run(tree, robot, 1)
    assert tree.outcome is Outcome.SUCCESS


def test_retry_says_that_it_pauses_and_why():
    tree, robot = make("{tree: t, root: {retry: {pause: 2, child: {Scripted: {says: FS}}}}}")
    run(tree, robot, 2)
    assert tree.root.reason == "tries again 2 s after it failed: said F"
