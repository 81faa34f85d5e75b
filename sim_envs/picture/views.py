"""From where, and how wide, a picture is taken."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from skills.geometry.camera import PinholeCamera, looking
from skills.geometry.pose import Pose

_NEAR, _FAR = 0.05, 80.0
_AHEAD, _DOWN = 0.35, 0.25  # the middle of a walk's picture, seen from the pelvis [m]


def picture_camera(width: int, height: int, *, vertical_fov_deg: float = 32.0) -> PinholeCamera:
    """A camera for pictures of width x height pixels; a narrow view keeps upright things upright."""
    focal = 0.5 * height / np.tan(0.5 * np.deg2rad(vertical_fov_deg))
    return PinholeCamera(width, height, float(focal), float(focal), 0.5 * (width - 1), 0.5 * (height - 1), _NEAR, _FAR)


def orbit_view(target_world: ArrayLike, *, distance: float, azimuth: float, elevation: float) -> Pose:
    """T_world_camera of a viewer around a target: where it stands as seen from there, and how high [m, rad]."""
    level = np.cos(elevation)
    away = np.array([level * np.cos(azimuth), level * np.sin(azimuth), np.sin(elevation)])
    return looking(np.asarray(target_world) + distance * away, pitch=elevation, yaw=azimuth + np.pi)


def beside_robot(
    T_world_pelvis: Pose, *, distance: float = 4.7, azimuth_deg: float = -50.0, elevation_deg: float = 24.0
) -> Pose:
    """T_world_camera that shows a robot and the ground before it; azimuth is counted from its heading to its left."""
    yaw = T_world_pelvis.yaw
    target = T_world_pelvis.p + np.array([_AHEAD * np.cos(yaw), _AHEAD * np.sin(yaw), -_DOWN])
    azimuth = yaw + np.deg2rad(azimuth_deg)
    return orbit_view(target, distance=distance, azimuth=float(azimuth), elevation=float(np.deg2rad(elevation_deg)))
