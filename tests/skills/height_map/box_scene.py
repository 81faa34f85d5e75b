"""A scene of upright boxes on level ground, and what a lidar without noise sees of it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skills.geometry import Array, Capsule, LidarScan, Pose, SpinningLidar

SMALL = SpinningLidar(64, 512, np.deg2rad(30.0), np.deg2rad(-60.0))
LARGE = SpinningLidar(128, 1024, np.deg2rad(45.0), np.deg2rad(-45.0))


@dataclass(frozen=True)
class Box:
    """From corner to corner, (3,) each [m]."""

    low: tuple[float, float, float]
    high: tuple[float, float, float]


def block(x: float, y: float, top: float, edge: float = 0.4) -> Box:
    """A square block on the ground."""
    return Box((x - edge / 2, y - edge / 2, 0.0), (x + edge / 2, y + edge / 2, top))


def directions_lidar(lidar: SpinningLidar) -> Array:
    """Of all beams, (rings, columns, 3), written out as the lidar's documentation says."""
    e, a = np.meshgrid(lidar.elevations, lidar.azimuths, indexing="ij")
    return np.stack((np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)), axis=-1)


def scan_of(
    boxes: list[Box],
    *,
    time: float = 0.0,
    lidar: SpinningLidar = SMALL,
    T_world_lidar: Pose | None = None,
    noise: float = 0.0,
    seed: int = 0,
    body: tuple[Capsule, ...] = (),
) -> LidarScan:
    """A scan from 1.7 m above the origin, unless another pose is given."""
    T = T_world_lidar or Pose.from_xyz_rpy((0.0, 0.0, 1.7))
    rays = directions_lidar(lidar) @ T.R.T
    with np.errstate(divide="ignore", invalid="ignore"):
        ranges = np.where(rays[..., 2] < 0.0, -T.p[2] / rays[..., 2], np.inf)
        for box in boxes:
            near, far = (np.array(corner) - T.p for corner in (box.low, box.high))
            first, last = near / rays, far / rays
            enter = np.minimum(first, last).max(axis=-1)
            leave = np.maximum(first, last).min(axis=-1)
            ranges = np.where((enter <= leave) & (enter > 0.0), np.minimum(ranges, enter), ranges)
    ranges = ranges + np.random.default_rng(seed).normal(0.0, noise, ranges.shape) if noise else ranges
    valid = (ranges >= lidar.near) & (ranges <= lidar.far)
    return LidarScan(np.where(valid, ranges, 0.0).astype(np.float32), lidar, T, time, round(time * 10), body)
