"""Pinhole cameras and the depth images they take.

Pixel (u, v) = (column, row) looks along ((u - cx) / fx, (v - cy) / fy, 1) in the camera frame (x right, y down, z
forward); depth is the coordinate along z, not along the ray. Integer pixel coordinates are pixel centres.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skills.geometry.capsule import Capsule
from skills.geometry.pose import IDENTITY, Pose


@dataclass(frozen=True, slots=True)
class PinholeCamera:
    """Intrinsics of a camera without distortion.

    Attributes:
        width, height: image size [px].
        fx, fy: focal lengths [px].
        cx, cy: principal point [px].
        near, far: depths outside this interval are invalid [m].
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float
    near: float = 0.1
    far: float = 9.0

    def scaled(self, factor: float) -> PinholeCamera:
        """The same view at another resolution."""
        width, height = round(self.width * factor), round(self.height * factor)
        sx, sy = width / self.width, height / self.height
        cx, cy = (self.cx + 0.5) * sx - 0.5, (self.cy + 0.5) * sy - 0.5
        return PinholeCamera(width, height, self.fx * sx, self.fy * sy, cx, cy, self.near, self.far)


@dataclass(frozen=True, slots=True, eq=False)
class DepthImage:
    """One frame of a depth camera.

    Attributes:
        depth: depth along the optical axis, (height, width) float32 [m]; 0 where there is none.
        camera: intrinsics.
        T_world_camera: estimated camera pose when the frame was taken.
        time: robot time of the frame [s].
        frame_id: counts frames from 0.
        body_world: parts of the robot that the camera may see, where they were believed to be.
        T_world_odometry: what has been done to these poses since the robot estimated them.
    """

    depth: NDArray[np.float32]
    camera: PinholeCamera
    T_world_camera: Pose
    time: float
    frame_id: int
    body_world: tuple[Capsule, ...] = ()
    T_world_odometry: Pose = IDENTITY

    def __post_init__(self) -> None:
        expected = (self.camera.height, self.camera.width)
        if self.depth.shape != expected or self.depth.dtype != np.float32:
            raise ValueError(f"got depth {self.depth.shape} {self.depth.dtype}, needs {expected} float32")
        self.depth.flags.writeable = False

    def moved(self, T: Pose) -> DepthImage:
        """The same image seen from another frame."""
        return replace(
            self,
            T_world_camera=T @ self.T_world_camera,
            body_world=tuple(capsule.moved(T) for capsule in self.body_world),
            T_world_odometry=T @ self.T_world_odometry,
        )
