"""A robot and leaves for tests: a clock that is moved by hand, and statuses that are said beforehand."""

from __future__ import annotations

from typing import Any

import numpy as np

from behaviors import Call, Input, Leaf, Node, Output, Registry, SkillLeaf, Status, Tree, parse_tree
from skills.footsteps.footstep import Footstep, Side, Stance
from skills.geometry.pose import Pose
from skills.parameters import parameter, parameters
from skills.walking.walking_state import RobotState, StepEvent, WalkingPhase, WalkingStatus

PERIOD = 0.02
STATUSES = {"S": Status.SUCCESS, "F": Status.FAILURE, "R": Status.RUNNING}


class ScriptedRobot:
    """Stands where it is told, at the time it is told."""

    def __init__(self) -> None:
        self.time = 0.0
        self.pose = Pose.identity()
        self.commands: list[tuple[str, float]] = []
        self.events: tuple[StepEvent, ...] = ()
        self.sent: tuple[Footstep, ...] = ()

    def state(self) -> RobotState:
        zeros = np.zeros(23)
        return RobotState(self.time, self.pose, zeros, zeros, self._stance(), np.zeros(3), np.zeros(3))

    def status(self) -> WalkingStatus:
        return WalkingStatus(WalkingPhase.STANDING, 0.0, 0.0, None, (), self._stance(), None, False)

    def depth_frames(self) -> dict[str, int]:
        return {}

    def depth_image(self, camera: str) -> None:
        return None

    def lidar_scan(self) -> None:
        return None

    def send_footsteps(self, steps: tuple[Footstep, ...]) -> None:
        self.sent = steps
        self.commands.append(("send_footsteps", self.time))

    def pause_walking(self) -> None:
        self.commands.append(("pause_walking", self.time))

    def drain_events(self) -> tuple[StepEvent, ...]:
        events, self.events = self.events, ()
        return events

    def drain_log(self) -> tuple[()]:
        return ()

    def _stance(self) -> Stance:
        return Stance(Pose.from_xyz_rpy((0.0, 0.1, 0.0)), Pose.from_xyz_rpy((0.0, -0.1, 0.0)))


def footstep(sequence_id: int = 0, x: float = 0.4) -> Footstep:
    """A level step."""
    sole = np.array([[0.13, 0.07], [-0.13, 0.07], [-0.13, -0.07], [0.13, -0.07]])
    return Footstep(sequence_id, Side.LEFT, Pose.from_xyz_rpy((x, 0.1, 0.0)), sole, 1.2, 0.8, 0.1, np.empty((0, 3)))


toys = Registry()


@parameters
class ScriptParameters:
    """What a scripted leaf says."""

    says: str = parameter("S", unit="1", meaning="one letter a tick: S, F or R; the last one repeats")
    breaks: str = parameter(
        "", unit="1", meaning="the hook that raises", choices=("", "setup", "start", "tick", "stop")
    )


@toys
class Scripted(Leaf):
    """Says what it is told, and remembers which hooks were called."""

    Parameters = ScriptParameters

    def setup(self) -> None:
        self.calls: list[str] = []
        self.said = 0
        self._note("setup")

    def start(self) -> None:
        self._note("start")

    def tick(self) -> Status:
        self._note("tick")
        says = self.parameters.says
        letter = says[min(self.said, len(says) - 1)]
        self.said += 1
        self.reason = f"said {letter}"
        return STATUSES[letter]

    def stop(self) -> None:
        self._note("stop")

    def _note(self, hook: str) -> None:
        self.calls.append(hook)
        if self.parameters.breaks == hook:
            raise RuntimeError(f"broken {hook}")


@parameters
class NumberParameters:
    """Which number."""

    value: float = parameter(1.0, unit="m", meaning="what it gives", minimum=-10.0, maximum=10.0)


@toys
class GiveNumber(Leaf):
    """Gives a number."""

    Parameters = NumberParameters
    number = Output(float, "a number")

    def tick(self) -> Status:
        self.number = self.parameters.value
        return self.succeeded()


@toys
class AddOne(Leaf):
    """Gives a number one larger than the one it takes."""

    number = Input(float, "a number")
    sum = Output(float, "a larger number")

    def tick(self) -> Status:
        self.sum = self.number + 1.0
        return self.succeeded()


@toys
class GiveText(Leaf):
    """Gives a text."""

    text = Output(str, "a text")

    def tick(self) -> Status:
        self.text = "text"
        return self.succeeded()


@toys
class Square(SkillLeaf):
    """Squares a number in the executor."""

    number = Input(float, "a number")
    square = Output(float, "its square")

    def request(self) -> Call | Status:
        return self.call(square, self.number)

    def receive(self, result: float) -> Status:
        self.square = result
        return self.succeeded()


@toys
class PauseWalking(Leaf):
    """Tells the robot to stand."""

    def tick(self) -> Status:
        self.context.robot.pause_walking()
        return self.succeeded()


def square(number: float) -> float:
    """What `Square` computes."""
    return number * number


def make(text: str, robot: ScriptedRobot | None = None, **options: Any) -> tuple[Tree, ScriptedRobot]:
    """A tree of toy leaves on a scripted robot."""
    robot = robot or ScriptedRobot()
    return Tree(parse_tree(text, toys), robot, **options), robot


def run(tree: Tree, robot: ScriptedRobot, ticks: int) -> None:
    """Tick so many times, one period apart, beginning now."""
    for _ in range(ticks):
        robot.time = tree.next_tick_time
        tree.tick()


def calls(tree: Tree, path: str) -> list[str]:
    """Which hooks of a scripted leaf were called after setup."""
    return leaf_of(tree, path).calls[1:]  # type: ignore[attr-defined]


def leaf_of(tree: Tree, path: str) -> Leaf:
    """The leaf of a node."""
    return tree.node(path).leaf  # type: ignore[attr-defined]


def letters(nodes: tuple[Node, ...]) -> str:
    """Statuses as letters, a dot for none."""
    names = {status: letter for letter, status in STATUSES.items()}
    return "".join(names.get(node.status, ".") for node in nodes)
