"""Whole walks from depth image to goal; the camera is small, the rest is what `lookstep run` runs."""

import dataclasses
import json

import numpy as np
import pytest

import lookstep
from behaviors.leaves import plan_steps
from lookstep.options import RunOptions
from lookstep.plan_log import read_plan
from lookstep.summary import Outcome, Summary
from lookstep.walk import walk as run_walk
from skills.footsteps import FootstepPlan, plan_on_request
from skills.geometry import Pose

SMALL_CAMERA = ("camera.resolution=0.3125",)


def walk(course: str, *, seed: int = 0, world: str = "kinematic", time_limit: float = 120.0, **options) -> Summary:
    return lookstep.run(
        course=course, seed=seed, world=world, time_limit=time_limit, assignments=SMALL_CAMERA, **options
    )


@pytest.mark.parametrize(
    ("course", "seed", "world"), [("uneven_flat", 1, "kinematic"), ("rough", 2, "physics"), ("stairs", 0, "kinematic")]
)
def test_robot_reaches_the_goal_without_a_pause(course, seed, world):
    summary = walk(course, seed=seed, world=world, preset="fast")
    assert summary.outcome is Outcome.GOAL_REACHED, summary.reason
    assert summary.pauses.count == 0
    assert summary.min_support_fraction is not None and summary.min_support_fraction >= 0.6
    assert summary.first_step_after_s is not None and summary.first_step_after_s < 2.0
    assert summary.steps.total == summary.steps.flat + summary.steps.uneven_flat + summary.steps.rough + (
        summary.steps.ramp
    )


def test_robot_ends_as_blocked_and_standing_where_the_ground_ends(tmp_path):
    course = tmp_path / "pier.yaml"
    pads = ((3.0, 0.5), (1.0, 4.0))
    objects = "".join(f"  - {{size: [{length}, 1.2, 0.2], position: [{x}, 0, -0.1]}}\n" for length, x in pads)
    course.write_text(f"start: {{x: 0, y: 0}}\ngoal: {{x: 4, y: 0}}\nobjects:\n{objects}")
    summary = walk(str(course), time_limit=40.0, preset="fast")
    assert summary.outcome is Outcome.BLOCKED
    assert summary.reason.startswith("blocked: 20 attempts to plan a step were in vain, the last: no way on: ")
    assert 0.5 < summary.distance_m < 2.0
    assert summary.pauses.causes == {"blocked": 1} and summary.pauses.total_s > 5.0


def test_tree_that_succeeds_elsewhere_has_not_reached_the_goal(tmp_path):
    tree = tmp_path / "lazy.yaml"
    tree.write_text("tree: lazy\nroot: Succeed\n")
    summary = walk("flat", tree=str(tree))
    assert summary.outcome is Outcome.STOPPED
    assert summary.reason == "the tree has succeeded 8.00 m from the goal"


def test_same_seed_gives_the_same_trace_and_another_seed_another():
    first, again, other = (walk("rough", seed=seed, time_limit=3.0) for seed in (4, 4, 5))
    assert first.trace_hash == again.trace_hash
    assert first.trace_hash != other.trace_hash


def test_foothold_changed_by_a_picometre_gives_another_trace(monkeypatch):
    plain = walk("flat", time_limit=1.0)
    plan_on_request = plan_steps.plan_on_request

    def nudged(request) -> FootstepPlan:
        plan = plan_on_request(request)
        first = plan.steps[0]
        sole = first.T_world_sole
        nudge = np.array((1e-12, 0.0, 0.0))
        moved = dataclasses.replace(first, T_world_sole=Pose(sole.R, sole.p + nudge))
        return dataclasses.replace(plan, steps=(moved, *plan.steps[1:]))

    monkeypatch.setattr(plan_steps, "plan_on_request", nudged)
    assert walk("flat", time_limit=1.0).trace_hash != plain.trace_hash


def test_realtime_executor_walks_too():
    summary = walk("flat", time_limit=3.0, executor="realtime", speed=2.0)
    assert summary.outcome is Outcome.TIMEOUT, summary.reason
    assert summary.steps.total >= 1
    assert summary.wall_s >= 1.4


def test_recording_changes_nothing_and_the_summary_lies_beside_it(tmp_path):
    plain = walk("rough", time_limit=2.0)
    recorded = walk("rough", time_limit=2.0, record=tmp_path / "walk.rrd", out=tmp_path / "out")
    assert recorded.trace_hash == plain.trace_hash
    table = json.loads((tmp_path / "out" / "summary.json").read_text())
    assert table["trace_hash"] == plain.trace_hash
    assert table["outcome"] == "timeout"
    lines = (tmp_path / "out" / "trace.jsonl").read_text().splitlines()
    assert json.loads(lines[-1])["hash"] == plain.trace_hash


def test_every_plan_of_a_run_is_logged_and_the_run_is_the_same(tmp_path):
    plain = walk("rough", seed=4, time_limit=2.5)
    logged = walk("rough", seed=4, time_limit=2.5, plans=tmp_path / "plans")
    assert plain.trace_hash == logged.trace_hash
    files = sorted((tmp_path / "plans").iterdir())
    assert [file.name for file in files] == [f"{i:04d}.plan" for i in range(logged.plan.count)]
    for plan in map(read_plan, files):
        assert plan_on_request(plan.request).steps[0].T_world_sole.p.tobytes() == (
            plan.plan.steps[0].T_world_sole.p.tobytes()
        )


def test_operator_who_interrupts_still_gets_the_figures(tmp_path):
    class Impatient:
        def observe(self, moment) -> None:
            if moment.time >= 0.5:
                raise KeyboardInterrupt

    summary = run_walk(RunOptions(course="flat", assignments=SMALL_CAMERA, out=tmp_path), Impatient())
    assert summary.outcome is Outcome.STOPPED
    assert summary.reason == "stopped by the operator"
    assert json.loads((tmp_path / "summary.json").read_text())["duration_s"] >= 0.5


def test_exception_in_a_skill_ends_the_run_as_an_error_that_names_the_node(monkeypatch):
    def broken(request):
        raise ZeroDivisionError("no ground to stand on")

    monkeypatch.setattr(plan_steps, "plan_on_request", broken)
    summary = walk("flat", time_limit=3.0)
    assert summary.outcome is Outcome.ERROR
    assert "plan_footsteps: ZeroDivisionError" in summary.reason
