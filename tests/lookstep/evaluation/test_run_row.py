"""Rows survive being written, also when the last one was not finished, and a walk that breaks off is a row."""

from __future__ import annotations

from typing import Any

import pytest
from some_walks import row, summary

from lookstep.errors import UserError
from lookstep.evaluation import run_row
from lookstep.evaluation.run_row import RowFile, RunRow, read_rows, run, specification
from lookstep.options import RunOptions
from lookstep.summary import Outcome, PauseCounts
from lookstep.walk import INTERRUPTED
from strict_yaml import YamlError

OPTIONS = RunOptions(course="rough", seed=3, preset="fast", assignments=("course.rows=6",), goal=(2.0, 0.0, 0.1))


def test_a_row_is_read_as_it_was_written():
    for written in (
        row(OPTIONS, outcome=Outcome.FELL, min_support_fraction=None, pauses=PauseCounts(1, 0.7, {"no_plan": 1})),
        RunRow(options=OPTIONS, code="1", summary=None, error="ValueError: broken"),
    ):
        read = RunRow.from_json(written.to_json())
        assert read == written
        assert read.key == specification(OPTIONS)


def test_only_what_decides_a_walk_makes_another_specification(tmp_path):
    assert specification(OPTIONS) == specification(RunOptions(**_fields(OPTIONS), out=tmp_path))
    changes: list[dict[str, Any]] = [{"seed": 4}, {"world": "kinematic"}, {"assignments": ()}, {"preset": None}]
    for change in changes:
        assert specification(RunOptions(**(_fields(OPTIONS) | change))) != specification(OPTIONS)


def test_a_line_that_was_not_finished_is_cut_off_and_the_next_one_begins_there(tmp_path):
    path = tmp_path / "rows.jsonl"
    first, second = row(OPTIONS), row(RunOptions(seed=9))
    path.write_text(first.to_json() + "\n" + second.to_json()[:100])
    assert read_rows(path) == [first]
    file = RowFile(path)
    file.add(second)
    file.close()
    assert read_rows(path) == [first, second]


def test_a_line_that_is_no_row_is_told_with_its_place(tmp_path):
    path = tmp_path / "rows.jsonl"
    path.write_text(row(OPTIONS).to_json() + '\n{"specification": {}}\n')
    with pytest.raises(UserError, match=r"rows\.jsonl:2: not a row of this version"):
        read_rows(path)
    assert read_rows(tmp_path / "missing.jsonl") == []


def test_what_breaks_a_walk_off_is_told_in_its_row_but_bad_input_is_not_a_walk(monkeypatch):
    def broken(options):
        raise ZeroDivisionError("no ground")

    monkeypatch.setattr(run_row, "walk", broken)
    broke_off = run(OPTIONS)
    assert (broke_off.outcome, broke_off.reason) == (Outcome.ERROR, "ZeroDivisionError: no ground")
    monkeypatch.undo()
    with pytest.raises(YamlError, match="unknown preset"):
        run(RunOptions(preset="fats"))


def test_a_walk_that_somebody_has_ended_is_no_row(monkeypatch):
    ended = summary(OPTIONS, outcome=Outcome.STOPPED, reason=INTERRUPTED)
    monkeypatch.setattr(run_row, "walk", lambda options: ended)
    with pytest.raises(KeyboardInterrupt):
        run(OPTIONS)


def _fields(options: RunOptions) -> dict[str, Any]:
    return {name: getattr(options, name) for name in ("course", "seed", "preset", "assignments", "goal")}
