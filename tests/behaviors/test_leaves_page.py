"""The page on leaves: its leaf and tree work, `tree` and `check` say what it prints, its table is the registry's."""

from __future__ import annotations

import dataclasses
import importlib
import re
import subprocess
import sys
from pathlib import Path

import pytest
from scripted import ScriptedRobot, footstep, run

import behaviors
from behaviors import Outcome, Registry, Tree, draw, load_tree
from behaviors.blackboard import type_name
from behaviors.leaf import declared_inputs, declared_outputs
from skills.footsteps import FootstepParameters
from skills.geometry.pose import Pose
from skills.height_map import HeightMapParameters
from skills.regions import MemoryParameters, RegistrationParameters
from skills.walking import StepEvent, StepEventKind
from strict_yaml import YamlError, parse_document

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "leaves.md").read_text(encoding="utf-8")
LEAF, RUNNER = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
TREE, BROKEN = re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL)
DRAWING, PROBLEMS = re.findall(r"```text\n(.*?)```", PAGE, re.DOTALL)


def shipped_leaves() -> Registry:
    importlib.import_module("behaviors.leaves")
    importlib.import_module("behaviors.plain_leaves")
    return behaviors.leaf


@pytest.fixture
def registry(monkeypatch: pytest.MonkeyPatch) -> Registry:
    """The shipped leaves and that of the page."""
    leaves = Registry()
    for cls in shipped_leaves().classes:
        leaves(cls)
    monkeypatch.setattr(behaviors, "leaf", leaves)
    exec(compile(LEAF, "my_leaves.py", "exec", dont_inherit=True), {"__name__": "my_leaves"})
    return leaves


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with the files of the page."""
    for name, text in (
        ("my_leaves.py", LEAF),
        ("my_lookstep.py", RUNNER),
        ("a_few_steps.yaml", TREE),
        ("broken.yaml", BROKEN),
    ):
        (tmp_path / name).write_text(text, encoding="utf-8")
    return tmp_path


def test_the_tree_with_the_new_leaf_ends_after_so_many_steps(registry, folder):
    robot = ScriptedRobot()
    parameters = {
        "region_memory": MemoryParameters(),
        "registration": RegistrationParameters(),
        "height_map": HeightMapParameters(),
        "footsteps": FootstepParameters(),
    }
    tree = Tree(load_tree(folder / "a_few_steps.yaml", registry), robot, parameters=parameters)
    for made in range(6):
        assert tree.outcome is Outcome.RUNNING
        run(tree, robot, 5)
        assert tree.blackboard["left"] == 6 - made
        robot.events = (StepEvent(StepEventKind.COMPLETED, robot.time, footstep(made), Pose.identity()),)
    robot.commands.clear()
    run(tree, robot, 1)
    assert tree.blackboard["left"] == 0
    assert [name for name, _ in robot.commands] == ["pause_walking"]
    assert tree.outcome is Outcome.SUCCESS
    tree.shutdown()


def test_tree_draws_what_the_page_shows(registry, folder):
    assert draw(load_tree(folder / "a_few_steps.yaml", registry)).startswith(DRAWING)


def test_check_says_what_the_page_shows(folder):
    with pytest.raises(YamlError) as error:
        load_tree(folder / "broken.yaml")
    told = [str(problem).removeprefix(f"{folder}/") for problem in error.value.problems]
    assert [re.sub(r"\(leaves: .*\)", "(leaves: ...)", line) for line in told] == PROBLEMS.splitlines()


def test_the_command_line_knows_the_leaf_by_the_pages_script(folder):
    command = [sys.executable, "my_lookstep.py", "check", "a_few_steps.yaml"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (0, "a_few_steps.yaml: sound (tree)\n"), done.stderr


def test_the_setting_that_the_page_names_exists(registry, folder):
    (target, value) = re.findall(r"--set (/\S+)=(\S+)", PAGE)[0]
    path, _, key = target.rpartition(".")
    settings = {path: {key: parse_document(value, "page").value}}
    tree = Tree(load_tree(folder / "a_few_steps.yaml", registry), ScriptedRobot(), settings=settings)
    assert tree.node(path).parameters.most == 3


def test_the_table_lists_every_shipped_leaf_with_its_ports_and_parameters():
    # Other tests may have registered leaves of their own.
    shipped = [cls for cls in shipped_leaves().classes if cls.__module__.startswith("behaviors.")]
    assert re.findall(r"^\| `[A-Z].*$", PAGE, re.MULTILINE) == [row(cls) for cls in shipped]


def row(cls: type) -> str:
    """The line of a leaf."""
    ports = [
        ", ".join(f"`{name}: {type_name(port.type)}`" for name, port in declared(cls).items())
        for declared in (declared_inputs, declared_outputs)
    ]
    numbers = []
    for field in dataclasses.fields(cls.Parameters):  # type: ignore[attr-defined]
        unit = "" if field.metadata["unit"] == "1" else f" {field.metadata['unit']}"
        numbers.append(f"`{field.name}` {field.default:g}{unit}")
    does = (cls.__doc__ or "").splitlines()[0]
    return f"| `{cls.__name__}` | {does} | {ports[0]} | {ports[1]} | {', '.join(numbers)} |"
