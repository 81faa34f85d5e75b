"""The page on trees: its rules name tests that exist, and its examples work."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from flow_corpus import CORPUS as FLOW_CORPUS
from scripted import ScriptedRobot, run, toys
from test_tree_file_errors import CORPUS as FILE_CORPUS

import behaviors
from behaviors import Outcome, Registry, Tree, parse_tree

HERE = Path(__file__).parent
PAGE = (HERE.parents[1] / "docs" / "trees.md").read_text(encoding="utf-8")
TESTS = {path.name: path.read_text(encoding="utf-8") for path in HERE.glob("test_*.py")}


def test_every_rule_names_tests_that_exist():
    rules = re.findall(r"^(\d+)\. (.*?)(?=^\d+\. |^#|^\||\Z)", PAGE, re.MULTILINE | re.DOTALL)
    assert [int(number) for number, _ in rules] == list(range(1, len(rules) + 1))
    for number, text in rules:
        files = re.findall(r"`(test_\w+\.py)`", text)
        assert files and set(files) <= set(TESTS), number
        for name in re.findall(r"`(test_\w+)`", text):
            assert any(f"def {name}(" in TESTS[file] for file in files), (number, name)
        for file, corpus in (("test_tree_file_errors", FILE_CORPUS), ("test_flow_errors", FLOW_CORPUS)):
            for group in re.findall(rf"`{file}\.py`:((?:\s+`[^`]+`,?)+)", text):
                for case in re.findall(r"`([^`]+)`", group):
                    assert case in corpus or case.startswith("test_"), (number, case)


def test_the_example_runs():
    (text,) = re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL)
    robot = ScriptedRobot()
    tree = Tree(parse_tree(text, toys), robot)
    tree.set_input("number", 3.0)
    run(tree, robot, 12)
    assert tree.blackboard["answer"] == 11.0
    assert "rate_limit/sequence/add_two/between" in tree.blackboard
    tree.shutdown()


def test_the_leaves_work(monkeypatch: pytest.MonkeyPatch):
    registry = Registry()
    monkeypatch.setattr(behaviors, "leaf", registry)
    for code in re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL):
        exec(compile(code, "trees.md", "exec", dont_inherit=True), {"__name__": __name__})
    text = "{tree: t, ports: {in: {d: float}}, root: {sequence: [Square: {in: {number: d}, out: {square: s}}, "
    text += "KeepBelow: {in: {distance: s}, out: [rest], limit: 5}]}}"
    robot = ScriptedRobot()
    tree = Tree(parse_tree(text, registry), robot)
    tree.set_input("d", 2.0)
    run(tree, robot, 12)
    assert tree.outcome is Outcome.SUCCESS and tree.blackboard["rest"] == 1.0
    tree.shutdown()
