"""What the world looked like at one instant: all that a sensor needs to measure later, in another thread, or never."""

from __future__ import annotations

from dataclasses import dataclass, field

from skills.geometry.pose import Array, Pose


@dataclass(frozen=True, slots=True, eq=False)
class Snapshot:
    """An instant as one sensor meets it.

    Attributes:
        time: robot time [s].
        number: counts the sensor's measurements from 0; with the sensor's seed it determines the noise.
        geom_positions: copy of `MjData.geom_xpos`, (ngeom, 3) [m].
        geom_rotations: copy of `MjData.geom_xmat`, (ngeom, 3, 3).
        T_world_sensor: true pose of the sensor's mount.
        T_estimate_world: the robot's estimate of a place from the true place: where it believes things to be.
    """

    time: float
    number: int
    geom_positions: Array
    geom_rotations: Array
    T_world_sensor: Pose
    T_estimate_world: Pose = field(default_factory=Pose.identity)
