"""The trace: any bit that differs gives another hash, and nothing else does."""

from __future__ import annotations

import dataclasses
import enum
import json
import math
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scripted import Scripted, ScriptedRobot, footstep, leaf_of, make, run, toys

from behaviors import Executor, Leaf, Outcome, Output, Registry, Status, Trace, Tree, parse_tree
from behaviors.canonical import CanonicalError, digest, encode
from behaviors.operator import Approve, Reject
from behaviors.values import ValueFormatError, from_json, is_small, to_json
from skills.footsteps.footstep import FootstepPlan, PlanOutcome
from skills.geometry.pose import Pose

STEPS = Registry()
STEPS(Scripted)


@STEPS
class GiveSteps(Leaf):
    """Gives a plan of two steps."""

    plan = Output(FootstepPlan, "a plan")

    def tick(self) -> Status:
        if self.plan is None:
            self.plan = plan_with(0.4)
        return self.running()


def plan_with(x: float) -> FootstepPlan:
    return FootstepPlan(0, 0, PlanOutcome.ENOUGH_STEPS, "", (footstep(0), footstep(1, x)), 1.0, 10)


def trace_of(
    text: str = "{tree: t, root: {GiveSteps: {out: [plan]}}}",
    ticks: int = 5,
    robot: ScriptedRobot | None = None,
    **options: Any,
) -> str:
    robot = robot or ScriptedRobot()
    tree = Tree(parse_tree(text, STEPS), robot, **options)
    run(tree, robot, ticks)
    tree.shutdown()
    assert not tree.faults
    return tree.trace.hash


def test_the_same_run_has_the_same_hash_also_with_a_file_and_another_number_of_workers(tmp_path: Path):
    hashes = {
        trace_of(),
        trace_of(trace=Trace(tmp_path / "trace.jsonl")),
        trace_of(executor=Executor(workers=1)),
    }
    assert len(hashes) == 1


def test_a_foothold_that_moves_by_a_picometre_changes_the_hash(monkeypatch: pytest.MonkeyPatch):
    before = trace_of()
    exact = plan_with
    monkeypatch.setitem(globals(), "plan_with", lambda x: exact(x + 1e-12))
    assert trace_of() != before


def test_statuses_events_commands_parameters_and_the_robots_state_change_the_hash():
    base = "{tree: t, root: {Scripted: {says: RRRS}}}"
    hashes = [trace_of(base)]
    hashes.append(trace_of("{tree: t, root: {Scripted: {says: RRS}}}"))
    hashes.append(trace_of("{tree: u, root: {Scripted: {says: RRRS}}}"))
    moved = ScriptedRobot()
    moved.pose = Pose.from_xyz_rpy((1e-12, 0.0, 0.0))
    hashes.append(trace_of(base, robot=moved))
    for act in (
        lambda tree: tree.send(Approve("footsteps", 0)),
        lambda tree: tree.send(Approve("footsteps", 1)),
        lambda tree: tree.send(Reject("footsteps", 0)),
        lambda tree: tree.set_parameter("/t", "says", "RRRS"),
        lambda tree: tree.context.robot.robot.__setattr__("time", 1e-12),
    ):
        robot = ScriptedRobot()
        tree = Tree(parse_tree(base, STEPS), robot)
        act(tree)
        run(tree, robot, 5)
        hashes.append(tree.trace.hash)
    commanding = Tree(parse_tree("{tree: t, root: PauseWalking}", toys), ScriptedRobot())
    commanding.tick()
    silent = Tree(parse_tree("{tree: t, root: Scripted}", toys), ScriptedRobot())
    silent.tick()
    hashes += [commanding.trace.hash, silent.trace.hash]
    assert len(set(hashes)) == len(hashes)


def test_wall_time_is_no_part_of_the_trace():
    text = "{tree: t, ports: {in: {number: float}}, root: {Square: {in: [number], out: [square], latency: 0.1}}}"

    def hash_of(pause: float) -> str:
        tree, robot = make(text)
        leaf = leaf_of(tree, "/t")
        leaf.request = lambda: leaf.call(lambda: time.sleep(pause) or 4.0)  # type: ignore[attr-defined]
        tree.set_input("number", 2.0)
        run(tree, robot, 7)
        assert tree.outcome is Outcome.SUCCESS
        tree.shutdown()
        return tree.trace.hash

    assert hash_of(0.0) == hash_of(0.02)


