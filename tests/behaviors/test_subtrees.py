"""Subtrees: typed ports, remapped keys, a scope of their own, and trees from other files."""

from __future__ import annotations

from pathlib import Path

import pytest
from scripted import ScriptedRobot, make, run, toys

from behaviors import Outcome, Tree, load_tree
from strict_yaml import YamlError

TWICE = """
tree: t
root:
  sequence:
    - GiveNumber: {out: [number], value: 1}
    - subtree: {tree: add_two, in: {start: number}, out: {end: three}}
    - subtree: {tree: add_two, name: again, in: {start: three}, out: {end: five}}
trees:
  add_two:
    ports: {in: {start: float}, out: {end: float}}
    root:
      sequence:
        - AddOne: {in: {number: start}, out: {sum: between}}
        - AddOne: {in: {number: between}, out: {sum: end}}
"""


def test_ports_of_a_subtree_are_the_keys_that_they_are_wired_to_and_other_keys_are_its_own():
    tree, robot = make(TWICE)
    run(tree, robot, 1)
    assert tree.outcome is Outcome.SUCCESS
    assert tree.blackboard.values() == {
        "number": 1.0,
        "add_two/between": 2.0,
        "three": 3.0,
        "again/between": 4.0,
        "five": 5.0,
    }


def test_a_subtree_is_replaced_by_its_root_under_the_name_of_its_use():
    tree, _ = make(TWICE)
    assert [node.path for node in tree.nodes] == [
        "/t",
        "/t/give_number",
        "/t/add_two",
        "/t/add_two/add_one",
        "/t/add_two/add_one_2",
        "/t/again",
        "/t/again/add_one",
        "/t/again/add_one_2",
    ]


def test_ports_pass_through_nested_subtrees():
    tree, robot = make(
        """
        tree: t
        root: {subtree: {tree: outer, out: {result: result}}}
        trees:
          outer:
            ports: {out: {result: float}}
            root:
              sequence:
                - GiveNumber: {out: [number], value: 4}
                - subtree: {tree: inner, in: {x: number}, out: {y: result}}
          inner:
            ports: {in: {x: float}, out: {y: float}}
            root: {AddOne: {in: {number: x}, out: {sum: y}}}
        """
    )
    run(tree, robot, 1)
    assert tree.blackboard["result"] == 5.0


def test_the_safe_stop_shares_the_keys_of_the_tree_but_not_those_of_its_subtrees():
    tree, _ = make(
        """
        tree: t
        ports: {in: {number: float}}
        root:
          sequence:
            - subtree: {tree: add, in: {x: number}}
        safe_stop:
          sequence:
            - subtree: {tree: add, in: {x: number}}
        trees:
          add:
            ports: {in: {x: float}}
            root: {AddOne: {in: {number: x}, out: {sum: y}}}
        """
    )
    assert list(tree.blackboard) == ["add/y", "number", "safe_stop/add/y"]


def test_a_tree_of_another_file_is_a_subtree(tmp_path: Path):
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "add.yaml").write_text(
        "{tree: add, ports: {in: {x: float}, out: {y: float}}, root: {AddOne: {in: {number: x}, out: {sum: y}}}}"
    )
    main = tmp_path / "main.yaml"
    main.write_text(
        """
tree: t
include: [parts/add.yaml]
root:
  sequence:
    - GiveNumber: {out: [number], value: 1}
    - subtree: {tree: add, in: {x: number}, out: {y: two}}
"""
    )
    tree, robot = Tree(load_tree(main, toys), ScriptedRobot()), ScriptedRobot()
    run(tree, robot, 1)
    assert tree.blackboard["two"] == 2.0


def test_problems_of_an_included_file_are_told_at_their_place(tmp_path: Path):
    spare = "trees: {spare: {root: Skripted}}"
    (tmp_path / "part.yaml").write_text(f"tree: part\nroot: {{sequnce: [Scripted]}}\n{spare}\n")
    main = tmp_path / "main.yaml"
    main.write_text("tree: t\ninclude: [part.yaml, none.yaml]\nroot: {Skripted: {}}\n")
    with pytest.raises(YamlError) as error:
        load_tree(main, toys)
    places = [(Path(problem.location.file).name, problem.location.line) for problem in error.value.problems]
    assert places == [("main.yaml", 2), ("main.yaml", 3), ("none.yaml", 1), ("part.yaml", 2), ("part.yaml", 3)]


def test_files_that_include_one_another_are_refused(tmp_path: Path):
    for name, other in (("a", "b"), ("b", "a")):
        (tmp_path / f"{name}.yaml").write_text(f"tree: {name}\ninclude: [{other}.yaml]\nroot: Scripted\n")
    with pytest.raises(YamlError, match=r"files include one another: a\.yaml -> b\.yaml -> a\.yaml"):
        load_tree(tmp_path / "a.yaml", toys)
