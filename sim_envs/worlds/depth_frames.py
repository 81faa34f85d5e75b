"""The frames of a simulated depth camera: noted when they fall due, rendered only when somebody looks.

A frame that nobody reads costs a copy of the shapes' poses; its content depends on the seed and on its number, never
on which other frames were read.
"""

# mujoco keeps its types in binary modules without stubs.
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from dataclasses import dataclass

import mujoco

from sim_envs.sensors import DepthCamera
from skills.geometry.camera import DepthImage
from skills.geometry.pose import Array, Pose

_EARLY = 1e-9  # Robot time is a sum of floats; a frame is due this much before its time [s].


@dataclass(frozen=True, slots=True, eq=False)
class Snapshot:
    """Everything that a frame shows.

    Attributes:
        time: robot time [s].
        frame_id: counts frames from 0.
        geom_positions, geom_rotations: poses of all shapes, (G, 3) [m] and (G, 3, 3).
        T_world_camera: true pose of the camera.
        T_world_camera_estimate: where the robot believes it is.
    """

    time: float
    frame_id: int
    geom_positions: Array
    geom_rotations: Array
    T_world_camera: Pose
    T_world_camera_estimate: Pose


class DepthFrames:
    """Takes snapshots at the camera's rate and renders the newest on demand."""

    def __init__(self, camera: DepthCamera) -> None:
        self._camera = camera
        self._snapshot: Snapshot | None = None
        self._image: DepthImage | None = None
        self._count = 0

    @property
    def camera(self) -> DepthCamera:
        """The camera that takes the frames."""
        return self._camera

    def due(self, time: float) -> bool:
        """Whether the next frame should be taken at this robot time."""
        return time + _EARLY >= self._count / self._camera.parameters.rate

    def take(self, time: float, data: mujoco.MjData, T_world_camera: Pose, T_world_camera_estimate: Pose) -> None:
        """Note what the next frame shows."""
        self._snapshot = Snapshot(
            time,
            self._count,
            data.geom_xpos.copy(),
            data.geom_xmat.reshape(-1, 3, 3).copy(),
            T_world_camera,
            T_world_camera_estimate,
        )
        self._count += 1

    def newest(self) -> DepthImage | None:
        """The newest frame; None before the first."""
        snapshot = self._snapshot
        if snapshot is not None and (self._image is None or self._image.frame_id != snapshot.frame_id):
            self._image = self._camera.capture(
                snapshot.geom_positions,
                snapshot.geom_rotations,
                snapshot.T_world_camera,
                snapshot.time,
                snapshot.frame_id,
                snapshot.T_world_camera_estimate,
            )
        return self._image
