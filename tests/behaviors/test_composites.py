"""Composites: the same decisions and the same lifecycles as in py_trees, and preemption that stops exactly once."""

from __future__ import annotations

from typing import Any

import py_trees
import pytest
from hypothesis import given, reject, settings
from hypothesis import strategies as st
from py_trees.common import ParallelPolicy, Status
from scripted import STATUSES, calls, letters, make, run

from behaviors import Outcome
from strict_yaml import YamlError

TICKS = 7


@pytest.mark.parametrize("kind", ["sequence", "reactive_sequence"])
def test_sequence_ends_with_the_first_child_that_does_not_succeed(kind: str):
    tree, robot = make(f"{{tree: t, root: {{{kind}: [Scripted, Scripted: {{says: F}}, Scripted]}}}}")
    run(tree, robot, 1)
    assert tree.outcome is Outcome.FAILURE
    assert letters(tree.nodes) == "FSF."
    assert tree.root.reason == "said F"


@pytest.mark.parametrize("kind", ["selector", "reactive_selector"])
def test_selector_ends_with_the_first_child_that_does_not_fail(kind: str):
    tree, robot = make(f"{{tree: t, root: {{{kind}: [Scripted: {{says: F}}, Scripted, Scripted]}}}}")
    run(tree, robot, 1)
    assert tree.outcome is Outcome.SUCCESS
    assert letters(tree.nodes) == "SFS."


def test_sequence_with_memory_goes_on_with_the_running_child():
    tree, robot = make("{tree: t, root: {sequence: [Scripted: {says: SF}, Scripted: {says: RRS}]}}")
    run(tree, robot, 3)
    assert tree.outcome is Outcome.SUCCESS
    assert calls(tree, "/t/scripted") == ["start", "tick"]


def test_reactive_sequence_asks_earlier_children_again_and_preempts_later_ones():
    tree, robot = make("{tree: t, root: {reactive_sequence: [Scripted: {says: SSF}, Scripted: {says: R}]}}")
    run(tree, robot, 3)
    assert tree.outcome is Outcome.FAILURE
    assert calls(tree, "/t/scripted_2") == ["start", "tick", "tick", "stop"]


def test_selector_with_memory_does_not_return_to_a_higher_priority():
    tree, robot = make("{tree: t, root: {selector: [Scripted: {says: FS}, Scripted: {says: RRS}]}}")
    run(tree, robot, 3)
    assert calls(tree, "/t/scripted") == ["start", "tick"]
    assert tree.outcome is Outcome.SUCCESS


def test_reactive_selector_preempts_a_lower_priority():
    tree, robot = make("{tree: t, root: {reactive_selector: [Scripted: {says: FFR}, Scripted: {says: R}]}}")
    run(tree, robot, 4)
    assert calls(tree, "/t/scripted_2") == ["start", "tick", "tick", "stop"]
    assert letters(tree.nodes) == "RR."


def test_preemption_stops_every_running_leaf_exactly_once_at_any_depth():
    tree, robot = make(
        """
        tree: t
        root:
          reactive_sequence:
            - Scripted: {says: SSF}
            - parallel:
                - timeout: {after: 9.0, retry: {sequence: [Scripted: {name: deep, says: R}]}}
                - Scripted: {name: done}
                - Scripted: {name: wide, says: R}
        """
    )
    run(tree, robot, 5)
    tree.shutdown()
    assert calls(tree, "/t/parallel/timeout/retry/sequence/deep").count("stop") == 1
    assert calls(tree, "/t/parallel/wide").count("stop") == 1
    assert calls(tree, "/t/parallel/done") == ["start", "tick"]


def test_a_leaf_that_ends_by_itself_is_not_stopped():
    tree, robot = make("{tree: t, root: {sequence: [Scripted: {says: RS}]}}")
    run(tree, robot, 3)
    tree.shutdown()
    assert calls(tree, "/t/scripted") == ["start", "tick", "tick"]


@pytest.mark.parametrize(
    ("options", "outcome"),
    [
        ("", Outcome.FAILURE),
        ("fail_after: 2", Outcome.FAILURE),
        ("fail_after: 2, succeed_after: 1", Outcome.SUCCESS),
        ("succeed_after: 1", Outcome.FAILURE),
        ("fail_after: 0, succeed_after: 1", Outcome.SUCCESS),
        ("fail_after: 0, succeed_after: 2", Outcome.FAILURE),
    ],
)
def test_parallel_ends_when_enough_children_ended(options: str, outcome: Outcome):
    comma = ", " if options else ""
    tree, robot = make(
        f"{{tree: t, root: {{parallel: {{{options}{comma}children: [Scripted, Scripted: {{says: F}}]}}}}}}"
    )
    run(tree, robot, 1)
    assert tree.outcome is outcome


