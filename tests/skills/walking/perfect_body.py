"""A body whose accelerations are those that its walker commands, on ground that is a height over the plane."""

from collections.abc import Callable, Sequence

import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports]

from skills.footsteps.footstep import Footstep, Side
from skills.geometry.pose import Array, Pose
from skills.walking import BodyMeasurement, RobotModel, StepEvent, StepEventKind, Walker, WalkingPhase
from skills.walking.body_dynamics import BodyDynamics
from skills.walking.whole_body_controller import BodyCommand

Ground = Callable[[Array], Array]

RATE = 100.0
LOAD = 1000.0
FIRST_AND_LAST_TRANSFER = 0.7 + 0.8


def ground_of(poses: Sequence[Pose], lower: float = 0.0) -> Ground:
    """Ground whose every point lies in the plane of the nearest sole pose, lowered by as much [m]."""
    centres, normals = np.stack([pose.p for pose in poses]), np.stack([pose.R[:, 2] for pose in poses])

    def heights(points: Array) -> Array:
        nearest = np.argmin(np.sum((points[:, None] - centres[None, :, :2]) ** 2, axis=2), axis=1)
        centre, normal = centres[nearest], normals[nearest]
        across = np.sum(normal[:, :2] * (points - centre[:, :2]), axis=1)
        return centre[:, 2] - across / normal[:, 2] - lower

    return heights


class PerfectBody:
    """Drives a walker.

    Args:
        model: the robot.
        walker: its controller.
        ground: heights (N,) of the ground at points (N, 2) in the world [m].

    Attributes:
        q, v: configuration and velocity; a test may kick it by writing `v`.
        command: of the last tick.
        events: all step events so far.
        pressed: feet that something presses from below besides the ground; a test may write it.
        unfelt: feet that nothing presses, wherever they are; a test may write it.
    """

    def __init__(self, model: RobotModel, walker: Walker, ground: Ground) -> None:
        self.model, self.walker, self.ground = model, walker, ground
        self.dynamics = BodyDynamics(model)
        self.q, self.v = walker.start_configuration, np.zeros(model.pin_model.nv)
        self.dynamics.update(self.q, self.v)
        self.events: list[StepEvent] = []
        self.command: BodyCommand | None = None
        self.pressed: tuple[Side, ...] = ()
        self.unfelt: tuple[Side, ...] = ()
        self.ticks = 0
        self._supports = walker.supports

    @property
    def time(self) -> float:
        return self.ticks / RATE

    @property
    def phase(self) -> WalkingPhase:
        return self.walker.status().phase

    def landings(self) -> list[StepEvent]:
        return [event for event in self.events if event.kind is StepEventKind.COMPLETED]

    def send(self, *steps: Footstep) -> None:
        self.walker.send(steps)

    def advance(self, duration: float, each_tick: Callable[[], None] | None = None) -> None:
        """Let time pass [s]; a callable looks at the robot after every tick."""
        for _ in range(round(duration * RATE)):
            self._tick()
            if each_tick is not None:
                each_tick()

    def advance_until(self, reached: Callable[[], bool], at_most: float = 10.0) -> None:
        """Let time pass until something is so [s]."""
        for _ in range(round(at_most * RATE)):
            if reached():
                return
            self._tick()
        raise AssertionError(f"not reached within {at_most} s: {self.walker.status()}")

    def walk(self, *steps: Footstep, rest: float = 0.5, each_tick: Callable[[], None] | None = None) -> None:
        """Make steps and stand for a while, whatever comes of it [s]."""
        self.send(*steps)
        under_way = sum(step.swing_duration + step.transfer_duration for step in steps)
        self.advance(FIRST_AND_LAST_TRANSFER + under_way + rest, each_tick)

    def _tick(self) -> None:
        self.ticks += 1
        command = self.command = self.walker.control(BodyMeasurement(self.time, self.q, self.v, self._loads()))
        self.events += self.walker.drain_events()
        v = self.v + command.acceleration / RATE
        if self.walker.supports != self._supports:
            v = self._at_rest_on_the_ground(v)
        self._supports = self.walker.supports
        self.q, self.v = pin.integrate(self.model.pin_model, self.q, v / RATE), v
        self.dynamics.update(self.q, self.v)

    def _loads(self) -> dict[Side, float]:
        return {side: LOAD * self._is_pressed(side) for side in Side}

    def _is_pressed(self, side: Side) -> bool:
        if side in self.unfelt:
            return False
        return side in self._supports or side in self.pressed or self._touches(side)

    def _touches(self, side: Side) -> bool:
        sole = self.dynamics.sole(side)
        corners = sole @ np.column_stack((self.model.foothold_sole, np.zeros(4)))
        sinking = -float(sole.R[2] @ self.dynamics.sole_velocity(side)[:3])
        return bool(np.min(corners[:, 2] - self.ground(corners[:, :2])) <= max(0.0, 0.5 * sinking / RATE))

    def _at_rest_on_the_ground(self, v: Array) -> Array:
        J = np.vstack([self.dynamics.sole_jacobians[side] for side in self.walker.supports])
        M_inverse_Jt = np.linalg.solve(self.dynamics.mass_matrix, J.T)
        return v - M_inverse_Jt @ np.linalg.solve(J @ M_inverse_Jt, J @ v)
