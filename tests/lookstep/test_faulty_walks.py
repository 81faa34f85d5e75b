"""Walks with injected faults: the robot halts with a reason that an operator reads, and goes on when it is over."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

import lookstep
from behaviors.faults import POSSIBLE, read_faults
from lookstep.__main__ import main
from lookstep.errors import UserError
from lookstep.replay import ReplayOptions, replay
from lookstep.summary import Outcome, Summary
from strict_yaml import YamlError, parse_document

SMALL_CAMERA = ("camera.resolution=0.3125",)
STEPS = "/look_and_step/walk/sequence/go/walk_to/on_the_way/follow_path/selector/go_on/halt_unless/take_a_step"
PLAN = f"{STEPS}/plan_steps/pause_on_failure/sequence/plan_footsteps"


def walk(text: str, folder: Path, seconds: float, course: str = "flat", **options) -> Summary:
    file = folder / "faults.yaml"
    file.write_text(text)
    return lookstep.run(
        course=course,
        world="kinematic",
        time_limit=seconds,
        assignments=SMALL_CAMERA,
        faults=file,
        out=folder / "out",
        **options,
    )


def reasons(folder: Path) -> dict[str, list[tuple[float, str]]]:
    """What each leaf said, and when, by its name."""
    said: dict[str, list[tuple[float, str]]] = {}
    for line in (folder / "out" / "trace.jsonl").read_text().splitlines()[1:]:
        tick = json.loads(line)
        for path, reason in tick.get("reason", {}).items():
            said.setdefault(path.rpartition("/")[2], []).append((tick["time"], reason))
    return said


BLIND = {"no image comes": "mode: off", "every pixel is NaN": "mode: nan, share: 1.0"}


@pytest.mark.parametrize("mode", BLIND.values(), ids=BLIND)
def test_a_robot_that_sees_nothing_halts_with_the_reason_and_goes_on_when_it_sees_again(tmp_path: Path, mode: str):
    summary = walk(f"faults: [{{at: sensor:depth, {mode}, start: 0.5, duration: 2.4}}]", tmp_path, 5.6)
    said = reasons(tmp_path)["ground_fresh"]
    assert next(reason for _, reason in said if "limit 1.5 s" in reason).startswith("regions are ")
    assert summary.pauses.causes == {"old_data": 1} and summary.steps.total >= 3


def test_robot_data_that_comes_late_halts_the_walk_until_it_is_in_time(tmp_path: Path):
    summary = walk("faults: [{at: sensor:state, mode: delayed, by: 0.8, start: 1.5, duration: 2.5}]", tmp_path, 6.0)
    halts = [(time, reason) for time, reason in reasons(tmp_path)["halt_unless"] if reason.startswith("halted: robot")]
    assert halts[0][1] == "halted: robot data is 0.8 s old, limit 0.5 s"
    assert halts[0][0] >= 1.5 and halts[-1][0] < 4.1
    assert summary.pauses.causes == {"old_data": 1} and summary.steps.total >= 2


@pytest.mark.parametrize("mode", ["fallen", "disabled"])
def test_a_fall_in_mid_swing_ends_the_walk_for_good(tmp_path: Path, mode: str):
    summary = walk(f"faults: [{{at: sensor:status, mode: {mode}, start: 1.5, duration: 0.2}}]", tmp_path, 4.0)
    assert summary.steps.total == 1 and summary.outcome is Outcome.TIMEOUT
    assert reasons(tmp_path)["wait_for_goal"][-1][1] == "waits for a goal"


def test_a_silent_operator_leaves_the_robot_standing_and_asked(tmp_path: Path):
    summary = walk("faults: [{at: operator, mode: off, start: 0.01}]", tmp_path, 1.5, review=True)
    assert summary.first_step_after_s is None
    assert reasons(tmp_path)["review_body_path"][-1][1] == "waits for approval of body path 0"


def test_a_planner_that_finds_nothing_and_one_that_raises(tmp_path: Path):
    summary = walk(f"faults: [{{at: {PLAN}, mode: off, duration: 1.0}}]", tmp_path, 2.4)
    assert [why for _, why in reasons(tmp_path)["plan_footsteps"]].count("injected fault") == 2
    assert summary.first_step_after_s is not None and 1.8 < summary.first_step_after_s < 2.6
    summary = walk(f"faults: [{{at: {PLAN}, mode: exception, start: 0.2}}]", tmp_path, 1.0)
    assert summary.outcome is Outcome.ERROR
    assert summary.reason == f"{PLAN}: InjectedFaultError in tick: injected fault"


def test_a_block_that_is_gone_is_a_pit_that_the_robot_does_not_step_into(tmp_path: Path):
    course = tmp_path / "two_pads.yaml"
    pads = ((1.6, 0.0), (3.0, 2.3))
    objects = "".join(
        f"  - {{name: pad_{i}, size: [{length}, 1.2, 0.2], position: [{x}, 0, -0.1]}}\n"
        for i, (length, x) in enumerate(pads)
    )
    course.write_text(f"start: {{x: 0, y: 0}}\ngoal: {{x: 3, y: 0}}\nobjects:\n{objects}")
    text = "faults: [{at: world:pad_1, mode: off, start: 0.1}]"
    summary = walk(text, tmp_path, 4.0, str(course))
    assert summary.outcome is Outcome.TIMEOUT and summary.distance_m < 0.8
    assert replay(tmp_path / "out", ReplayOptions()).diff.identical


def test_faults_that_cannot_be_injected_are_refused_before_anything_is_written(tmp_path: Path, capsys):
    with pytest.raises(
        YamlError, match=r'course flat has no block "grond"; did you mean "ground"\? \(blocks: ground\)'
    ):
        walk("faults: [{at: world:grond, mode: off}]", tmp_path, 1.0)
    with pytest.raises(UserError, match='--faults: no node "/look_and_step/wal"'):
        walk("faults: [{at: /look_and_step/wal, mode: off}]", tmp_path, 1.0)
    with pytest.raises(UserError, match="--faults: /look_and_step/walk is no leaf"):
        walk("faults: [{at: /look_and_step/walk, mode: off}]", tmp_path, 1.0)
    assert not (tmp_path / "out").exists()
    assert main(["run", "--course", "flat", "--faults", str(tmp_path / "missing.yaml")]) == 2
    assert "cannot read the file" in capsys.readouterr().err


def test_the_page_has_every_fault_that_is_possible_and_its_file_is_read():
    page = (Path(__file__).parents[2] / "docs" / "faults.md").read_text(encoding="utf-8")
    (example,) = re.findall(r"```yaml\n(.*?)```", page, re.DOTALL)
    assert {placed.fault.kind for placed in read_faults(parse_document(example))} == {
        "sensor:depth",
        "sensor:state",
        "leaf",
        "world",
    }
    rows = dict(re.findall(r"^\| `(\S+?)` \|[^|]*\| ([^|]*) \|$", page, re.MULTILINE))
    names = {"/path/of/a/leaf": "leaf", "world:BLOCK": "world"}
    listed = {names.get(at, at): re.findall(r"`(\w+)`", modes) for at, modes in rows.items()}
    assert listed == {kind: [mode.value for mode in modes] for kind, modes in POSSIBLE.items()}