def test_the_file_has_one_line_a_tick_with_what_changed(tmp_path: Path):
    robot = ScriptedRobot()
    text = "{tree: t, root: {sequence: [Scripted: {says: RS}, GiveSteps: {out: [plan]}]}}"
    tree = Tree(parse_tree(text, STEPS), robot, trace=Trace(tmp_path / "trace.jsonl"))
    tree.send(Approve("footsteps", 3))
    run(tree, robot, 3)
    tree.shutdown()
    head, first, second, third = map(json.loads, (tmp_path / "trace.jsonl").read_text().splitlines())
    assert [(node["path"], node["kind"]) for node in head["nodes"]] == [
        ("/t", "sequence"),
        ("/t/scripted", "Scripted"),
        ("/t/give_steps", "GiveSteps"),
    ]
    assert head["nodes"][2]["out"] == {"plan": "plan"} and head["keys"] == {"plan": "FootstepPlan"}
    assert first["status"] == {"/t": "RUNNING", "/t/scripted": "RUNNING", "/t/give_steps": "INVALID"}
    assert first["reason"]["/t/scripted"] == "said R"
    assert first["operator"] == [{"name": "approve", "value": ["footsteps", 3]}]
    assert second["status"] == {"/t/scripted": "SUCCESS", "/t/give_steps": "RUNNING"}
    assert list(second["ports"]) == ["plan"]
    assert from_json(second["values"]["plan"]).steps[1].sequence_id == 1
    assert set(third) == {"tick", "time", "hash", "robot", "ticked"}
    assert third["hash"] == tree.trace.hash


def test_an_immutable_value_is_encoded_once_and_a_mutable_one_at_every_tick():
    assert digest(plan_with(0.4))[1]
    writable = np.zeros(3)
    before = digest((writable,))
    writable[0] = 1.0
    assert not before[1] and digest((writable,))[0] != before[0]
    assert not digest([1])[1] and not digest({1: 2})[1] and not digest(((), [1]))[1]


class Colour(enum.Enum):
    RED = 1
    BLUE = 2


@dataclasses.dataclass(frozen=True)
class Box:
    content: Any


@dataclasses.dataclass(frozen=True)
class Case:
    content: Any


DIFFERENT = [
    None,
    True,
    False,
    0,
    1,
    -1,
    255,
    2**70,
    0.0,
    -0.0,
    1.0,
    math.nextafter(1.0, 2.0),
    math.nan,
    math.inf,
    "",
    "1",
    b"1",
    (),
    (1,),
    ((1,),),
    (1, 2),
    [1, 2],
    {},
    {1: 2},
    {1: 3},
    {2: 1},
    frozenset(),
    frozenset({1}),
    Colour.RED,
    Colour.BLUE,
    Box(1),
    Case(1),
    Box(None),
    np.zeros(2),
    np.zeros(3),
    np.zeros((1, 2)),
    np.zeros((2, 1)),
    np.zeros(2, dtype=np.float32),
    np.zeros(2, dtype=np.int64),
    np.array([0.0, 1e-300]),
    np.zeros(1000),
    np.zeros((10, 100)),
    np.zeros(1000) + 1e-300,
    np.float64(0.5),
    np.int32(1),
]


def test_no_two_values_share_an_encoding():
    encodings = [encode(value) for value in DIFFERENT]
    assert len(set(encodings)) == len(DIFFERENT)


_values = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(max_size=3) | st.binary(max_size=3),
    lambda below: st.lists(below, max_size=3).map(tuple) | st.dictionaries(st.text(max_size=2), below, max_size=3),
    max_leaves=8,
)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(_values, _values)
def test_encodings_are_prefix_free(a: Any, b: Any):
    assert encode((a, b)) == encode((a,))[:1] + (2).to_bytes(8, "little") + encode(a) + encode(b)
    if encode(a) != encode(b):
        assert not encode(a).startswith(encode(b))


def test_the_order_of_a_dict_or_set_is_no_part_of_its_encoding():
    assert encode({"a": 1, "b": 2}) == encode({"b": 2, "a": 1})
    assert encode(frozenset(range(100))) == encode(frozenset(reversed(range(100))))


def test_a_value_without_canonical_bytes_is_refused():
    with pytest.raises(CanonicalError, match="use a frozen dataclass"):
        encode(object())
    with pytest.raises(CanonicalError):
        encode(np.array([object()]))


def test_a_value_that_is_written_and_read_back_has_the_same_bits():
    for value in DIFFERENT:
        back = from_json(json.loads(json.dumps(to_json(value))))
        assert type(back) is type(value) and encode(back) == encode(value)
    plan = plan_with(0.1 + 0.2)
    assert encode(from_json(json.loads(json.dumps(to_json(plan))))) == encode(plan)


@settings(max_examples=100, deadline=None, derandomize=True)
@given(_values)
def test_any_value_is_written_and_read_back(value: Any):
    assert encode(from_json(json.loads(json.dumps(to_json(value))))) == encode(value)


@pytest.mark.parametrize(
    "data",
    [
        {"a": 1},
        {"$class": "os:system", "fields": {}},
        {"$class": "nothing.loaded:Thing", "fields": {}},
        {"$class": "subprocess:Popen", "fields": {"args": ["true"]}},
        {"$enum": "os:environ", "name": "PATH"},
        {"$array": "|O", "shape": [1], "data": ""},
        {"$array": "<f8", "shape": [3], "data": ""},
        {"$tuple": 3},
    ],
)
def test_what_is_no_value_of_a_trace_is_refused_and_nothing_is_run(data: Any):
    with pytest.raises(ValueFormatError):
        from_json(data)


def test_a_value_is_small_by_what_it_holds():
    assert is_small(plan_with(0.4), 16_384) and not is_small(plan_with(0.4), 100)
    assert not is_small((np.zeros(3000),), 16_384) and not is_small({"a": "x" * 20_000}, 16_384)
