"""docs/perception.md: its example runs, its commands and parameters exist, its pictures are there and small."""

import re
from pathlib import Path

import pytest

from lookstep.__main__ import main
from lookstep.commands import picture
from skills.regions import RegionParameters

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGE = (DOCS / "perception.md").read_text()


def test_the_example_finds_the_floor(capsys):
    (example,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    assert example.count("\n") <= 12
    exec(example, {})
    assert capsys.readouterr().out == "2.51 m^2, normal [0. 0. 1.], 1 parts\n"


def test_pictures_are_there_and_small():
    names = re.findall(r"\]\((images/\S+)\)", PAGE)
    assert len(names) == 6
    assert [name for name in names if (DOCS / name).stat().st_size > 300_000] == []


def test_every_key_that_the_page_turns_is_a_parameter():
    table = PAGE.split("## Which number to turn")[1].split("## Limits")[0]
    keys = {key for row in table.splitlines() if row.startswith("| ") for key in re.findall(r"`(\w+)`", row)}
    assert len(keys) > 8
    assert keys <= {*RegionParameters.__dataclass_fields__}


def test_named_options_of_commands_exist(capsys):
    with pytest.raises(SystemExit):
        main(["regions", "--help"])
    told = capsys.readouterr().out
    alone = PAGE.split("## Use it alone")[1].split("From Python")[0]
    assert [option for option in re.findall(r"--[a-z]+", alone) if option not in told] == []
    for view in ("depth", "regions", "map", "heights"):
        assert view in picture.VIEWS


def test_causes_of_rejection_are_those_of_the_code():
    source = (DOCS.parent / "skills" / "regions" / "extraction.py").read_text()
    (row,) = [line for line in PAGE.splitlines() if line.startswith("| hatched")]
    assert set(re.findall(r"`([a-z -]+)`", row)) == set(re.findall(r'"([a-z -]+)", f?"', source))
