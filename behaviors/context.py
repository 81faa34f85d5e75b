"""What every leaf of one tree shares: the robot as it is this tick, the clock, the executor, parameters and the log."""

from __future__ import annotations

import traceback
from collections import Counter
from dataclasses import dataclass
from typing import Any

from behaviors.executor import Executor
from behaviors.halt import Halt
from behaviors.operator import OperatorEvent, PauseWalk, ResetBehavior, ResumeWalk, ReviewRequest
from behaviors.robot_view import RobotView
from skills.walking.walking_state import StepEvent


@dataclass(frozen=True, slots=True)
class LogLine:
    """One line for the operator.

    Attributes:
        time: robot time [s].
        path: the node that wrote it; "walker" for the walking controller.
        level: "info", "warning" or "error".
        text: what it says.
    """

    time: float
    path: str
    level: str
    text: str


@dataclass(frozen=True, slots=True)
class Fault:
    """An exception in a node.

    Attributes:
        time: robot time [s].
        path: the node.
        phase: "setup", "start", "tick" or "stop"; "trace" where the tick could not be recorded.
        type: name of the exception's class.
        message: what it said.
        traceback: where it came from.
    """

    time: float
    path: str
    phase: str
    type: str
    message: str
    traceback: str

    def __str__(self) -> str:
        return f"{self.path}: {self.type} in {self.phase}: {self.message}"


class NodeFaultError(Exception):
    """Unwinds a tick after a fault that is already recorded."""


class Context:
    """Shared by all nodes of one tree, by nobody else.

    Attributes:
        robot: sensors, state and commands; the same snapshot for all leaves of a tick.
        time: robot time at the start of the tick [s].
        tick: ticks since the start, the first is 0.
        executor: computes for leaves that take long.
        parameters: parameters of the skills by subject, such as `parameters["footsteps"]`.
        operator_events: what the operator did since the last tick.
        paused: whether the operator has paused the walk, and neither resumed nor reset it.
        halts: why the robot is held, as leaves have said in this tick.
        reviews: what waits for the operator's decision, as checkpoints have said in this tick.
        log_lines: lines since the recorder took them last.
        faults: exceptions so far.
    """

    def __init__(self, robot: RobotView, executor: Executor, parameters: dict[str, Any]) -> None:
        self.robot = robot
        self.executor = executor
        self.parameters = parameters
        self.time = robot.time
        self.tick = 0
        self.operator_events: tuple[OperatorEvent, ...] = ()
        self.paused = False
        self.halts: list[Halt] = []
        self.reviews: list[ReviewRequest] = []
        self.log_lines: list[LogLine] = []
        self.faults: list[Fault] = []
        self._made: Counter[str] = Counter()

    @property
    def events(self) -> tuple[StepEvent, ...]:
        """Step events since the last tick, oldest first; every leaf sees the same."""
        return self.robot.events

    def begin_tick(self, events: tuple[OperatorEvent, ...]) -> None:
        """Show the leaves what the operator did; what held the robot in the last tick holds it no longer."""
        self.operator_events = events
        self.halts, self.reviews = [], []
        for event in events:
            if isinstance(event, PauseWalk):
                self.paused = True
            elif isinstance(event, ResumeWalk | ResetBehavior):
                self.paused = False

    def new_id(self, kind: str) -> int:
        """The next id of a kind of things, from 0; no two things of a kind share one, whichever leaf makes them."""
        self._made[kind] += 1
        return self._made[kind] - 1

    def log(self, text: str, *, path: str = "", level: str = "info") -> None:
        """Write one line for the operator."""
        self.log_lines.append(LogLine(self.time, path, level, text))

    def record_fault(self, path: str, phase: str, error: Exception) -> None:
        """Keep an exception, and log it with its traceback."""
        text = "".join(traceback.format_exception(error))
        fault = Fault(self.time, path, phase, type(error).__name__, str(error), text)
        self.faults.append(fault)
        self.log(f"{fault}\n{text}", path=path, level="error")
