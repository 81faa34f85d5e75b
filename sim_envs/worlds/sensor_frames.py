"""What a simulated sensor measures: noted when it falls due, rendered only when somebody looks.

A measurement that nobody reads costs a copy of the shapes' poses; its content depends on the seed and on its number,
never on which others were read.
"""

# mujoco keeps its types in binary modules without stubs.
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from typing import Generic, Protocol, TypeVar

import mujoco

from sim_envs.sensors import Snapshot
from skills.geometry.pose import Pose

_EARLY = 1e-9  # Robot time is a sum of floats; a measurement is due this much before its time [s].

Frame = TypeVar("Frame", covariant=True)


class Sensor(Protocol[Frame]):
    """Turns snapshots into measurements."""

    @property
    def rate(self) -> float:
        """Measurements a second of robot time [Hz]."""
        ...

    def capture(self, snapshot: Snapshot) -> Frame:
        """What the sensor delivers."""
        ...


class SensorFrames(Generic[Frame]):
    """Takes snapshots at a sensor's rate and renders the newest on demand.

    Args:
        sensor: takes the measurements.
        body: index in the model of the body that carries it.
        T_body_sensor: where on that body it sits.
    """

    def __init__(self, sensor: Sensor[Frame], body: int, T_body_sensor: Pose) -> None:
        self._sensor = sensor
        self._body = body
        self._T_body_sensor = T_body_sensor
        self._snapshot: Snapshot | None = None
        self._rendered: tuple[Snapshot, Frame] | None = None
        self._count = 0
        self._next = 0  # the earliest time of its rate at which it may measure again

    def due(self, time: float) -> bool:
        """Whether the next measurement is due at a robot time [s]."""
        return time + _EARLY >= self._next / self._sensor.rate

    def advance(self, time: float, data: mujoco.MjData, T_estimate_world: Pose, every: int = 1) -> None:
        """Note what the world looks like if the next measurement is due at this robot time [s].

        After it so many of the sensor's times pass until the next.
        """
        if not self.due(time):
            return
        T_world_body = Pose(data.xmat[self._body].reshape(3, 3), data.xpos[self._body])
        self._snapshot = Snapshot(
            time,
            self._count,
            data.geom_xpos.copy(),
            data.geom_xmat.reshape(-1, 3, 3).copy(),
            T_world_body @ self._T_body_sensor,
            T_estimate_world,
        )
        self._count += 1
        self._next += every

    @property
    def number(self) -> int | None:
        """Number of the newest measurement; None before the first."""
        return None if self._snapshot is None else self._snapshot.number

    def newest(self) -> Frame | None:
        """The newest measurement; None before the first."""
        if self._snapshot is None:
            return None
        if self._rendered is None or self._rendered[0] is not self._snapshot:
            self._rendered = (self._snapshot, self._sensor.capture(self._snapshot))
        return self._rendered[1]
