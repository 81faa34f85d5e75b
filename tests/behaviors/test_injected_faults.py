"""Faults that are injected on purpose: each breaks what it says, when it says, and nothing else; others are refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from scripted import ScriptedRobot, leaf_of, make, run

from behaviors import Outcome
from behaviors.faults import POSSIBLE, Fault, FaultMode, InjectedFaultError, read_faults
from behaviors.faulty_inbox import FaultyInbox
from behaviors.faulty_leaf import break_leaf
from behaviors.faulty_robot import FaultyRobot
from behaviors.operator import Approve, OperatorInbox
from skills.geometry import DepthImage, LidarScan, PinholeCamera, Pose, SpinningLidar
from skills.walking.walking_state import WalkingPhase
from strict_yaml import YamlError, parse_document

CAMERA = PinholeCamera(40, 30, 20.0, 20.0, 15.0, 10.0)
LIDAR = SpinningLidar(3, 40, 0.5, -0.5)


class SeeingRobot(ScriptedRobot):
    """Sees a new frame ten times a second, whose content is its number."""

    @property
    def frame(self) -> int:
        return round(self.time * 10.0)

    def depth_frames(self) -> dict[str, int]:
        return {"front": self.frame}

    def depth_image(self, camera: str) -> DepthImage:  # type: ignore[override]
        depth = np.full((30, 40), 1.0 + self.frame, dtype=np.float32)
        return DepthImage(depth, CAMERA, Pose.identity(), self.frame / 10.0, self.frame)

    def lidar_scan(self) -> LidarScan:  # type: ignore[override]
        ranges = np.full((3, 40), 1.0 + self.frame, dtype=np.float32)
        return LidarScan(ranges, LIDAR, Pose.identity(), self.frame / 10.0, self.frame)


def seen(mode: FaultMode, sensor: str = "depth", **options: Any) -> list[tuple[int, float]]:
    """Number and content of the frame that is seen at 0.0, 0.1, ... 0.9 s, with a fault from 0.3 to 0.6 s."""
    robot = SeeingRobot()
    faulty = FaultyRobot(robot, [Fault(f"sensor:{sensor}", mode, start=0.3, duration=0.3, **options)])
    frames = []
    for index in range(10):
        robot.time = index / 10.0
        if sensor == "depth":
            image = faulty.depth_image("front")
            assert image is not None
            frames.append((image.frame_id, float(np.nanmax(image.depth)) - 1.0))
        else:
            scan = faulty.lidar_scan()
            assert scan is not None
            frames.append((scan.scan_id, float(np.nanmax(scan.ranges)) - 1.0))
    return frames


NORMAL = [(index, float(index)) for index in range(10)]


@pytest.mark.parametrize("sensor", ["depth", "lidar"])
def test_no_frames_come_while_a_sensor_is_off(sensor: str):
    assert seen(FaultMode.OFF, sensor) == [*NORMAL[:3], *[NORMAL[2]] * 3, *NORMAL[6:]]


def test_new_frames_have_the_old_content_while_a_sensor_is_stuck():
    assert seen(FaultMode.STUCK) == [*NORMAL[:3], *[(index, 2.0) for index in (3, 4, 5)], *NORMAL[6:]]


def test_distances_are_scaled_while_a_sensor_is_wrong():
    frames = seen(FaultMode.WRONG, scale=2.0)
    assert frames == [*NORMAL[:3], *[(index, 2.0 * (index + 1) - 1.0) for index in (3, 4, 5)], *NORMAL[6:]]


def test_frames_come_later_while_a_sensor_is_delayed():
    frames = seen(FaultMode.DELAYED, by=0.2)
    assert frames[3:6] == [NORMAL[2], NORMAL[2], NORMAL[3]] and frames[6:] == NORMAL[6:]


def test_some_frames_are_lost_and_always_the_same_ones_while_a_sensor_is_intermittent():
    frames = seen(FaultMode.INTERMITTENT, share=0.5, seed=4)
    assert frames == seen(FaultMode.INTERMITTENT, share=0.5, seed=4)
    assert frames[:3] == NORMAL[:3] and frames[6:] == NORMAL[6:]
    assert seen(FaultMode.INTERMITTENT, share=1.0) == seen(FaultMode.OFF)
    assert seen(FaultMode.INTERMITTENT, share=0.0) == NORMAL


def test_a_share_of_the_pixels_is_not_a_number():
    robot = SeeingRobot()
    faulty = FaultyRobot(robot, [Fault("sensor:depth", FaultMode.NAN, share=0.25)])
    image = faulty.depth_image("front")
    assert image is not None and faulty.depth_image("front") is image
    assert np.isnan(image.depth).mean() == pytest.approx(0.25, abs=0.05)


@pytest.mark.parametrize("sensor", ["depth", "lidar", "state", "status"])
def test_reading_raises_and_a_tree_stops_safely(sensor: str):
    robot = SeeingRobot()
    faulty = FaultyRobot(robot, [Fault(f"sensor:{sensor}", FaultMode.EXCEPTION, start=0.05)])
    read = {"depth": faulty.depth_frames, "lidar": faulty.lidar_scan, "state": faulty.state, "status": faulty.status}
    read[sensor]()
    robot.time = 0.1
    with pytest.raises(InjectedFaultError):
        read[sensor]()
    if sensor in ("state", "status"):
        tree, _ = make("{tree: t, root: {Scripted: {says: R}}}", faulty)  # type: ignore[arg-type]
        tree.tick()
        assert tree.outcome is Outcome.ERROR and robot.commands == [("pause_walking", 0.1)]


def state_x(mode: FaultMode, **options: Any) -> list[float]:
    """Where the robot believes to be at 0.0, 0.1, ... 0.9 s, while it walks 1 m/s, with a fault from 0.3 to 0.6 s."""
    robot = ScriptedRobot()
    faulty = FaultyRobot(robot, [Fault("sensor:state", mode, start=0.3, duration=0.3, **options)])
    found = []
    for index in range(10):
        robot.time = index / 10.0
        robot.pose = Pose.from_xyz_rpy((robot.time, 0.0, 0.0))
        found.append(round(float(faulty.state().T_world_pelvis.p[0]), 6))
    return found


def test_estimates_of_the_state_are_stuck_delayed_or_wrong():
    true = [index / 10.0 for index in range(10)]
    assert state_x(FaultMode.STUCK) == [*true[:3], 0.2, 0.2, 0.2, *true[6:]]
    assert state_x(FaultMode.DELAYED, by=0.2) == [*true[:3], 0.1, 0.2, 0.3, *true[6:]]
    assert state_x(FaultMode.WRONG, shift=(0.05, 0.0, 0.0)) == [*true[:3], 0.35, 0.45, 0.55, *true[6:]]


def test_a_status_that_says_fallen_and_a_state_of_no_numbers():
    robot = ScriptedRobot()
    faulty = FaultyRobot(
        robot, [Fault("sensor:status", FaultMode.FALLEN, start=1.0), Fault("sensor:state", FaultMode.NAN, start=1.0)]
    )
    assert faulty.status().phase is WalkingPhase.STANDING and np.isfinite(faulty.state().com_world).all()
    robot.time = 1.0
    assert faulty.status().phase is WalkingPhase.FALLEN and np.isnan(faulty.state().com_world).all()


TREE = "{tree: t, ports: {in: {n: float}}, root: {sequence: [Square: {in: {number: n}, out: [square], latency: 0.1}, Scripted: {says: R}]}}"  # fmt: skip  # noqa: E501


def broken(mode: FaultMode, path: str = "/t/square", ticks: int = 12, **options: Any) -> tuple[Any, Any]:
    tree, robot = make(TREE)
    break_leaf(tree.node(path), [Fault(path, mode, **options)])
    tree.set_input("n", 3.0)
    run(tree, robot, ticks)
    tree.shutdown()
    return tree, robot


def test_an_operator_is_silent_late_or_rejects_what_he_should_approve():
    def heard(mode: FaultMode) -> list[list[str]]:
        inbox = FaultyInbox(OperatorInbox(), [Fault("operator", mode, start=0.1, duration=0.2, by=0.3)])
        found = []
        for index in range(6):
            inbox.put(Approve("footsteps", index))
            found.append([f"{event.name} {event.value[1]}" for event in inbox.drain(index / 10.0)])
        return found

    assert heard(FaultMode.OFF) == [["approve 0"], [], [], ["approve 3"], ["approve 4"], ["approve 5"]]
    assert heard(FaultMode.WRONG)[:4] == [["approve 0"], ["reject 1"], ["reject 2"], ["approve 3"]]
    assert heard(FaultMode.DELAYED)[1:] == [
        [],
        [],
        ["approve 3"],
        ["approve 1", "approve 4"],
        ["approve 2", "approve 5"],
    ]


def test_a_leaf_is_off_stuck_or_raises():
    tree, _ = broken(FaultMode.OFF)
    assert (tree.outcome, tree.reason) == (Outcome.FAILURE, "injected fault")
    tree, _ = broken(FaultMode.STUCK)
    assert tree.outcome is Outcome.RUNNING and tree.blackboard["square"] is None
    tree, robot = broken(FaultMode.EXCEPTION)
    assert tree.reason == "/t/square: InjectedFaultError in tick: injected fault"
    assert robot.commands == [("pause_walking", 0.0)]


def test_a_wrong_leaf_gives_nothing_and_an_intermittent_one_fails_sometimes():
    tree, _ = broken(FaultMode.WRONG)
    assert tree.node("/t/scripted").status.name == "INVALID" and tree.blackboard["square"] is None
    outcomes = {broken(FaultMode.INTERMITTENT, share=0.5, seed=seed)[0].outcome for seed in range(8)}
    assert outcomes == {Outcome.FAILURE, Outcome.RUNNING}


def test_a_slow_leaf_gives_its_result_later_and_keeps_its_budget():
    def delivered(**options: Any) -> tuple[float, float]:
        tree, robot = make(TREE)
        if options:
            break_leaf(tree.node("/t/square"), [Fault("/t/square", FaultMode.SLOW, **options)])
        tree.set_input("n", 3.0)
        run(tree, robot, 30)
        (job,) = tree.drain_jobs()
        tree.shutdown()
        assert tree.blackboard["square"] == 9.0
        return round(job.ended, 6), job.budget

    assert delivered() == (0.1, 0.1)
    assert delivered(by=0.2) == (0.3, 0.1)


def test_a_leaf_is_replaced_by_a_scripted_one_for_a_time():
    tree, robot = make("{tree: t, root: {loop_forever: {Scripted: {says: S}}}}")
    break_leaf(
        tree.node("/t/scripted"), [Fault("/t/scripted", FaultMode.SCRIPT, start=0.02, duration=0.08, says="RRF")]
    )
    found = []
    for _ in range(6):
        run(tree, robot, 1)
        found.append(tree.node("/t/scripted").status.name[0])
    assert found == ["S", "R", "R", "F", "R", "S"]


def test_a_fault_that_cannot_be_there_is_refused():
    tree, _ = make(TREE)
    with pytest.raises(ValueError, match="/t is no leaf"):
        break_leaf(tree.node("/t"), [Fault("/t", FaultMode.OFF)])
    with pytest.raises(ValueError, match='"slow" cannot be injected at /t/scripted: Scripted computes nothing'):
        break_leaf(tree.node("/t/scripted"), [Fault("/t/scripted", FaultMode.SLOW)])


BROKEN_FILES = {
    "faults: [{at: sensor:depht, mode: off}]": (
        'f.yaml:1:15: faults[0].at: nothing to break at "sensor:depht"; did you mean "sensor:depth"? (allowed: '
        "sensor:depth, sensor:lidar, sensor:state, sensor:status, world:BLOCK, /path/of/a/leaf, operator)",
    ),
    "faults: [{at: sensor:state, mode: off}]": (
        'f.yaml:1:35: faults[0].mode: "off" cannot be injected at sensor:state '
        "(allowed there: stuck, wrong, delayed, nan, exception)",
    ),
    "faults: [{at: /t/leaf, mode: nan}]": (
        'f.yaml:1:30: faults[0].mode: "nan" cannot be injected at /t/leaf '
        "(allowed there: off, stuck, wrong, slow, intermittent, exception, script)",
    ),
    "faults: [{at: world:b, mode: slow}]": (
        'f.yaml:1:30: faults[0].mode: "slow" cannot be injected at world:b (allowed there: off, wrong)',
    ),
    "faults: [{at: /t, mode: offf, start: -1, shre: 2}]": (
        'f.yaml:1:25: faults[0].mode: got "offf"; did you mean "off"? (allowed: off, stuck, wrong, slow, delayed, '
        "intermittent, nan, exception, script, fallen, disabled)",
        "f.yaml:1:38: faults[0].start: got -1, allowed: 0 .. 86400 s",
        'f.yaml:1:42: faults[0]: unknown key "shre"; did you mean "share"? (allowed: at, mode, start, duration, by, '
        "share, scale, shift, says, seed)",
    ),
    "faults: [{at: /t, mode: script, says: SXF}]": (
        'f.yaml:1:39: faults[0].says: got "SXF", needs letters S, F and R',
    ),
    "fault: []": (
        'f.yaml:1:1: needs a list "faults", such as faults: [{at: sensor:depth, mode: off}]',
        'f.yaml:1:1: unknown key "fault" (keys of a fault file: faults)',
    ),
}


@pytest.mark.parametrize("text", BROKEN_FILES)
def test_a_broken_file_of_faults_is_told_all_its_problems(text: str):
    with pytest.raises(YamlError) as error:
        read_faults(parse_document(text, "f.yaml"))
    assert str(error.value) == "\n".join(BROKEN_FILES[text])


def test_every_possible_fault_is_read():
    for kind, modes in POSSIBLE.items():
        at = {"leaf": "/t/leaf", "world": "world:b"}.get(kind, kind)
        for mode in modes:
            (placed,) = read_faults(parse_document(f'faults: [{{at: "{at}", mode: {mode.value}}}]'))
            assert placed.fault.kind == kind and placed.fault.holds(0.0) and placed.fault.holds(1e6)


def test_a_faulty_leaf_is_itself_when_nothing_breaks():
    tree, robot = make("{tree: t, root: {sequence: [Scripted: {says: RS}, GiveNumber: {out: [number]}]}}")
    for path in ("/t/scripted", "/t/give_number"):
        break_leaf(tree.node(path), [Fault(path, FaultMode.OFF, start=99.0)])
    tree.set_parameter("/t/give_number", "value", 4.0)
    run(tree, robot, 3)
    assert tree.outcome is Outcome.SUCCESS and tree.blackboard["number"] == 4.0
    assert leaf_of(tree, "/t/scripted").leaf.calls == ["setup", "start", "tick", "tick"]  # type: ignore[attr-defined]
