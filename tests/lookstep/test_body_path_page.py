"""The page on the body path: its example runs, and its table has every end of a path."""

from __future__ import annotations

import re
from pathlib import Path

from skills.body_path import PathEnd

PAGE = (Path(__file__).parents[2] / "docs" / "body_path.md").read_text(encoding="utf-8")


def test_the_example_leads_around_the_wall(capsys):
    (example,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
    exec(compile(example, "body_path.md", "exec"), {})
    assert re.match(r"at the goal 6\.\d m \[\[0\.0, ", capsys.readouterr().out)


def test_the_table_has_every_end():
    assert re.findall(r"^\| `([A-Z_]+)` \|", PAGE, re.MULTILINE) == [end.name for end in PathEnd]
