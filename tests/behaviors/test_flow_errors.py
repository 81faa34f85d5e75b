"""What a tree is told whose nodes are sound one by one but do not fit together."""

from __future__ import annotations

from pathlib import Path

import pytest
from flow_corpus import CORPUS, REMARKS, measures
from scripted import ScriptedRobot, make, run, toys

from behaviors import Outcome, Tree, load_tree, parse_tree
from skills.footsteps import FootstepPlan, PlanOutcome
from strict_yaml import YamlError


@pytest.mark.parametrize("name", CORPUS)
def test_parts_that_do_not_fit_are_told_at_their_places(name: str):
    text, expected = CORPUS[name]
    with pytest.raises(YamlError) as error:
        parse_tree(text.lstrip("\n"), measures, "t.yaml")
    assert str(error.value) == expected


@pytest.mark.parametrize("name", REMARKS)
def test_what_may_be_meant_is_a_remark(name: str):
    text, expected = REMARKS[name]
    assert "\n".join(map(str, parse_tree(text.lstrip("\n"), measures, "t.yaml").remarks)) == expected


SOUND = {
    "beside it in a parallel": "parallel: [AddOne: {in: {number: n}}, GiveNumber: {out: {number: n}}]",
    "in both branches": "sequence: [selector: [sequence: [Scripted, GiveNumber: {name: a, out: {number: n}}], "
    "GiveNumber: {name: b, out: {number: n}}], AddOne: {in: {number: n}}]",
    "where the guard must have succeeded": "sequence: [run_while: {condition: {GiveNumber: {out: {number: n}}}, "
    "child: {AddOne: {in: {number: n}}}}]",
    "when all must succeed": "sequence: [parallel: [Scripted, GiveNumber: {out: {number: n}}], "
    "AddOne: {in: {number: n}}]",
    "by a suppressor that does not wait": "suppress: {condition: {check: n > 0}, "
    "child: {GiveNumber: {out: {number: n}}}}",
    "after a failure that was turned": "sequence: [inverter: {sequence: [GiveNumber: {out: {number: n}}, "
    "force_failure: {AddOne: {in: {number: n}}}]}]",
}


@pytest.mark.parametrize("name", SOUND)
def test_a_key_that_will_be_there_is_no_problem(name: str):
    parse_tree(f"{{tree: t, root: {{{SOUND[name]}}}}}", measures)


@pytest.mark.parametrize(
    ("condition", "holds"),
    [
        ("n > 0 and n < 5", True),
        ("not n > 5 and label == 'x'", True),
        ("n * 2 - 1 >= 5.0 or false", True),
        ("0 < n <= 2.5", False),
        ("on_top", False),
        ("on_top == false", True),
        ("-n + 3 == 0", True),
    ],
)
def test_a_condition_decides_as_it_reads(condition: str, holds: bool):
    tree, robot = make(
        f'{{tree: t, ports: {{in: {{n: float, on_top: bool, label: str}}}}, root: {{check: "{condition}"}}}}'
    )
    for key, value in (("n", 3.0), ("on_top", False), ("label", "x")):
        tree.set_input(key, value)
    run(tree, robot, 1)
    assert tree.outcome is (Outcome.SUCCESS if holds else Outcome.FAILURE)


@pytest.mark.parametrize(
    ("condition", "holds"),
    [
        ('plan.outcome == "goal_reached"', False),
        ('plan.outcome != "goal_reached" and plan.cost < 2.0', True),
        ("plan.plan_id + 1 == 8", True),
    ],
)
def test_a_condition_reads_fields_and_compares_choices_with_their_names(condition: str, holds: bool):
    text = f"{{tree: t, ports: {{in: {{plan: FootstepPlan}}}}, root: {{check: '{condition}'}}}}"
    robot = ScriptedRobot()
    tree = Tree(parse_tree(text), robot)
    tree.set_input("plan", FootstepPlan(7, 0, PlanOutcome.PARTIAL, "", (), 1.5, 10))
    run(tree, robot, 1)
    assert tree.outcome is (Outcome.SUCCESS if holds else Outcome.FAILURE)


def test_a_condition_over_nothing_fails_with_a_reason():
    tree, robot = make("{tree: t, ports: {in: {n: float}}, root: {check: n > 0}}")
    run(tree, robot, 1)
    assert (tree.outcome, tree.reason) == (Outcome.FAILURE, 'nothing on "n"')


def test_a_use_sets_parameters_inside_its_subtree_and_nowhere_else():
    tree, _ = make(
        """
        tree: t
        root:
          sequence:
            - subtree: {tree: s, set: {give_number.value: 3, inner/retry.attempts: 7}}
            - subtree: {tree: s}
        trees:
          s: {root: {sequence: [GiveNumber, subtree: {tree: inner}]}}
          inner: {root: {sequence: [retry: Scripted]}}
        """
    )
    assert [tree.node(f"/t/{use}/give_number").parameters.value for use in ("s", "s_2")] == [3.0, 1.0]
    assert [tree.node(f"/t/{use}/inner/retry").parameters.attempts for use in ("s", "s_2")] == [7, 3]


def test_trees_of_an_included_file_go_by_its_name(tmp_path: Path):
    (tmp_path / "part.yaml").write_text(
        "{tree: part, root: {subtree: {tree: inner}}, trees: {inner: {root: {sequence: [subtree: {tree: leaf}]}}, "
        "leaf: {root: Scripted}}}"
    )
    (tmp_path / "main.yaml").write_text(
        "{tree: t, include: [part.yaml], root: {sequence: [subtree: {tree: part/inner}]}}"
    )
    spec = load_tree(tmp_path / "main.yaml", toys)
    assert [node.path for node in spec] == ["/t", "/t/inner", "/t/inner/leaf"]


def test_includes_are_bounded_in_depth_and_read_once(tmp_path: Path):
    for index in range(30):
        other = f"include: [f{index + 1}.yaml, ./f{index + 1}.yaml]" if index < 29 else "about: last"
        (tmp_path / f"f{index}.yaml").write_text(f"tree: f{index}\n{other}\nroot: Scripted\n")
    with pytest.raises(YamlError) as error:
        load_tree(tmp_path / "f0.yaml", toys)
    deep = [problem for problem in error.value.problems if "20 deep" in problem.message]
    assert [(Path(problem.location.file).name, problem.location.line) for problem in deep] == [("f19.yaml", 2)] * 2
