"""Spinning lidars and the scans they take.

Ring r of column c looks along (cos(e) cos(a), cos(e) sin(a), sin(e)) in the lidar frame (x forward, y left, z up), with
elevation e falling from the first ring to the last and azimuth a falling from pi in the first column, as a lidar that
turns clockwise sees it. Range is the distance along that ray.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skills.geometry.capsule import Capsule
from skills.geometry.pose import Array, Pose


@dataclass(frozen=True, slots=True)
class SpinningLidar:
    """Where the rays of a lidar point.

    Attributes:
        rings: rays above one another.
        columns: rays around, evenly spaced over the whole circle.
        elevation_max, elevation_min: of the first and of the last ring [rad].
        near, far: ranges outside this interval are invalid [m].
    """

    rings: int
    columns: int
    elevation_max: float
    elevation_min: float
    near: float = 0.3
    far: float = 50.0

    @property
    def elevations(self) -> Array:
        """Of each ring, (rings,) [rad]."""
        return np.linspace(self.elevation_max, self.elevation_min, self.rings)

    @property
    def azimuths(self) -> Array:
        """Of each column, (columns,) [rad]."""
        return np.pi - 2.0 * np.pi * (np.arange(self.columns) + 0.5) / self.columns


@dataclass(frozen=True, slots=True, eq=False)
class LidarScan:
    """One turn of a lidar, taken as if all at once.

    Attributes:
        ranges: distance along each ray, (rings, columns) float32 [m]; 0 where nothing came back.
        lidar: where the rays point.
        T_world_lidar: estimated lidar pose when the scan was taken.
        time: robot time of the scan [s].
        scan_id: counts scans from 0.
        body_world: parts of the robot that the lidar may see, where they were believed to be.
    """

    ranges: NDArray[np.float32]
    lidar: SpinningLidar
    T_world_lidar: Pose
    time: float
    scan_id: int
    body_world: tuple[Capsule, ...] = ()

    def __post_init__(self) -> None:
        expected = (self.lidar.rings, self.lidar.columns)
        if self.ranges.shape != expected or self.ranges.dtype != np.float32:
            raise ValueError(f"got ranges {self.ranges.shape} {self.ranges.dtype}, needs {expected} float32")
        self.ranges.flags.writeable = False

    def moved(self, T: Pose) -> LidarScan:
        """The same scan seen from another frame."""
        body = tuple(capsule.moved(T) for capsule in self.body_world)
        return replace(self, T_world_lidar=T @ self.T_world_lidar, body_world=body)
