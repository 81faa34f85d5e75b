"""Recorded walks driven again: equal to the bit where nothing is edited, and the first difference named where it is."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

import lookstep
from lookstep.__main__ import main
from lookstep.errors import UserError
from lookstep.replay import ReplayOptions, replay
from strict_yaml import shipped

WALK = "/look_and_step/walk/sequence/go/walk_to"
FOLLOW = f"{WALK}/on_the_way/follow_path"


@pytest.fixture(scope="module")
def walked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A walk over blocks, long enough for two plans."""
    folder = tmp_path_factory.mktemp("walked")
    assignments = (
        "camera.resolution=0.3125",
        "drift.velocity=[0,0.01,0]",
        f"{WALK}/on_the_way/follow_path.attempts=50",
    )
    lookstep.run(course="rough", world="kinematic", seed=3, time_limit=2.4, assignments=assignments, out=folder)
    return folder


def test_a_recording_replays_to_the_bit_with_all_skills_computed_anew(walked: Path):
    replayed = replay(walked, ReplayOptions())
    assert replayed.diff.identical and replayed.diff.divergent == 0 and replayed.diff.ticks == 121


def test_played_back_outputs_decide_the_same(walked: Path):
    replayed = replay(walked, ReplayOptions(outputs=True))
    assert replayed.diff.identical and replayed.strayed == {}


def test_an_edited_parameter_is_named_where_it_decides_otherwise(walked: Path):
    fraction = f"{FOLLOW}/selector/go_on/halt_unless/take_a_step/wait_for_swing.fraction"
    diff = replay(walked, ReplayOptions(assignments=(f"{fraction}=0.2",))).diff
    assert [difference.subject for difference in diff.tree] == [fraction]
    assert diff.first is not None and diff.first_command is not None
    first = [difference.subject for difference in diff.first.differences if difference.what == "status"]
    assert any(path.endswith("wait_for_swing") for path in first)
    # 20 % instead of 50 % of a swing of 0.8 s; the plan is sent 0.24 s earlier.
    assert 1.1 < diff.first.time < diff.first_command.time < 2.0


def test_an_edited_tree_is_driven_by_the_recorded_sensors(walked: Path, tmp_path: Path):
    text = shipped("trees", "look_and_step.yaml").read_text()
    edited = tmp_path / "edited.yaml"
    edited.write_text(text.replace("max_age: 1.5", "max_age: 0.05"))
    diff = replay(walked, ReplayOptions(tree=str(edited))).diff
    assert diff.first is not None
    statuses = {difference.subject.rpartition("/")[2]: difference for difference in diff.first.differences}
    assert "limit 0.1 s" in statuses["ground_fresh"].second or "limit 0.0 s" in statuses["ground_fresh"].second


def test_an_edited_tree_with_played_back_outputs_says_where_the_recording_is_silent(walked: Path, tmp_path: Path):
    text = shipped("trees", "look_and_step.yaml").read_text()
    edited = tmp_path / "edited.yaml"
    send = "- SendFootsteps: {in: [plan]}\n"
    assert send in text
    edited.write_text(text.replace(send, f"- Wait: {{duration: 0.1}}\n{8 * ' '}{send}"))
    replayed = replay(walked, ReplayOptions(tree=str(edited), outputs=True))
    assert any(path.endswith("send_footsteps") for path in replayed.strayed)


def test_a_recording_of_physics_in_real_time_replays_as_well(tmp_path: Path):
    lookstep.run(
        course="flat",
        time_limit=0.6,
        assignments=("camera.resolution=0.3125",),
        out=tmp_path,
        executor="realtime",
        speed=4.0,
    )
    assert replay(tmp_path, ReplayOptions()).diff.identical


def test_replay_and_diff_exit_with_0_where_runs_are_equal_and_with_1_where_not(walked: Path, tmp_path, capsys):
    figures = tmp_path / "replay.json"
    assert main(["replay", str(walked), "--json", str(figures)]) == 0
    assert json.loads(figures.read_text())[0]["divergent"] == 0
    assert "the traces are equal to the bit" in capsys.readouterr().out
    other = tmp_path / "other"
    shutil.copytree(walked, other)
    assert main(["diff", str(walked), str(other)]) == 0
    lines = (other / "trace.jsonl").read_text().splitlines()
    for index in range(61, len(lines)):
        line = json.loads(lines[index])
        line["hash"] = "0" * 32
        line["reason"] = {}
        if index == 61:
            line["status"] = {"/look_and_step/walk/sequence": "FAILURE"}
        lines[index] = json.dumps(line)
    (other / "trace.jsonl").write_text("\n".join(lines) + "\n")
    assert main(["diff", str(walked), str(other)]) == 1
    assert "first divergent tick 60 at 1.20 s" in capsys.readouterr().out


def test_why_names_who_had_the_say(walked: Path, capsys):
    assert main(["why", str(walked), "--node", "wait_until_standing", "--at", "2"]) == 0
    assert f"{WALK}/on_the_way comes before it in {WALK} (sequence) and is RUNNING" in capsys.readouterr().out
    assert main(["why", str(walked), "--node", "wait_until_standin", "--at", "2"]) == 2
    assert 'did you mean "wait_until_standing"?' in capsys.readouterr().err
    assert main(["why", str(walked), "--node", "wait_until_standing", "--at", "9"]) == 2
    assert "the trace goes from 0 to 2.4 s" in capsys.readouterr().err


def test_what_cannot_be_replayed_is_refused(walked: Path, tmp_path: Path):
    with pytest.raises(UserError, match="a run writes it with --out"):
        replay(tmp_path, ReplayOptions())
    with pytest.raises(UserError, match="cannot be set"):
        replay(walked, ReplayOptions(assignments=("course.tilted_share=1.0",)))
    with pytest.raises(UserError, match='no node "/nothing"'):
        replay(walked, ReplayOptions(assignments=("/nothing.latency=1.0",)))
    (tmp_path / "run.json").write_text('{"format": 0}')
    with pytest.raises(UserError, match="needs format 1"):
        replay(tmp_path, ReplayOptions())
    table = json.loads((walked / "run.json").read_text())
    table["course"] = {"$class": "subprocess:Popen", "fields": {"args": ["true"]}}
    (tmp_path / "run.json").write_text(json.dumps(table))
    with pytest.raises(UserError, match="another version"):
        replay(tmp_path, ReplayOptions())