def test_parallel_lets_ended_children_rest_and_reactive_parallel_ticks_them_again():
    children = "[Scripted, Scripted: {says: RRS}]"
    for kind, ticks in (("parallel", 1), ("reactive_parallel", 3)):
        tree, robot = make(f"{{tree: t, root: {{{kind}: {children}}}}}")
        run(tree, robot, 3)
        assert tree.outcome is Outcome.SUCCESS
        assert calls(tree, "/t/scripted").count("tick") == ticks


def test_parallel_that_fails_stops_its_running_children_once():
    tree, robot = make("{tree: t, root: {parallel: [Scripted: {says: R}, Scripted: {says: RF}]}}")
    run(tree, robot, 2)
    assert calls(tree, "/t/scripted") == ["start", "tick", "tick", "stop"]


class _Peer(py_trees.behaviour.Behaviour):
    """The scripted leaf as py_trees has it."""

    def __init__(self, name: str, says: str) -> None:
        super().__init__(name)
        self.says = says
        self.said = 0
        self.calls: list[str] = []

    def initialise(self) -> None:
        self.calls.append("start")

    def update(self) -> Status:
        self.calls.append("tick")
        letter = self.says[min(self.said, len(self.says) - 1)]
        self.said += 1
        return STATUSES[letter]

    def terminate(self, new_status: Status) -> None:
        if new_status is Status.INVALID and self.status is Status.RUNNING:
            self.calls.append("stop")


_leaves = st.text(alphabet="SFR", min_size=1, max_size=4).map(lambda says: ("Scripted", says))
_composites = st.sampled_from(
    ["sequence", "reactive_sequence", "selector", "reactive_selector", "parallel", "reactive_parallel"]
)
_decorators = st.sampled_from(["inverter", "force_success", "force_failure", "retry", "repeat"])
_trees = st.recursive(
    _leaves,
    lambda below: st.tuples(_composites, st.lists(below, min_size=1, max_size=3)) | st.tuples(_decorators, below),
    max_leaves=8,
)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(_trees)
def test_every_tree_decides_and_calls_its_leaves_as_py_trees_does(shape: Any):
    text, peers = [], []
    root = _peer(shape, peers)
    try:
        tree, robot = make(f"{{tree: t, root: {_yaml(shape, text)}}}")
    except YamlError as error:
        assert all("can never be reached" in problem.message for problem in error.problems)
        reject()
    leaves = [node for node in tree.nodes if node.kind == "Scripted"]
    for _ in range(TICKS):
        run(tree, robot, 1)
        root.tick_once()
        assert tree.root.status is root.status
        assert [node.leaf.calls[1:] for node in leaves] == [peer.calls for peer in peers]  # type: ignore[attr-defined]
        if root.status is not Status.RUNNING:
            break


def _yaml(shape: Any, text: list[str]) -> str:
    kind, rest = shape
    if kind == "Scripted":
        return f"{{Scripted: {{says: {rest}}}}}"
    if isinstance(rest, list):
        options = "succeed_after: 1, " if kind == "reactive_parallel" else ""
        return f"{{{kind}: {{{options}children: [{', '.join(_yaml(child, text) for child in rest)}]}}}}"
    options = {"retry": "attempts: 2, ", "repeat": "times: 2, "}.get(kind, "")
    return f"{{{kind}: {{{options}child: {_yaml(rest, text)}}}}}"


def _peer(shape: Any, peers: list[_Peer]) -> py_trees.behaviour.Behaviour:
    kind, rest = shape
    if kind == "Scripted":
        peers.append(_Peer("leaf", rest))
        return peers[-1]
    if isinstance(rest, list):
        children = [_peer(child, peers) for child in rest]
        memory = not kind.startswith("reactive")
        if "sequence" in kind:
            return py_trees.composites.Sequence("sequence", memory, children)
        if "selector" in kind:
            return py_trees.composites.Selector("selector", memory, children)
        policy = ParallelPolicy.SuccessOnAll(synchronise=True) if memory else ParallelPolicy.SuccessOnOne()
        return py_trees.composites.Parallel("parallel", policy, children)
    child = _peer(rest, peers)
    return {
        "inverter": lambda: py_trees.decorators.Inverter("d", child),
        "force_success": lambda: py_trees.decorators.FailureIsSuccess("d", child),
        "force_failure": lambda: py_trees.decorators.SuccessIsFailure("d", child),
        "retry": lambda: py_trees.decorators.Retry("d", child, 2),
        "repeat": lambda: py_trees.decorators.Repeat("d", child, 2),
    }[kind]()


def test_py_trees_own_tools_tick_and_show_our_nodes():
    tree, _ = make("{tree: t, root: {sequence: [Scripted, Scripted: {says: R}, Scripted]}}")
    tree.setup()
    visited = [node.name for node in tree.root.tick()]
    assert visited == ["scripted", "scripted_2", "t"]
    assert "scripted_2" in py_trees.display.unicode_tree(tree.root, show_status=True)
