"""docs/footsteps.md: its example runs, every reason and parameter that it names exists, and none is left out."""

import re
from pathlib import Path

import pytest

from lookstep.__main__ import main
from skills.footsteps import FootstepParameters, PlanOutcome
from skills.footsteps.rejections import REASONS

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "footsteps.md").read_text(encoding="utf-8")


def test_the_example_steps_onto_a_block(capsys: pytest.CaptureFixture[str]):
    (example,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    assert len([line for line in example.splitlines() if line and not line.startswith(("import", "from"))]) <= 10
    exec(example, {})
    printed = capsys.readouterr().out
    assert printed.startswith("goal_reached ['")
    assert "left 1.0 m" in printed and "right 1.0 m" in printed


def test_every_reason_is_named_with_limits_that_exist():
    table = PAGE.split("## Why a step is rejected")[1].split("##")[0]
    rows = [row.split("|") for row in table.splitlines() if row.startswith("| ") and "`" in row]
    named = {reason.strip() for row in rows for reason in row[1].split(",")}
    assert named == set(REASONS) - {""}
    limits = {limit for row in rows for limit in re.findall(r"`(\w+)`", row[2])}
    assert limits <= set(FootstepParameters.__dataclass_fields__)


def test_every_outcome_is_explained():
    table = PAGE.split("| outcome | means |")[1].split("##")[0]
    assert re.findall(r"^\| `(\w+)`", table, re.MULTILINE) == [outcome.value for outcome in PlanOutcome]


@pytest.mark.parametrize("command", ["run", "plans", "plan"])
def test_the_commands_of_the_page_exist(command: str, capsys: pytest.CaptureFixture[str]):
    assert f"$ lookstep {command} " in PAGE
    with pytest.raises(SystemExit) as ended:
        main([command, "--help"])
    assert ended.value.code == 0
    assert "example:" in capsys.readouterr().out
