"""The runner: its clock, its inputs and parameters, and what belongs to one tree alone."""

from __future__ import annotations

from typing import Any

import py_trees
import pytest
from scripted import ScriptedRobot, calls, leaf_of, make, run

from behaviors import Outcome, SettingError, Status
from behaviors.blackboard import PortTypeError
from behaviors.operator import Approve
from skills.parameters import ParameterError

NUMBER = "{tree: t, ports: {in: {number: float}}, root: {AddOne: {in: [number], out: [sum]}}}"


def test_two_trees_in_one_process_share_nothing():
    first, first_robot = make(NUMBER)
    second, second_robot = make(NUMBER)
    first.set_input("number", 1.0)
    run(first, first_robot, 1)
    run(second, second_robot, 1)
    assert first.blackboard.values() == {"number": 1.0, "sum": 2.0}
    assert second.blackboard.values() == {}
    assert second.outcome is Outcome.RUNNING
    assert first.node("/t").id == second.node("/t").id  # Ids are paths, not chance.
    assert py_trees.blackboard.Blackboard.storage == {}


def test_ticks_are_due_at_multiples_of_the_period_on_the_robots_clock():
    tree, robot = make("{tree: t, root: {Scripted: {says: R}}}", rate=30.0)
    robot.time = 7.0
    for index in range(100):
        assert tree.next_tick_time == pytest.approx(7.0 + index / 30.0, abs=1e-12)
        robot.time = tree.next_tick_time
        tree.tick()
        assert tree.timetable.lateness == pytest.approx(0.0, abs=1e-12)


def test_missed_ticks_are_not_made_up_for():
    tree, robot = make("{tree: t, root: {Scripted: {says: R}}}")
    tree.tick()
    robot.time = 0.113
    tree.tick()
    assert tree.timetable.lateness == pytest.approx(0.093)
    assert tree.next_tick_time == pytest.approx(0.12)


def test_a_leaf_waits_for_its_input_with_a_reason():
    tree, robot = make(NUMBER)
    run(tree, robot, 3)
    assert tree.outcome is Outcome.RUNNING
    assert tree.root.reason == 'waits for number: nothing on "number"'
    tree.set_input("number", 4)
    run(tree, robot, 1)
    assert tree.outcome is Outcome.SUCCESS


def test_an_input_of_the_wrong_type_or_name_is_refused_where_it_is_set():
    tree, _ = make(NUMBER)
    with pytest.raises(PortTypeError, match='"number" takes float, got str'):
        tree.set_input("number", "four")
    with pytest.raises(SettingError, match='tree "t" has no input "numbr"; did you mean "number"'):
        tree.set_input("numbr", 4.0)


def test_an_output_of_the_wrong_type_is_a_fault(monkeypatch: pytest.MonkeyPatch):
    tree, robot = make("{tree: t, root: {GiveNumber: {out: [number]}}}")
    leaf = leaf_of(tree, "/t")

    def tick() -> Status:
        leaf.number = "four"  # type: ignore[attr-defined]
        return Status.SUCCESS

    monkeypatch.setattr(leaf, "tick", tick)
    run(tree, robot, 1)
    assert tree.reason == '/t: PortTypeError in tick: "number" takes float, got str'


def test_operator_events_are_seen_for_one_tick():
    tree, robot = make("{tree: t, root: {Scripted: {says: R}}}")
    tree.send(Approve("footsteps", 3))
    run(tree, robot, 1)
    assert tree.context.operator_events == (Approve("footsteps", 3),)
    run(tree, robot, 1)
    assert tree.context.operator_events == ()


def test_parameters_of_a_node_come_from_class_defaults_file_settings_and_live_changes_in_this_order():
    text = "{tree: t, root: {sequence: [GiveNumber: {out: [number]%s}]}}"
    path = "/t/give_number"

    def value(text: str, **options: Any) -> float:
        tree, _ = make(text, **options)
        return tree.node(path).parameters.value

    defaults, given = {"GiveNumber": {"value": 2.0}}, text % ", value: 3"
    assert value(text % "") == 1.0
    assert value(text % "", defaults=defaults) == 2.0
    assert value(given, defaults=defaults) == 3.0
    assert value(given, defaults=defaults, settings={path: {"value": 4}}) == 4.0
    tree, robot = make(given, settings={path: {"value": 4}})
    tree.set_parameter(path, "value", 5)
    run(tree, robot, 1)
    assert tree.blackboard["number"] == 5.0
    assert isinstance(tree.blackboard["number"], float)


def test_settings_that_nothing_takes_are_refused():
    text = "{tree: t, root: {GiveNumber: {out: [number]}}}"
    with pytest.raises(SettingError, match=r'no node "/x"'):
        make(text, settings={"/x": {"value": 1.0}})
    with pytest.raises(SettingError, match=r'/t: no parameter "valu"; did you mean "value"\? \(parameters: value\)'):
        make(text, settings={"/t": {"valu": 1.0}})
    with pytest.raises(ParameterError, match=r"/t\.value: got 99\.0, allowed: -10 \.\. 10 m"):
        make(text, settings={"/t": {"value": 99}})
    tree, _ = make(text)
    with pytest.raises(SettingError, match='no node or subject "footsteps"'):
        tree.set_parameter("footsteps", "reach", 1.0)


def test_transitions_tell_what_the_last_tick_changed():
    tree, robot = make("{tree: t, root: {sequence: [Scripted: {says: RS}, Scripted: {says: R}]}}")
    run(tree, robot, 1)
    assert [(change.path, change.after) for change in tree.transitions] == [
        ("/t", Status.RUNNING),
        ("/t/scripted", Status.RUNNING),
    ]
    run(tree, robot, 1)
    change = tree.transitions[0]
    assert (change.path, change.before, change.after, change.reason) == (
        "/t/scripted",
        Status.RUNNING,
        Status.SUCCESS,
        "said S",
    )
    run(tree, robot, 1)
    assert tree.transitions == ()


def test_a_tree_that_has_ended_is_not_begun_again():
    tree, robot = make("{tree: t, root: Scripted}")
    run(tree, robot, 4)
    assert calls(tree, "/t") == ["start", "tick"]
    assert tree.outcome is Outcome.SUCCESS


def test_shutdown_stops_what_runs_once():
    tree, robot = make("{tree: t, root: {sequence: [Scripted: {says: R}]}}")
    run(tree, robot, 2)
    tree.shutdown()
    tree.shutdown()
    assert calls(tree, "/t/scripted") == ["start", "tick", "tick", "stop"]


def test_all_leaves_of_a_tick_see_the_same_robot():
    class CountingRobot(ScriptedRobot):
        reads = 0

        def status(self):
            self.reads += 1
            return super().status()

    tree, robot = make("{tree: t, root: {Scripted: {says: R}}}", CountingRobot())
    run(tree, robot, 1)
    assert tree.context.robot.status() is tree.context.robot.status()
    assert robot.reads == 1  # type: ignore[attr-defined]


def test_a_leaf_whose_input_is_taken_away_is_stopped_and_waits():
    tree, robot = make("{tree: t, ports: {in: {number: float}}, root: {Square: {in: [number], out: [square]}}}")
    tree.set_input("number", 2.0)
    run(tree, robot, 2)
    tree.set_input("number", None)
    run(tree, robot, 20)
    assert tree.root.reason == 'waits for number: nothing on "number"'
    assert [job.outcome.value for job in tree.drain_jobs()] == ["cancelled"]
    assert tree.blackboard["square"] is None
    tree.shutdown()
