"""One tick of a run as those who watch it see it: the recording, the statistics and the progress bar."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

from behaviors import JobRecord, LogLine, Tree
from behaviors.halt import HaltCause
from sim_envs.worlds import SimulatedWorld
from skills.walking import ControlSample, RobotState, StepEvent, WalkingStatus


@dataclass(frozen=True, slots=True, eq=False)
class Moment:
    """What happened in one tick.

    Attributes:
        time: robot time [s].
        world: the simulated world, to be read only.
        tree: the behavior tree after its tick, to be read only.
        state: the true state of the robot.
        status: what the walking controller is doing.
        events: step events since the last tick.
        samples: control-rate samples since the last tick.
        jobs: computations that ended in this tick.
        log: lines for the operator.
    """

    time: float
    world: SimulatedWorld
    tree: Tree
    state: RobotState
    status: WalkingStatus
    events: tuple[StepEvent, ...]
    samples: tuple[ControlSample, ...]
    jobs: tuple[JobRecord, ...]
    log: tuple[LogLine, ...]

    @property
    def blocked(self) -> bool:
        """Whether a leaf has said in this tick that the way is blocked."""
        return any(halt.cause is HaltCause.BLOCKED for halt in self.tree.context.halts)


class Observer(Protocol):
    """Watches a run without changing it."""

    def observe(self, moment: Moment) -> None:
        """Take note of one tick."""
        ...
