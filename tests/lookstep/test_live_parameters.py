"""Parameters that change while the robot walks: between two ticks, within their bounds, and recorded."""

from __future__ import annotations

import json
from pathlib import Path

from behaviors.recorded_trace import RecordedTrace
from lookstep.options import RunOptions
from lookstep.replay import ReplayOptions, replay
from lookstep.walk import walk

WALK = "/look_and_step/walk/sequence/go/walk_to/on_the_way/follow_path"
WAIT = f"{WALK}/selector/go_on/halt_unless/take_a_step/wait_for_swing"


class Person:
    """Saves the file at certain robot times, and reads what the robot says."""

    def __init__(self, file: Path, texts: dict[float, str]) -> None:
        self.file, self.texts = file, dict(texts)
        self.said: list[str] = []

    def observe(self, moment) -> None:
        self.said += [line.text for line in moment.log]
        for time in [time for time in self.texts if time <= moment.time]:
            self.file.write_text(self.texts.pop(time))


def test_saved_parameters_are_applied_between_ticks_recorded_and_replayed(tmp_path: Path):
    file = tmp_path / "live.yaml"
    person = Person(
        file,
        {
            0.1: "footsteps.reach: 0.35\n",
            0.5: f"footsteps.reach: 0.35\n{WAIT}.fraction: 0.2\n",
            0.6: "footsteps.reach: 9\nfootsteps.reech: 1\nwalking.pelvis_height: 1\n/nothing.x: 1\nbroken\n",
            0.7: "footsteps.reach: 9\nfootsteps.reech: 1\nwalking.pelvis_height: 1\n/nothing.x: 1\n",
        },
    )
    options = RunOptions(
        course="flat",
        world="kinematic",
        time_limit=1.0,
        assignments=("camera.resolution=0.3125",),
        live=file,
        out=tmp_path / "out",
    )
    summary = walk(options, person)
    lines = [json.loads(line) for line in (tmp_path / "out" / "trace.jsonl").read_text().splitlines()[1:]]
    changes = [(line["time"], change) for line in lines for change in line.get("parameters", [])]
    assert [(change["target"], change["key"], change["value"]) for _, change in changes] == [
        ("footsteps", "reach", 0.35),
        (WAIT, "fraction", 0.2),
    ]
    assert 0.1 < changes[0][0] < 0.2 and 0.5 < changes[1][0] < 0.6
    warnings = [text.removeprefix(f"{file}:") for text in person.said if text.startswith(f"{file}:")]
    assert any("expected" in text or "could not find" in text for text in warnings)
    assert any(text.startswith("1:18: footsteps.reach: got 9") and "0.1 .. 1 m" in text for text in warnings)
    assert any(text.startswith('2:18: footsteps: no parameter "reech"; did you mean "reach"?') for text in warnings)
    assert "3:24: walking is taken when a run begins; it cannot change while the robot walks" in warnings
    assert any(text.startswith('4:13: no node or subject "/nothing"') for text in warnings)
    diff = replay(tmp_path / "out", ReplayOptions()).diff
    assert diff.identical and summary.trace_hash == lines[-1]["hash"]


def test_a_tree_that_is_saved_takes_over_at_the_next_goal_and_the_run_replays(tmp_path: Path):
    tree, live = tmp_path / "mine.yaml", tmp_path / "live.yaml"
    text = "tree: mine\nroot:\n  sequence:\n    - WaitForGoal: {out: [goal]}\n    - Wait: {duration: 9}\n"
    tree.write_text(text)

    class Editor(Person):
        def observe(self, moment) -> None:
            super().observe(moment)
            if moment.time == 0.2:
                tree.write_text(text.replace("9", "x"))
            if moment.time == 0.4:
                tree.write_text(text.replace("duration: 9", "duration: 8"))

    person = Editor(live, {0.3: "goal: [1, 0, 0]\n", 0.5: "goal: [2, 0, 0]\n"})
    options = RunOptions(
        tree=str(tree), course="flat", world="kinematic", time_limit=1.0, live=live, reload=True, out=tmp_path / "out"
    )
    walk(options, person)
    assert any(text.startswith(f"{tree} is not reloaded: {tree}:5:24:") for text in person.said)
    assert f"{tree} was saved and has taken over" in person.said
    trace = RecordedTrace(tmp_path / "out" / "trace.jsonl")
    assert [round(tick.time, 2) for tick in trace.ticks() if tick.taken_over] == [0.52]
    tree.unlink()
    assert replay(tmp_path / "out", ReplayOptions()).diff.identical
    assert replay(tmp_path / "out", ReplayOptions(outputs=True)).diff.identical
