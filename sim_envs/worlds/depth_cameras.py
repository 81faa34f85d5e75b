"""The depth cameras of a simulated robot: as many as its table mounts, each with its own errors.

The one that looks most nearly where the robot goes takes images at the full rate, the others at a lower one.
"""

# mujoco keeps its types in binary modules without stubs.
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import mujoco
import numpy as np

from sim_envs.robot import CameraMount
from sim_envs.sensors import DepthCamera, DepthCameraParameters, DepthNoise, OwnBody, Snapshot
from sim_envs.worlds.sensor_frames import SensorFrames
from skills.geometry.camera import DepthImage
from skills.geometry.pose import Pose, wrap_angle

_SEEDS = 1 << 32  # seeds of the cameras of one robot lie so far apart


@dataclass(frozen=True, slots=True)
class _MountedCamera:
    """A sensor whose images carry the camera's name, and numbers that no other camera of the robot gives."""

    mount: CameraMount
    camera: DepthCamera
    index: int
    count: int

    @property
    def rate(self) -> float:
        return self.camera.rate

    def capture(self, snapshot: Snapshot) -> DepthImage:
        image = self.camera.capture(snapshot)
        return replace(image, frame_id=self.frame_id(snapshot.number), camera_name=self.mount.name)

    def frame_id(self, number: int) -> int:
        return number * self.count + self.index


class DepthCameras:
    """Takes and renders the images of all depth cameras of a robot.

    Args:
        model: what they see.
        mounts: where they sit, each with the index in the model of the body that carries it.
        parameters: optics and rates of each.
        noise: errors of each.
        seed: of the errors; each camera has its own.
        body: the robot.
    """

    def __init__(
        self,
        model: mujoco.MjModel,
        mounts: Sequence[tuple[CameraMount, int]],
        parameters: DepthCameraParameters,
        noise: DepthNoise,
        *,
        seed: int,
        body: OwnBody,
    ) -> None:
        self._every_elsewhere = max(1, round(parameters.rate / parameters.rate_elsewhere))
        self._cameras: dict[str, tuple[_MountedCamera, SensorFrames[DepthImage]]] = {}
        for index, (mount, body_index) in enumerate(mounts):
            camera = DepthCamera(model, parameters, noise, seed=seed + index * _SEEDS, body=body)
            mounted = _MountedCamera(mount, camera, index, len(mounts))
            self._cameras[mount.name] = mounted, SensorFrames(mounted, body_index, mount.T_body_camera)

    def __getitem__(self, name: str) -> DepthCamera:
        """One of the cameras."""
        return self._cameras[name][0].camera

    @property
    def names(self) -> tuple[str, ...]:
        """Of all cameras, in the order of the robot's table."""
        return tuple(self._cameras)

    def due(self, time: float) -> bool:
        """Whether the next image of some camera is due at a robot time [s]."""
        return any(frames.due(time) for _, frames in self._cameras.values())

    def advance(self, time: float, data: mujoco.MjData, T_estimate_world: Pose, travel_yaw: float) -> None:
        """Note what the world looks like for the images that are due at this robot time [s].

        `travel_yaw` is the direction in which the robot goes, to the left of where it faces [rad].
        """
        ahead = min(self._cameras, key=lambda name: abs(wrap_angle(self._yaw(name) - travel_yaw)))
        for name, (_, frames) in self._cameras.items():
            frames.advance(time, data, T_estimate_world, 1 if name == ahead else self._every_elsewhere)

    def frames(self) -> dict[str, int]:
        """Id of the newest image of each camera that has one."""
        numbers = {name: frames.number for name, (_, frames) in self._cameras.items()}
        return {name: self._cameras[name][0].frame_id(n) for name, n in numbers.items() if n is not None}

    def newest(self, name: str) -> DepthImage | None:
        """The newest image of a camera, rendered when it is first asked for; None before its first."""
        return self._cameras[name][1].newest()

    def _yaw(self, name: str) -> float:
        return float(np.deg2rad(self._cameras[name][0].mount.yaw_deg))
