"""A spinning lidar like the Ouster OS0-128, which is made for near ground: a wide vertical field of view."""

# mujoco keeps its types in binary modules without stubs.
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from functools import partial

import mujoco
import numpy as np
from numpy.typing import NDArray

from sim_envs.sensors.lidar_caster import cast_ranges, in_field
from sim_envs.sensors.lidar_noise import LidarNoise, LidarNoiseModel
from sim_envs.sensors.own_body import NO_BODY, OwnBody
from sim_envs.sensors.ray_shapes import ray_shapes
from sim_envs.sensors.snapshot import Snapshot
from skills.geometry.lidar import LidarScan, SpinningLidar
from skills.geometry.pose import Array, Pose
from skills.parameters import parameter, parameters


@parameters
class LidarParameters:
    """Rays and rate of the lidar; where it sits is a matter of the robot."""

    rings: int = parameter(128, unit="1", minimum=2, maximum=1024, meaning="rays above one another")
    columns: int = parameter(1024, unit="1", minimum=8, maximum=8192, meaning="rays around")
    vertical_fov_deg: float = parameter(
        90.0, unit="deg", minimum=1.0, maximum=170.0, meaning="angle from the highest to the lowest ring"
    )
    near: float = parameter(0.3, unit="m", minimum=0.01, maximum=5.0, meaning="nearer ranges return nothing")
    far: float = parameter(50.0, unit="m", minimum=1.0, maximum=500.0, meaning="farther ranges return nothing")
    rate: float = parameter(10.0, unit="Hz", minimum=0.1, maximum=100.0, meaning="scans a second of robot time")

    body_margin: float = parameter(
        0.05, unit="m", minimum=0.0, maximum=0.5, meaning="how much thicker the robot's own body is told than it is"
    )

    @property
    def lidar(self) -> SpinningLidar:
        """Where the rays point."""
        half = 0.5 * float(np.deg2rad(self.vertical_fov_deg))
        return SpinningLidar(self.rings, self.columns, half, -half, self.near, self.far)


class Lidar:
    """Scans of a MuJoCo model, the robot's own arms included, each taken as if all at once.

    Its methods change nothing, so that several threads may share one lidar.

    Args:
        model: what the lidar sees.
        parameters: rays.
        noise: errors.
        seed: of the errors.
        body: the robot that carries the lidar.

    Raises:
        ValueError: where something visible has a shape that rays are not cast at.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        parameters: LidarParameters,
        noise: LidarNoise,
        *,
        seed: int,
        body: OwnBody = NO_BODY,
    ) -> None:
        self.parameters = parameters
        self.lidar = parameters.lidar
        self.shapes = ray_shapes(model)
        self._body = body
        self._noise = LidarNoiseModel(noise, self.lidar, seed)
        self._T_mount = Pose(self._noise.R_mount, np.zeros(3))

    @property
    def rate(self) -> float:
        """Scans a second of robot time [Hz]."""
        return self.parameters.rate

    def capture(self, snapshot: Snapshot) -> LidarScan:
        """What the sensor delivers: noisy ranges, and the poses of lidar and body that the robot believes in."""
        T_world_true = snapshot.T_world_sensor @ self._T_mount
        clean = self.render(snapshot.geom_positions, snapshot.geom_rotations, T_world_true)
        ranges = self._noise.corrupt(clean, snapshot.number)
        T_world_lidar = snapshot.T_estimate_world @ snapshot.T_world_sensor
        body_world = self._body.capsules(snapshot, self.parameters.body_margin, partial(in_field, lidar=self.lidar))
        return LidarScan(ranges, self.lidar, T_world_lidar, snapshot.time, snapshot.number, body_world)

    def render(self, geom_positions: Array, geom_rotations: Array, T_world_lidar: Pose) -> NDArray[np.float32]:
        """True ranges, (rings, columns) float32 [m]; 0 where nothing is within range."""
        return cast_ranges(self.shapes, geom_positions, geom_rotations, self.lidar, T_world_lidar)
