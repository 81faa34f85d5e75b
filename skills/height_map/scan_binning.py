"""From the ranges of a lidar scan to the cells of a map: which returns count, and in which cell each lies.

Beams that share a column share their horizontal direction, so a return takes one multiplication a coordinate and no
trigonometry. Returns from the robot's own body are dropped by the capsules that the scan brings along.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.geometry.lidar import LidarScan
from skills.geometry.pose import Array
from skills.height_map.cell_ring import Window
from skills.kernels import kernel

RETURNS, OUTSIDE, ABOVE, OWN_BODY = range(4)


def beam_directions(scan: LidarScan) -> Array:
    """Directions as one matrix, (rings + columns, 3).

    The beam of ring r and column c points along `up[r] + cos(elevation[r]) across[c]`; up are the first rows and
    across the others, both in the world, and the cosine is that of the lidar.
    """
    R = scan.T_world_lidar.R
    azimuths, elevations = scan.lidar.azimuths, scan.lidar.elevations
    up = np.sin(elevations)[:, None] * R[:, 2]
    across = np.cos(azimuths)[:, None] * R[:, 0] + np.sin(azimuths)[:, None] * R[:, 1]
    return np.concatenate((up, across))


def capsule_table(scan: LidarScan, margin: float) -> Array:
    """Capsules of the body, (N, 8): start, axis, 1 / length^2, radius^2, both radius and start with the margin.

    A first row, that of no capsule, has in its first column how far from the lidar the body reaches.
    """
    table = np.zeros((len(scan.body_world) + 1, 8))
    for row, capsule in zip(table[1:], scan.body_world, strict=True):
        axis = capsule.end_world - capsule.start_world
        row[:3], row[3:6] = capsule.start_world, axis
        row[6] = 1.0 / max(float(axis @ axis), 1e-12)
        radius = capsule.radius + margin
        row[7] = radius * radius
        ends = np.stack((capsule.start_world, capsule.end_world)) - scan.T_world_lidar.p
        table[0, 0] = max(table[0, 0], radius + np.sqrt((ends * ends).sum(axis=1)).max())
    return table


@kernel
def bin_returns(
    ranges: NDArray[np.float32],
    near: float,
    far: float,
    cosines: Array,
    directions: Array,
    origin: Array,
    window: Window,
    ceiling: float,
    capsules: Array,
    cells: NDArray[np.int32],
    heights: NDArray[np.float32],
    tops: NDArray[np.float32],
    counts: NDArray[np.int64],
) -> int:
    """Put returns into cells.

    Args:
        ranges: of the scan, (rings, columns) [m].
        near: least valid range [m].
        far: greatest valid range [m].
        cosines: of the elevation of each ring.
        directions: see `beam_directions`.
        origin: of the lidar in the world [m].
        window: the map's part of the world.
        ceiling: highest return that counts [m].
        capsules: see `capsule_table`.
        cells: filled with the cell of each return that counts, flat, as stored in the ring.
        heights: filled with its height [m].
        tops: filled with the highest return of each cell, -inf where there is none.
        counts: filled by reason.

    Returns:
        How many returns count.
    """
    rings, columns = ranges.shape
    n = window.cells
    per_metre = 1.0 / window.resolution
    first_row, first_column = window.row % n, window.column % n
    start_x, start_y = origin[0] * per_metre - window.column, origin[1] * per_metre - window.row
    reach = capsules[0, 0]
    for cell in range(n * n):
        tops[cell] = -np.inf
    in_column, in_row, height = np.empty(columns), np.empty(columns), np.empty(columns)
    across_x, across_y, across_z = np.empty(columns), np.empty(columns), np.empty(columns)
    for azimuth in range(columns):
        across_x[azimuth] = directions[rings + azimuth, 0] * per_metre
        across_y[azimuth] = directions[rings + azimuth, 1] * per_metre
        across_z[azimuth] = directions[rings + azimuth, 2]
    found = returns = outside = above = own_body = 0
    for ring in range(rings):
        cosine = cosines[ring]
        up_x, up_y, up_z = directions[ring, 0] * per_metre, directions[ring, 1] * per_metre, directions[ring, 2]
        # Without branches, so that the compiler takes several beams at once.
        for azimuth in range(columns):
            distance = ranges[ring, azimuth]
            in_column[azimuth] = start_x + distance * (up_x + cosine * across_x[azimuth])
            in_row[azimuth] = start_y + distance * (up_y + cosine * across_y[azimuth])
            height[azimuth] = origin[2] + distance * (up_z + cosine * across_z[azimuth])
        for azimuth in range(columns):
            distance = ranges[ring, azimuth]
            if not (near <= distance <= far):
                continue
            returns += 1
            if not (0.0 <= in_column[azimuth] < n and 0.0 <= in_row[azimuth] < n):
                outside += 1
                continue
            z = np.float32(height[azimuth])
            if z > ceiling:
                above += 1
                continue
            if distance < reach:
                x = (in_column[azimuth] + window.column) * window.resolution
                y = (in_row[azimuth] + window.row) * window.resolution
                if _in_capsules(capsules, x, y, height[azimuth]):
                    own_body += 1
                    continue
            row, column = int(in_row[azimuth]) + first_row, int(in_column[azimuth]) + first_column
            cell = (row if row < n else row - n) * n + (column if column < n else column - n)
            cells[found] = cell
            heights[found] = z
            if z > tops[cell]:
                tops[cell] = z
            found += 1
    counts[RETURNS], counts[OUTSIDE], counts[ABOVE], counts[OWN_BODY] = returns, outside, above, own_body
    return found


@kernel
def _in_capsules(capsules: Array, x: float, y: float, z: float) -> bool:
    for i in range(1, len(capsules)):
        dx, dy, dz = x - capsules[i, 0], y - capsules[i, 1], z - capsules[i, 2]
        ax, ay, az = capsules[i, 3], capsules[i, 4], capsules[i, 5]
        t = min(max((dx * ax + dy * ay + dz * az) * capsules[i, 6], 0.0), 1.0)
        dx, dy, dz = dx - t * ax, dy - t * ay, dz - t * az
        if dx * dx + dy * dy + dz * dz <= capsules[i, 7]:
            return True
    return False
