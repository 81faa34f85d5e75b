"""Where the beams of a lidar scan ended, thinned for drawing."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.geometry import LidarScan

_STRIDE = 4  # every nth ring and column of a scan is drawn


def scan_points(scan: LidarScan) -> NDArray[np.float32]:
    """Ends of the beams of every nth ring and column, (N, 3) in the world [m]."""
    step = slice(None, None, _STRIDE)
    elevation, azimuth = np.meshgrid(scan.lidar.elevations[step], scan.lidar.azimuths[step], indexing="ij")
    along = np.stack((np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)), -1)
    ranges = scan.ranges[step, step].astype(np.float64)
    back = ranges > 0.0
    return (scan.T_world_lidar @ (along[back] * ranges[back][:, None])).astype(np.float32)
