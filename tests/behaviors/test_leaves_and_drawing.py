"""Leaves and ports as classes declare them, the plain leaves, and how a tree is drawn."""

from __future__ import annotations

import pytest
from scripted import ScriptedRobot, make, run, toys

from behaviors import Input, Leaf, OptionalInput, Outcome, Output, RegistrationError, Registry, Status, Tree, draw, leaf
from behaviors.loader import parse_tree
from behaviors.plain_leaves import Fail, Succeed, Wait


class _Base(Leaf):
    """Has ports of all kinds."""

    needed = Input(float, "needed", when_missing=Status.FAILURE)
    usual = Input(float, "has a usual value", default=0.8)
    extra = OptionalInput(str, "may be missing")
    given = Output(str, "what was seen")

    def tick(self) -> Status:
        self.given = f"{self.needed} {self.usual} {self.extra}"
        return self.succeeded()


def registry() -> Registry:
    leaves = Registry()
    leaves(type("AllPorts", (_Base,), {"__doc__": "Has all ports."}))
    for cls in toys.classes:
        leaves(cls)
    return leaves


def outcome(text: str) -> Tree:
    robot = ScriptedRobot()
    tree = Tree(parse_tree(text, registry()), robot)
    run(tree, robot, 1)
    return tree


def test_a_needed_input_that_is_missing_fails_where_the_leaf_says_so():
    tree = outcome("{tree: t, ports: {in: {x: float}}, root: {AllPorts: {in: {needed: x}}}}")
    assert tree.outcome is Outcome.FAILURE
    assert tree.reason == 'waits for needed: nothing on "x"'


def test_inputs_with_a_default_and_optional_ones_need_not_be_wired():
    tree = outcome(
        "{tree: t, root: {sequence: [GiveNumber: {out: [number]}, AllPorts: {in: {needed: number}, out: [given]}]}}"
    )
    assert tree.blackboard["given"] == "1.0 0.8 None"


def test_an_input_cannot_be_written():
    tree, _ = make("{tree: t, ports: {in: {number: float}}, root: {AddOne: {in: [number]}}}")
    with pytest.raises(AttributeError, match="input 'number' cannot be written"):
        tree.node("/t").leaf.number = 3.0  # type: ignore[attr-defined]


@pytest.mark.parametrize(
    ("name", "members", "message"),
    [
        ("small", {"__doc__": "x"}, "named in CamelCase"),
        ("NoDoc", {"__doc__": None}, "needs a docstring"),
        ("Scripted", {"__doc__": "x"}, "already registered"),
        ("TakesContext", {"__doc__": "x", "context": Output(str, "x")}, "this name belongs to every leaf"),
        ("TakesTick", {"__doc__": "x", "tick": Output(str, "x")}, "this name belongs to every leaf"),
    ],
)
def test_a_leaf_that_a_tree_file_could_not_use_is_refused(name: str, members: dict[str, object], message: str):
    with pytest.raises(RegistrationError, match=message):
        registry()(type(name, (Leaf,), members))


def test_plain_leaves_are_shipped():
    assert {cls.__name__ for cls in (Fail, Succeed, Wait)} <= set(leaf.names)


def test_wait_is_measured_on_the_robots_clock():
    robot = ScriptedRobot()
    tree = Tree(
        parse_tree("{tree: t, root: {sequence: [Wait: {duration: 0.1}, force_success: Fail, Succeed]}}", leaf), robot
    )
    run(tree, robot, 5)
    assert tree.outcome is Outcome.RUNNING and tree.root.reason == "waits for 0.1 s"
    run(tree, robot, 1)
    assert tree.outcome is Outcome.SUCCESS


def test_a_drawing_shows_kinds_names_parameters_and_ports():
    tree, _ = make(
        """
        tree: example
        about: Squares a number again and again.
        ports: {in: {start: float}}
        safe_stop: PauseWalking
        root:
          loop_forever:
            run_while:
              name: while it may
              condition: Scripted
              sequence:
                - Square: {in: {number: start}, out: [square], latency: 0.1}
                - subtree: {tree: add, in: {x: square}}
        trees:
          add: {ports: {in: {x: float}}, root: {AddOne: {in: {number: x}, out: {sum: y}}}}
        """
    )
    assert draw(tree.spec) == (
        """
Squares a number again and again.
← start: float
example  (loop_forever)
╰─ while it may  (run_while)
   ├─ condition: Scripted
   ╰─ sequence
      ├─ Square  latency 0.1 s  ← number: start  → square
      ╰─ add  (AddOne of tree add)  ← number: square  → sum: y
safe_stop  (PauseWalking)
""".strip()
    )
