"""A depth camera like the Intel RealSense L515.

It takes snapshots of geom poses rather than a simulation, so that a frame can be rendered later than it was taken, in
another thread, or never.
"""

# mujoco keeps its types in binary modules without stubs.
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from functools import partial

import mujoco
import numpy as np
from numpy.typing import NDArray

from sim_envs.sensors.depth_noise import DepthNoise, DepthNoiseModel
from sim_envs.sensors.geom_mesh import geom_mesh
from sim_envs.sensors.own_body import NO_BODY, OwnBody
from sim_envs.sensors.rasterizer import in_view, rasterize_depth
from sim_envs.sensors.snapshot import Snapshot
from skills.geometry.camera import DepthImage, PinholeCamera
from skills.geometry.pose import Array, Pose
from skills.parameters import parameter, parameters

# Faces around a round shape: a leg is drawn at most 0.7 mm too thin, far less than the noise.
_SEGMENTS = 20


@parameters
class DepthCameraParameters:
    """Optics and rate of the depth camera; where it sits is a matter of the robot."""

    width: int = parameter(1024, unit="px", minimum=16, maximum=4096, meaning="columns of an image")
    height: int = parameter(768, unit="px", minimum=16, maximum=4096, meaning="rows of an image")
    horizontal_fov_deg: float = parameter(
        70.0, unit="deg", minimum=5.0, maximum=150.0, meaning="angle of view from left to right"
    )
    vertical_fov_deg: float = parameter(
        55.0, unit="deg", minimum=5.0, maximum=150.0, meaning="angle of view from top to bottom"
    )
    near: float = parameter(0.1, unit="m", minimum=0.01, maximum=1.0, meaning="nearer depths return nothing")
    far: float = parameter(9.0, unit="m", minimum=1.0, maximum=100.0, meaning="farther depths return nothing")
    rate: float = parameter(
        30.0, unit="Hz", minimum=0.1, maximum=200.0, meaning="images a second of the camera that looks where it goes"
    )
    rate_elsewhere: float = parameter(
        5.0, unit="Hz", minimum=0.1, maximum=200.0, meaning="images a second of each of the other cameras"
    )
    resolution: float = parameter(
        1.0, unit="1", minimum=0.05, maximum=1.0, meaning="share of the columns and rows that are rendered"
    )

    body_margin: float = parameter(
        0.01, unit="m", minimum=0.0, maximum=0.5, meaning="how much thicker the robot's own body is told than it is"
    )

    @property
    def camera(self) -> PinholeCamera:
        """Intrinsics of the images."""
        fx = 0.5 * self.width / np.tan(0.5 * np.deg2rad(self.horizontal_fov_deg))
        fy = 0.5 * self.height / np.tan(0.5 * np.deg2rad(self.vertical_fov_deg))
        cx, cy = 0.5 * (self.width - 1), 0.5 * (self.height - 1)
        full = PinholeCamera(self.width, self.height, float(fx), float(fy), cx, cy, self.near, self.far)
        return full.scaled(self.resolution)


class DepthCamera:
    """Depth images of a MuJoCo model, the robot's own legs included.

    Its methods change nothing, so that several threads may share one camera.

    Args:
        model: what the camera sees.
        parameters: optics.
        noise: errors.
        seed: of the errors.
        body: the robot that carries the camera.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        parameters: DepthCameraParameters,
        noise: DepthNoise,
        *,
        seed: int,
        body: OwnBody = NO_BODY,
    ) -> None:
        self.parameters = parameters
        self.camera = parameters.camera
        self.mesh = geom_mesh(model, segments=_SEGMENTS)
        self._body = body
        self._noise = DepthNoiseModel(noise, self.camera, seed)
        self._T_mount = Pose(self._noise.R_mount, np.zeros(3))

    @property
    def rate(self) -> float:
        """Images a second of robot time [Hz]."""
        return self.parameters.rate

    def capture(self, snapshot: Snapshot) -> DepthImage:
        """What the sensor delivers: noisy depth, and the poses of camera and body that the robot believes in."""
        T_world_true = snapshot.T_world_sensor @ self._T_mount
        clean = self.render(snapshot.geom_positions, snapshot.geom_rotations, T_world_true)
        depth = self._noise.corrupt(clean, snapshot.number)
        T_world_camera = snapshot.T_estimate_world @ snapshot.T_world_sensor
        body_world = self._body.capsules(snapshot, self.parameters.body_margin, partial(in_view, camera=self.camera))
        return DepthImage(depth, self.camera, T_world_camera, snapshot.time, snapshot.number, body_world)

    def render(self, geom_positions: Array, geom_rotations: Array, T_world_camera: Pose) -> NDArray[np.float32]:
        """True depth, (height, width) float32 [m]; 0 where nothing is within range."""
        return rasterize_depth(self.mesh, geom_positions, geom_rotations, self.camera, T_world_camera)
