"""A trace that is read back: what it holds, how two differ, and why a node was not running."""

from __future__ import annotations

from pathlib import Path

import pytest
from scripted import make, run

from behaviors import Trace
from behaviors.explanation import explain
from behaviors.operator import Approve
from behaviors.recorded_trace import RecordedTrace, TraceError
from behaviors.trace_diff import diff_traces


def recorded(
    text: str, ticks: int, folder: Path, name: str = "trace.jsonl", act=lambda tree, tick: None
) -> RecordedTrace:
    """The trace of a tree of toys."""
    tree, robot = make(text, trace=Trace(folder / name))
    for tick in range(ticks):
        act(tree, tick)
        run(tree, robot, 1)
    tree.shutdown()
    return RecordedTrace(folder / name)


def test_the_state_after_every_tick_is_read_back(tmp_path: Path):
    trace = recorded(
        "{tree: t, root: {sequence: [Scripted: {says: RS}, GiveNumber: {out: [number], value: 3}, "
        "Scripted: {says: R}]}}",
        4,
        tmp_path,
        act=lambda tree, tick: tree.send(Approve("footsteps", 15)) if tick == 2 else None,
    )
    ticks = list(trace.ticks())
    assert [tick.tick for tick in ticks] == [0, 1, 2, 3] and len(trace) == 4
    assert [tick.status["/t/scripted"] for tick in ticks] == ["RUNNING", "SUCCESS", "SUCCESS", "SUCCESS"]
    assert [tick.ticked["/t/scripted"] for tick in ticks] == [True, True, False, False]
    assert [tick.values.get("number") for tick in ticks] == [None, 3.0, 3.0, 3.0]
    assert ticks[2].happened("operator") == [{"name": "approve", "value": ["footsteps", 15]}]
    assert trace.nodes["/t/give_number"].parameters == {"value": 3.0}
    assert trace.at(0.05).tick == 2


def test_a_trace_whose_last_line_is_half_written_is_read_up_to_it(tmp_path: Path):
    trace = recorded("{tree: t, root: {Scripted: {says: R}}}", 5, tmp_path)
    text = trace.path.read_text()
    trace.path.write_text(text[:-20])
    assert len(RecordedTrace(trace.path)) == 4


@pytest.mark.parametrize(
    ("content", "message"),
    [("", "the trace is empty"), ("{}\n", "got format None"), ("[]\n", ":1: not a line"), ("x}\n", ":1: not a line")],
)
def test_what_is_no_trace_is_refused(content: str, message: str, tmp_path: Path):
    path = tmp_path / "trace.jsonl"
    path.write_text(content)
    with pytest.raises(TraceError, match=message):
        RecordedTrace(path)
    with pytest.raises(TraceError, match="cannot read the trace"):
        RecordedTrace(tmp_path / "missing.jsonl")


def test_equal_runs_are_identical(tmp_path: Path):
    text = "{tree: t, root: {sequence: [GiveNumber: {out: [number]}, Scripted: {says: R}]}}"
    diff = diff_traces(recorded(text, 3, tmp_path, "a"), recorded(text, 3, tmp_path, "b"))
    assert diff.identical and diff.divergent == 0 and diff.first is None and diff.tree == ()


def test_the_first_divergent_tick_is_named_with_all_that_differs(tmp_path: Path):
    text = "{tree: t, root: {sequence: [Scripted: {says: %s}, GiveNumber: {out: [number], value: %s}, PauseWalking]}}"
    diff = diff_traces(recorded(text % ("RS", 2), 3, tmp_path, "a"), recorded(text % ("RS", 3), 3, tmp_path, "b"))
    assert [str(difference) for difference in diff.tree] == ["parameter /t/give_number.value: 2.0 | 3.0"]
    assert diff.first is not None and (diff.first.tick, diff.divergent) == (1, 2)
    assert [str(difference) for difference in diff.first.differences] == ["port number: value 2.0 | value 3.0"]
    assert diff.first_command is None
    diff = diff_traces(recorded(text % ("RS", 2), 3, tmp_path, "a"), recorded(text % ("RRS", 2), 3, tmp_path, "b"))
    assert diff.first_command is not None and diff.first_command.tick == 1
    assert diff.first is not None and "status /t/scripted: SUCCESS (said S) | RUNNING (said R)" in map(
        str, diff.first.differences
    )
    assert ("/t/scripted", 1) in diff.nodes


def test_nodes_that_only_one_tree_has_are_told_and_not_compared(tmp_path: Path):
    one = recorded("{tree: t, root: {sequence: [Scripted, Scripted: {says: R}]}}", 2, tmp_path, "a")
    other = recorded(
        "{tree: t, root: {sequence: [Scripted, Scripted: {says: R}, GiveNumber: {out: {number: n}}]}}", 2, tmp_path, "b"
    )
    diff = diff_traces(one, other)
    assert [str(difference) for difference in diff.tree] == ["node /t/give_number: is not there | GiveNumber"]
    assert diff.divergent == 0 and not diff.identical


WHY = {
    "running": ("{Scripted: {says: R}}", "/t", ["it was ticked and is RUNNING: said R"]),
    "an earlier child of a sequence": (
        "{sequence: [Scripted: {says: R}, Scripted]}",
        "/t/scripted_2",
        ["/t/scripted comes before it in /t (sequence) and is RUNNING: said R"],
    ),
    "a child that has ended": (
        "{sequence: [Scripted, Scripted: {says: R}]}",
        "/t/scripted",
        ["it had ended as SUCCESS already, and /t (sequence) has gone on to /t/scripted_2", "which is RUNNING: said R"],
    ),
    "a preferred child of a selector": (
        "{reactive_selector: [Scripted: {says: R}, Scripted]}",
        "/t/scripted_2",
        ["/t/scripted comes before it in /t (reactive_selector) and is RUNNING: said R"],
    ),
    "a rate": (
        "{loop_forever: {rate_limit: {period: 1, sequence: [Scripted]}}}",
        "/t/rate_limit/sequence/scripted",
        [
            "/t/rate_limit (rate_limit) did not tick it: starts every 1 s",
            "so nothing below /t/rate_limit/sequence was ticked",
        ],
    ),
    "a suppressor": (
        "{suppress: {condition: Scripted, child: {Scripted: {says: R}}}}",
        "/t/scripted_2",
        [
            "/t (suppress) held it back: suppressed: said S",
            "its condition /t/scripted is SUCCESS: said S",
        ],
    ),
    "a child of a parallel that rests": (
        "{parallel: [Scripted, Scripted: {says: R}]}",
        "/t/scripted",
        ["/t/scripted had ended as SUCCESS: said S, and rests until", "/t ends, which is RUNNING: said R"],
    ),
    "the end of the tree": (
        "{sequence: [Scripted]}",
        "/t/scripted",
        ["/t was not ticked: the tree had ended, or its safe stop was never needed"],
    ),
}


@pytest.mark.parametrize("name", WHY)
def test_a_node_that_was_not_ticked_is_explained_by_the_node_that_had_the_say(name: str, tmp_path: Path):
    root, path, expected = WHY[name]
    trace = recorded(f"{{tree: t, root: {root}}}", 4, tmp_path)
    assert list(explain(trace, path, 0.05).because) == expected
