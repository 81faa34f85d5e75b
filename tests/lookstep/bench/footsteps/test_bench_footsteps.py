import json
from pathlib import Path

import pytest

from lookstep.__main__ import BAD_INPUT, main

FLOOR = [[-1.0, -1.0], [3.0, -1.0], [3.0, 1.0], [-1.0, 1.0]]


def write_map(folder: Path, name: str, goal_x: float) -> None:
    region = {"origin": [0, 0, 0], "normal": [0, 0, 1], "quaternion_xyzw": [0, 0, 0, 1], "hull": FLOOR}
    content = {"start_position": [0, 0, 0], "goal_position": [goal_x, 0, 0], "regions": [region]}
    (folder / f"{name}.json").write_text(json.dumps(content))


def test_figures_and_pictures_of_every_map(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    write_map(tmp_path, "near", 1.0)
    write_map(tmp_path, "off_the_edge", 4.5)
    figures, pictures = tmp_path / "out.json", tmp_path / "pictures"
    arguments = ["bench", "footsteps", "--quick", "--data", str(tmp_path), "--json", str(figures)]
    assert main([*arguments, "--pictures", str(pictures)]) == 0
    found = json.loads(figures.read_text())
    assert (found["solved"], found["total"]) == (1, 2)
    assert found["maps"]["near"]["outcome"] == "goal_reached"
    assert found["maps"]["off_the_edge"]["outcome"] != "goal_reached" and found["maps"]["off_the_edge"]["reason"]
    for name, plan in found["maps"].items():
        assert {"steps", "cost", "median_ms", "p99_ms", "expansions"} <= set(plan)
        assert plan["p99_ms"] >= plan["median_ms"] > 0.0
        assert (pictures / f"{name}.png").stat().st_size > 1000
    assert set(found["small_foot"]["maps"]) == set(found["maps"])
    loop = found["three_step_ms"]
    assert loop["plans"] > loop["next_steps"] >= 2 and loop["kept"] >= 2
    assert loop["moved"] <= loop["next_steps"]
    assert found["three_step_ms"]["p99"] >= found["three_step_ms"]["median"] > 0.0
    assert "1 of 2 maps solved" in capsys.readouterr().out


def test_a_folder_without_maps_is_bad_input(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    assert main(["bench", "footsteps", "--quick", "--data", str(tmp_path)]) == BAD_INPUT
    assert "--data" in capsys.readouterr().err


def test_data_that_is_not_given_is_bad_input(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]):
    monkeypatch.delenv("LOOKSTEP_DATA", raising=False)
    assert main(["bench", "footsteps", "--quick"]) == BAD_INPUT
    assert "LOOKSTEP_DATA is not set" in capsys.readouterr().err
