"""Pinhole cameras and the depth images they take.

Pixel (u, v) = (column, row) looks along ((u - cx) / fx, (v - cy) / fy, 1) in the camera frame (x right, y down, z
forward); depth is the coordinate along z, not along the ray. Integer pixel coordinates are pixel centres.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skills.geometry.capsule import Capsule
from skills.geometry.pose import IDENTITY, Array, Pose

# The pose of a camera that looks straight down from the world's origin, the top of its image along x.
LOOKING_DOWN = Pose(np.array([[0.0, -1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, -1.0]]), np.zeros(3))
_MILLIMETRES_PER_METRE = 1000.0


def looking(xyz: tuple[float, float, float] | Array, *, pitch: float, yaw: float = 0.0) -> Pose:
    """A camera frame (x right, y down, z forward) at xyz that looks along yaw, pitch below the horizon [m, rad]."""
    forward_left_up = Pose.from_xyz_rpy(xyz, (0.0, pitch, yaw))
    R_flu_camera = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
    return Pose(forward_left_up.R @ R_flu_camera, forward_left_up.p)


def values_per_metre(values: NDArray[Any]) -> float:
    """What numbers mean where nobody says it: whole ones are millimetres, floats metres."""
    return 1.0 if values.dtype.kind == "f" else _MILLIMETRES_PER_METRE


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

    def __post_init__(self) -> None:
        if self.width < 1 or self.height < 1:
            raise ValueError(f"got an image of {self.width} x {self.height} pixels, needs at least one")
        for name in ("fx", "fy", "cx", "cy"):
            value = getattr(self, name)
            if not np.isfinite(value) or (value <= 0.0 and name in ("fx", "fy")):
                needs = "a positive number" if name in ("fx", "fy") else "a number"
                raise ValueError(f"{name}: got {value}, needs {needs} of pixels")
        if not 0.0 <= self.near < self.far:
            raise ValueError(f"near, far: got {self.near} and {self.far}, needs 0 <= near < far")

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
        frame_id: counts frames from 0; no two of one robot's have the same.
        body_world: parts of the robot that the camera may see, where they were believed to be.
        T_world_odometry: what has been done to these poses since the robot estimated them.
        camera_name: which of the robot's depth cameras took it.
    """

    depth: NDArray[np.float32]
    camera: PinholeCamera
    T_world_camera: Pose
    time: float
    frame_id: int
    body_world: tuple[Capsule, ...] = ()
    T_world_odometry: Pose = IDENTITY
    camera_name: str = ""

    def __post_init__(self) -> None:
        expected = (self.camera.height, self.camera.width)
        if self.depth.shape != expected or self.depth.dtype != np.float32:
            raise ValueError(f"got depth {self.depth.shape} {self.depth.dtype}, needs {expected} float32")
        self.depth.flags.writeable = False

    @classmethod
    def from_array(
        cls,
        values: ArrayLike,
        camera: PinholeCamera,
        *,
        scale: float | None = None,
        T_world_camera: Pose = LOOKING_DOWN,
        time: float = 0.0,
        frame_id: int = 0,
    ) -> DepthImage:
        """A depth image of what cameras and files deliver; what is no positive number becomes 0.

        Args:
            values: depth along the optical axis, (height, width), whole numbers or floats.
            camera: intrinsics.
            scale: values a metre, as 1000 for millimetres; without it whole numbers are millimetres, floats metres.
            T_world_camera: camera pose; straight down at the world's origin where nobody says.
            time: robot time of the frame [s].
            frame_id: counts frames from 0.

        Raises:
            ValueError: where the shape, the type or the scale is none of a depth image.
        """
        array = np.asarray(values)
        if array.ndim != 2:
            raise ValueError(
                f"got an array of shape {array.shape}, a depth image has one value a pixel: (height, width)"
            )
        if array.shape != (camera.height, camera.width):
            raise ValueError(
                f"got {array.shape[1]} x {array.shape[0]} pixels, the camera has {camera.width} x {camera.height}"
            )
        if array.dtype.kind not in "iuf" or (array.dtype.kind in "iu" and array.dtype.itemsize < 2):
            raise ValueError(f"got values of type {array.dtype}, needs floats or whole numbers of 16 bits or more")
        if scale is None:
            scale = values_per_metre(array)
        if not np.isfinite(scale) or scale <= 0.0:
            raise ValueError(f"scale: got {scale}, needs a positive number of values a metre")
        # Half floats overflow at 65504, and values beyond single precision are no depth either.
        with np.errstate(over="ignore", invalid="ignore"):
            depth = (array / np.float64(scale)).astype(np.float32)
        depth[~((depth > 0.0) & np.isfinite(depth))] = 0.0
        return cls(depth, camera, T_world_camera, time, frame_id)

    def moved(self, T: Pose) -> DepthImage:
        """The same image seen from another frame."""
        return replace(
            self,
            T_world_camera=T @ self.T_world_camera,
            body_world=tuple(capsule.moved(T) for capsule in self.body_world),
            T_world_odometry=T @ self.T_world_odometry,
        )
