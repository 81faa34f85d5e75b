"""Review in the terminal: what is typed is what happens, at a tick border, and the run replays."""

from __future__ import annotations

import contextlib
import json
from pathlib import Path

import pytest

from lookstep.__main__ import main
from lookstep.commands.terminal_review import TerminalReview
from lookstep.options import RunOptions
from lookstep.replay import ReplayOptions, replay
from lookstep.summary import Outcome, Summary
from lookstep.walk import walk

SMALL_CAMERA = "camera.resolution=0.3125"


def walk_with(lines: list[str], seconds: float, out: Path | None = None) -> tuple[Summary, list[str]]:
    """A walk whose operator types these lines, and what the terminal shows."""
    shown: list[str] = []

    def ask(prompt: str) -> str:
        shown.append(prompt)
        if not lines:
            raise EOFError
        return lines.pop(0)

    options = RunOptions(
        course="flat",
        world="kinematic",
        preset="fast",
        assignments=(SMALL_CAMERA,),
        time_limit=seconds,
        review=True,
        out=out,
    )
    return walk(options, TerminalReview(ask, shown.append, contextlib.nullcontext)), shown


def test_paths_and_plans_are_decided_on_and_the_run_replays_with_the_decisions(tmp_path: Path):
    lines = ["what?", "r", "a", "set footsteps.reach=9", "set footsteps.reach=0.3", "reject", "approve", "off"]
    summary, shown = walk_with(lines, 4.0, tmp_path / "out")
    assert lines == [] and summary.steps.total >= 2 and summary.pauses.causes == {}
    told = [line.split("\n")[0].partition(": ")[2] for line in shown if "waits for approval" in line]
    assert [line.split(" waits")[0] for line in told] == ["body path 0", "body path 1", "plan 0", "plan 1", "plan 2"]
    assert any("plan it again" in line for line in shown)
    assert "footsteps.reach: got 9.0, allowed: 0.1 .. 1 m" in shown and "footsteps.reach is 0.3 now" in shown
    ticks = [json.loads(line) for line in (tmp_path / "out" / "trace.jsonl").read_text().splitlines()[1:]]
    events = [(event["name"], event["value"]) for tick in ticks for event in tick.get("operator", [])]
    assert events == [
        ("goal", [8.0, 0.0, 0.0]),
        ("reject", ["body_path", 0]),
        ("approve", ["body_path", 1]),
        ("reject", ["footsteps", 0]),
        ("approve", ["footsteps", 1]),
    ]
    changes = [(change["key"], change["value"]) for tick in ticks for change in tick.get("parameters", [])]
    assert changes == [("reach", 0.3), ("footsteps", False)]
    assert replay(tmp_path / "out", ReplayOptions()).diff.identical


def test_an_operator_who_takes_time_leaves_the_robot_standing_for_review_and_nothing_else(tmp_path: Path):
    class Slow:
        """Approves all, but each only when it has waited for 2 s of robot time."""

        def observe(self, moment) -> None:
            from behaviors.operator import Approve

            for request in moment.tree.context.reviews:
                if moment.time > request.since + 2.0:
                    moment.tree.send(Approve(request.checkpoint, request.item_id))

    options = RunOptions(
        course="flat",
        world="kinematic",
        preset="fast",
        assignments=(SMALL_CAMERA,),
        time_limit=9.0,
        review=True,
    )
    summary = walk(options, Slow())
    assert summary.steps.total >= 2
    assert set(summary.pauses.causes) == {"review"}


def test_nobody_at_the_terminal_stops_the_run():
    summary, shown = walk_with([], 5.0)
    assert (summary.outcome, summary.reason) == (Outcome.STOPPED, "stopped by the operator")
    assert summary.duration_s < 0.5 and shown[-1] == "nobody answers; the run is stopped"


def test_review_in_the_terminal_needs_the_robots_clock_to_wait(capsys: pytest.CaptureFixture[str]):
    assert main(["run", "--review", "--executor", "realtime"]) == 2
    assert (
        "--review: the robot's clock waits for the operator, which needs --executor lockstep" in capsys.readouterr().err
    )
