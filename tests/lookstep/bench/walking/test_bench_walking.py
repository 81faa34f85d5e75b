"""The benchmark writes its figures, each under the name that programs read."""

import json

import pytest

from lookstep.__main__ import main
from lookstep.bench.walking import measure
from lookstep.bench.walking.cases import CASES
from lookstep.bench.walking.maps import maps_of, push_map_trials, speed_map_trials
from lookstep.bench.walking.trial import TrialResult


def test_figures_are_written_for_programs_and_people(tmp_path, capsys, monkeypatch):
    extent = measure.Extent(seeds=2, steps=3, ticks=60, realtime_steps=3, programs=30)
    monkeypatch.setattr(measure, "QUICK", extent)
    file = tmp_path / "walking.json"
    arguments = ["--cases", "push_standing_600", "--workers", "1", "--quick", "--seeds", "2", "--json", str(file)]
    assert main(["bench", "walking", *arguments]) == 0
    figures = json.loads(file.read_text())
    assert 0.0 < figures["tick_ms"]["median"] <= figures["tick_ms"]["p99"]
    assert figures["ticks"] >= 60 and figures["calibration_ms"]["median"] > 0.0
    assert {"dynamics", "balance", "step_adjustment", "program", "factorise", "iterate"} < set(figures["tick_parts_ms"])
    assert set(figures["realtime_factor"]) == {"physics", "kinematic"}
    success = figures["success"]["push_standing_600"]
    assert success["of"] == 2 and 0.0 <= success["low"] <= success["ok"] / 2 <= success["high"] <= 1.0
    exact, ours = figures["solvers"]["DAQP"], figures["solvers"]["OSQP"]
    assert exact["failed"] == ours["failed"] == 0
    assert exact["force_error_n"]["p99"] == 0.0 and 0.0 < ours["force_error_n"]["median"] < 5.0
    told = capsys.readouterr().out
    assert "push_standing_600" in told and "calibration kernel" in told


def test_an_unknown_case_is_told_with_all_that_there_are(capsys):
    assert main(["bench", "walking", "--cases", "flying"]) == 2
    told = capsys.readouterr().err
    assert "flying" in told and all(name in told for name in CASES)


@pytest.mark.parametrize("trials", [push_map_trials(), speed_map_trials(2)], ids=["push_map", "speed_map"])
def test_maps_have_every_trial_in_its_cell_in_the_order_of_numbers(trials):
    results = [TrialResult(t.case, t.seed, "fell" if i % 2 else "", 1, (), 0.0, 1.0, 1.0) for i, t in enumerate(trials)]
    (walking_map,) = maps_of(results[::-1])
    assert sum(tried for _, tried in walking_map.cells.values()) == len(trials)
    assert sum(ok for ok, _ in walking_map.cells.values()) == (len(trials) + 1) // 2
    rows = [float(row.split()[0]) for row in walking_map.rows]
    assert rows == sorted(rows) and len(walking_map.rows) * len(walking_map.columns) == len(walking_map.cells)
