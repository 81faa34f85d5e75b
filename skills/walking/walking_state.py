"""What a walking robot tells about itself: its estimated state, what it is doing, and the events of its steps."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

from skills.footsteps.footstep import Footstep, Side, Stance
from skills.geometry.pose import Array, Pose, readonly


@dataclass(frozen=True, slots=True, eq=False)
class RobotState:
    """The estimated state of the robot.

    Attributes:
        time: robot time [s].
        T_world_pelvis: pelvis frame.
        joint_positions: in the order of the robot model, (23,) [rad].
        joint_velocities: (23,) [rad/s].
        stance: both sole frames as they are now, also of a foot in the air.
        com_world, dcm_world: centre of mass and divergent component of motion, (3,) [m].
    """

    time: float
    T_world_pelvis: Pose
    joint_positions: Array
    joint_velocities: Array
    stance: Stance
    com_world: Array
    dcm_world: Array

    def __post_init__(self) -> None:
        for name in ("joint_positions", "joint_velocities", "com_world", "dcm_world"):
            object.__setattr__(self, name, readonly(getattr(self, name), (None,)))

    def moved(self, T: Pose) -> RobotState:
        """The same state seen from another frame."""
        return replace(
            self,
            T_world_pelvis=T @ self.T_world_pelvis,
            stance=self.stance.moved(T),
            com_world=T @ self.com_world,
            dcm_world=T @ self.dcm_world,
        )


class WalkingPhase(Enum):
    """What the legs are doing."""

    STANDING = "standing"
    TRANSFER = "transfer"
    SWING = "swing"
    FALLEN = "fallen"
    DISABLED = "disabled"


@dataclass(frozen=True, slots=True, eq=False)
class WalkingStatus:
    """What the walking controller is doing.

    Attributes:
        phase: standing, shifting weight, swinging, fallen, or disabled: not under control of walking.
        phase_elapsed, phase_duration: time in the phase, and its nominal duration, 0 when standing [s].
        current_step: the step whose transfer or swing is under way.
        queue: the steps after it.
        imminent_stance: the stance once the current step has landed, as commanded; the stance now when standing.
        last_side: side of the step under way or last made; None before the first.
        paused: whether the queue is held.
        failure: why the robot fell or is disabled; empty while it walks.
        last_sequence_id: of the step under way or last made; -1 before the first.
    """

    phase: WalkingPhase
    phase_elapsed: float
    phase_duration: float
    current_step: Footstep | None
    queue: tuple[Footstep, ...]
    imminent_stance: Stance
    last_side: Side | None
    paused: bool
    failure: str = ""
    last_sequence_id: int = -1

    @property
    def unable(self) -> str:
        """Why the robot takes no steps, in one sentence; empty where it does."""
        match self.phase:
            case WalkingPhase.FALLEN:
                return f"the robot has fallen: {self.failure}"
            case WalkingPhase.DISABLED:
                return f"the robot is disabled: {self.failure}"
            case _:
                return ""

    def moved(self, T: Pose) -> WalkingStatus:
        """The same status seen from another frame."""
        return replace(
            self,
            current_step=None if self.current_step is None else self.current_step.moved(T),
            queue=tuple(step.moved(T) for step in self.queue),
            imminent_stance=self.imminent_stance.moved(T),
        )


class StepEventKind(Enum):
    """What happened to a step."""

    STARTED = "started"
    COMPLETED = "completed"


@dataclass(frozen=True, slots=True, eq=False)
class StepEvent:
    """A step began its swing, or its foot has landed.

    Attributes:
        kind: started or completed.
        time: robot time [s].
        step: the step as commanded.
        T_world_sole: the sole as it was at the event.
    """

    kind: StepEventKind
    time: float
    step: Footstep
    T_world_sole: Pose

    def moved(self, T: Pose) -> StepEvent:
        """The same event seen from another frame."""
        return replace(self, step=self.step.moved(T), T_world_sole=T @ self.T_world_sole)
