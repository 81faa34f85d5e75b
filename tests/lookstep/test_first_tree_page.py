"""The newcomer's page: its leaf and tree are sound and walk a metre, and its commands say what it says."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from lookstep.__main__ import main

PAGE = (Path(__file__).parents[2] / "docs" / "first_tree.md").read_text(encoding="utf-8")
(LEAF,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
(TREE,) = re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL)
(PROBLEM,) = re.findall(r"```text\n(.*?)```", PAGE, re.DOTALL)
COMMANDS = [line.split()[2:] for line in re.findall(r"^\./run lookstep .*$", PAGE, re.MULTILINE)]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The clone, as far as the reader writes into it."""
    (tmp_path / "my_leaves.py").write_text(LEAF, encoding="utf-8")
    (tmp_path / "stroll.yaml").write_text(TREE, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_pages_commands_do_what_it_says(folder: Path, capsys: pytest.CaptureFixture[str]):
    own = {command[2]: command for command in COMMANDS if command[0] == "--leaves"}
    assert main(own["check"]) == 0
    assert capsys.readouterr().out == "stroll.yaml: sound (tree)\n"
    assert main(own["tree"]) == 0
    # The recording and physics are left out and the camera made small to save the suite's time; the walk is the page's.
    words = own["run"][: own["run"].index("--record")]
    walk = [*words, "--world", "kinematic", "--out", "runs/stroll", "--set", "camera.resolution=0.3125"]
    assert main(walk) == 1
    assert "stopped: the tree has succeeded" in capsys.readouterr().out
    assert main(next(command for command in COMMANDS if command[0] == "why")) == 0
    assert "wait_for_swing" in capsys.readouterr().out


def test_the_pages_mistake_is_told_as_it_says(folder: Path, capsys: pytest.CaptureFixture[str]):
    (folder / "stroll.yaml").write_text(TREE.replace("check: walked", "check: waked"), encoding="utf-8")
    assert main(["--leaves", "my_leaves.py", "check", "stroll.yaml"]) == 2
    assert capsys.readouterr().err.splitlines()[0] == PROBLEM.strip()
