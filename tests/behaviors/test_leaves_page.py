"""The page on leaves: its leaf and tree work, `tree` and `check` say what it prints, its table is the registry's."""

from __future__ import annotations

import importlib
import os
import re
import subprocess
import sys
import tomllib
from importlib.metadata import EntryPoint
from pathlib import Path

import pytest
from scripted import ScriptedRobot, footstep, run

import behaviors
from behaviors import Outcome, Registry, Tree, draw, load_tree, loader
from behaviors.text import leaf_table
from skills.footsteps import FootstepParameters
from skills.geometry.pose import Pose
from skills.height_map import HeightMapParameters
from skills.regions import MemoryParameters, RegistrationParameters
from skills.walking import StepEvent, StepEventKind
from strict_yaml import YamlError, parse_document

ROOT = Path(__file__).parents[2]
PAGE = (ROOT / "docs" / "leaves.md").read_text(encoding="utf-8")
(LEAF,) = re.findall(r"```python\n(.*?)```", PAGE, re.DOTALL)
(PACKAGE,) = re.findall(r"```toml\n(.*?)```", PAGE, re.DOTALL)
TREE, BROKEN = re.findall(r"```yaml\n(.*?)```", PAGE, re.DOTALL)
MODELINE, DRAWING, PROBLEMS = re.findall(r"```text\n(.*?)```", PAGE, re.DOTALL)


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


def test_the_pages_commands_name_its_files():
    own = re.findall(r"^\./run lookstep (--leaves \S+) (\w+) (?:--tree )?(\S+)", PAGE, re.MULTILINE)
    assert own == [("--leaves my_leaves.py", command, "a_few_steps.yaml") for command in ("check", "tree", "run")]


def test_the_leaves_of_an_installed_package_are_known_by_its_entry_point(folder):
    entry_points = tomllib.loads(PACKAGE)["project"]["entry-points"]["lookstep.leaves"]
    ((name, module),) = entry_points.items()
    site = folder / "site"
    package, _, file = module.partition(".")
    (site / package).mkdir(parents=True)
    (site / package / "__init__.py").write_text("")
    (site / package / f"{file}.py").write_text(LEAF)
    metadata = site / "my_robot_behaviors-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: my-robot-behaviors\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(f"[lookstep.leaves]\n{name} = {module}\n")
    done = lookstep(["check", "a_few_steps.yaml"], folder, path=site)
    assert (done.returncode, done.stdout) == (0, "a_few_steps.yaml: sound (tree)\n"), done.stderr


def test_leaves_of_a_package_that_cannot_be_loaded_are_told(monkeypatch: pytest.MonkeyPatch):
    broken = EntryPoint("my_robot", "nothing_at_all", "lookstep.leaves")
    monkeypatch.setattr(loader, "entry_points", lambda group: [broken])
    with pytest.raises(
        YamlError, match=r'entry point "my_robot" of lookstep\.leaves: cannot load nothing_at_all: Module'
    ):
        behaviors.known_leaves()


def lookstep(arguments: list[str], folder: Path, path: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Run a command in a process of its own."""
    environment = {**os.environ, "PYTHONPATH": "" if path is None else str(path)}
    command = [sys.executable, "-m", "lookstep", *arguments]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False, env=environment)


def test_the_modeline_is_the_one_that_schema_prints():
    assert MODELINE.strip() == "# yaml-language-server: $schema=.schemas/tree.schema.json"


def test_the_setting_that_the_page_names_exists(registry, folder):
    (target, value) = re.findall(r"--set (/\S+)=(\S+)", PAGE)[0]
    path, _, key = target.rpartition(".")
    settings = {path: {key: parse_document(value, "page").value}}
    tree = Tree(load_tree(folder / "a_few_steps.yaml", registry), ScriptedRobot(), settings=settings)
    assert tree.node(path).parameters.most == 3


def test_the_table_lists_every_shipped_leaf_with_its_ports_and_parameters():
    # Other tests may have registered leaves of their own.
    shipped = [cls for cls in shipped_leaves().classes if cls.__module__.startswith("behaviors.")]
    registry = Registry()
    for cls in shipped:
        registry(cls)
    assert leaf_table(registry) in PAGE
