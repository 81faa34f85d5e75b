"""The command makes the walks that are missing, once, and says by its exit status whether enough went well."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from some_walks import row

from lookstep.__main__ import main
from lookstep.evaluation import evaluate
from lookstep.evaluation.run_row import RunRow
from lookstep.options import RunOptions
from lookstep.summary import Outcome

SUITE = """
about: Walks
preset: fast
worlds: [kinematic, physics]
cases:
  - {name: flat, course: flat, seeds: 3, may_fail: {physics: 0}}
  - {name: rough, course: rough, seeds: 2}
"""


@pytest.fixture
def made(monkeypatch: pytest.MonkeyPatch) -> list[RunOptions]:
    """The walks that were made; that of seed 2 falls in physics."""
    walks: list[RunOptions] = []

    def run(options: RunOptions) -> RunRow:
        walks.append(options)
        fell = options.seed == 2 and options.world == "physics"
        return row(options, outcome=Outcome.FELL if fell else Outcome.GOAL_REACHED)

    monkeypatch.setattr(evaluate, "run", run)
    return walks


@pytest.fixture
def suite(tmp_path: Path) -> str:
    file = tmp_path / "suite.yaml"
    file.write_text(SUITE)
    return str(file)


def test_every_case_is_walked_in_every_world_over_every_seed(made, suite, tmp_path, capsys):
    figures, table = tmp_path / "figures.json", tmp_path / "table.md"
    files = ["--json", str(figures), "--table", str(table)]
    assert main(["evaluate", "--suite", suite, "--workers", "1", *files]) == 1
    assert len(made) == len(set(made)) == 10
    assert {(walk.course, walk.world, walk.seed) for walk in made} == {
        (course, world, seed)
        for course, seeds in (("flat", 3), ("rough", 2))
        for world in ("kinematic", "physics")
        for seed in range(seeds)
    }
    cases = json.loads(figures.read_text())["cases"]
    assert (cases["flat"]["physics"]["ok"], cases["flat"]["physics"]["of"]) == (2, 3)
    assert cases["flat"]["physics"]["missed"] and not cases["flat"]["kinematic"]["missed"]
    assert [failure["seed"] for failure in cases["flat"]["physics"]["failures"]] == [2]
    assert "| flat | physics | 2/3 |" in table.read_text()
    assert "Statistics of runs" in capsys.readouterr().out


def test_walks_that_a_file_has_are_not_made_again(made, suite, tmp_path):
    rows = str(tmp_path / "rows.jsonl")
    begin = ["evaluate", "--suite", suite, "--workers", "1", "--jsonl", rows, "--cases", "flat"]
    assert main([*begin, "--world", "kinematic", "--seeds", "2"]) == 0
    assert [walk.seed for walk in made] == [0, 1]
    assert main([*begin, "--world", "kinematic"]) == 0
    assert [walk.seed for walk in made] == [0, 1, 2]
    assert main([*begin, "--world", "kinematic", "--set", "footsteps.reach=0.4", "--seeds", "1-2"]) == 0
    assert [(walk.seed, walk.assignments) for walk in made[3:]] == [(s, ("footsteps.reach=0.4",)) for s in (1, 2)]
    assert len(Path(rows).read_text().splitlines()) == 5


def test_courses_are_cases_with_default_seeds(made, tmp_path):
    assert main(["evaluate", "--courses", "flat", "--seeds", "4,7-8", "--preset", "fast,drift", "--workers", "1"]) == 0
    assert [(walk.course, walk.seed, walk.world, walk.preset) for walk in made] == [
        ("flat", seed, "physics", "fast,drift") for seed in (4, 7, 8)
    ]


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--suite", "paper", "--cases", "ruogh"], 'no case "ruogh"; did you mean "rough"?'),
        (["--suite", "papr"], 'unknown suite "papr"; did you mean "paper"?'),
        (["--courses", "ruogh"], 'unknown course "ruogh"; did you mean "rough"?'),
        (["--courses", "flat", "--preset", "fast,drft"], 'unknown preset "drft"; did you mean "drift"?'),
        (["--courses", "flat", "--set", "footsteps.reech=1"], "reech"),
        (["--quick", "--courses", "flat"], "--quick: has walks of its own"),
        (["--courses", "flat", "--jsonl", "no/rows.jsonl"], "--jsonl no/rows.jsonl: the folder no does not exist"),
    ],
)
def test_bad_input_is_told_before_any_walk(arguments, told, made, capsys):
    assert main(["evaluate", "--workers", "1", *arguments]) == 2
    assert told in capsys.readouterr().err
    assert made == []


@pytest.mark.parametrize("seeds", ["0", "x", "3-1", "3-", ",", "1,-2"])
def test_seeds_that_are_none_are_refused(seeds, capsys):
    with pytest.raises(SystemExit) as end:
        main(["evaluate", "--seeds", seeds])
    assert end.value.code == 2
    assert "--seeds" in capsys.readouterr().err
