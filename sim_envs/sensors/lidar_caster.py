"""Ranges of a spinning lidar by casting its rays at boxes, planes, ellipsoids, capsules and cylinders.

Each shape is met in closed form in its own frame, and only by the rings and columns that can meet the sphere around
it. All rays at one shape are one loop without a branch, so that the compiler can make vectors of it.
Shapes are seen from outside only: a lidar inside one sees through it.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from sim_envs.sensors.ray_shapes import BOX, CAPSULE, CYLINDER, ELLIPSOID, PLANE, RayShapes
from skills.geometry.lidar import SpinningLidar
from skills.geometry.pose import Array, Pose
from skills.kernels import kernel

# Added to numbers that divide: nothing beside any that matters, and no ray is ever exactly parallel to a face.
_TINY = 1e-30


def cast_ranges(
    shapes: RayShapes, geom_positions: Array, geom_rotations: Array, lidar: SpinningLidar, T_world_lidar: Pose
) -> NDArray[np.float32]:
    """Distance along each ray, (rings, columns) float32 [m]; 0 where nothing is within [near, far].

    Args:
        shapes: what the rays may hit.
        geom_positions: origins of all geoms of the model in the world, (ngeom, 3) [m].
        geom_rotations: R_world_geom of all geoms, (ngeom, 3, 3).
        lidar: where the rays point.
        T_world_lidar: lidar frame, x forward, y left, z up.
    """
    ranges = np.full((lidar.rings, lidar.columns), np.inf, dtype=np.float32)
    R_lidar_geom = T_world_lidar.R.T @ geom_rotations[shapes.geom_ids]
    p_lidar = (geom_positions[shapes.geom_ids] - T_world_lidar.p) @ T_world_lidar.R
    windows = _windows(p_lidar, shapes.radii, lidar)
    azimuths, elevations = lidar.azimuths, lidar.elevations
    _cast(
        shapes.kinds,
        shapes.sizes,
        windows,
        R_lidar_geom,
        -np.einsum("gji,gj->gi", R_lidar_geom, p_lidar),
        np.stack((np.cos(azimuths), np.sin(azimuths))),
        np.stack((np.cos(elevations), np.sin(elevations))),
        lidar.near,
        lidar.far,
        ranges,
    )
    return ranges


def _windows(centers_lidar: Array, radii: Array, lidar: SpinningLidar) -> NDArray[np.int64]:
    """Which rays can meet spheres: (first ring, ring after the last, first column, number of columns), (G, 4).

    The columns may run over the last one and on from 0. A sphere that is out of view has no rings.
    """
    distances = np.linalg.norm(centers_lidar, axis=1)
    inside = distances <= radii
    distances = np.where(inside, 1.0, distances)
    spread = np.where(inside, np.pi, np.arcsin(np.where(inside, 1.0, radii / distances)))
    elevation = np.arcsin(np.clip(centers_lidar[:, 2] / distances, -1.0, 1.0))
    spacing = (lidar.elevation_max - lidar.elevation_min) / (lidar.rings - 1)
    first_ring = np.ceil((lidar.elevation_max - elevation - spread) / spacing)
    end_ring = np.floor((lidar.elevation_max - elevation + spread) / spacing) + 1

    over_pole = np.abs(elevation) + spread >= 0.5 * np.pi
    sine = np.sin(spread) / np.where(over_pole, 1.0, np.cos(elevation))
    half_width = np.where(over_pole, np.pi, np.arcsin(np.clip(sine, 0.0, 1.0)))
    turn = 2.0 * np.pi / lidar.columns
    middle = np.pi - np.arctan2(centers_lidar[:, 1], centers_lidar[:, 0])
    first_column = np.ceil((middle - half_width) / turn - 0.5)
    count = np.minimum(np.floor((middle + half_width) / turn - 0.5) - first_column + 1, lidar.columns)
    rings = np.clip(np.stack((first_ring, end_ring)), 0, lidar.rings)
    return np.column_stack((*rings, first_column % lidar.columns, count)).astype(np.int64)


def in_field(centers_lidar: Array, radii: Array, lidar: SpinningLidar) -> NDArray[np.bool_]:
    """Which spheres a lidar may see, by centres in its frame (N, 3) and radii (N,) [m]: those that a ring can meet."""
    windows = _windows(centers_lidar, radii, lidar)
    return (windows[:, 0] < windows[:, 1]) & (windows[:, 3] > 0)


@kernel
def _cast(
    kinds: NDArray[Any],
    sizes: NDArray[Any],
    windows: NDArray[Any],
    R_lidar_geom: NDArray[Any],
    o_geom: NDArray[Any],
    around: NDArray[Any],
    upward: NDArray[Any],
    near: float,
    far: float,
    ranges: NDArray[Any],
) -> None:
    """Shorten infinite ranges to the nearest hit of each ray; o_geom is the lidar in the frame of each geom."""
    most = 0
    for g in range(kinds.shape[0]):
        most = max(most, (windows[g, 1] - windows[g, 0]) * windows[g, 3])
    level = np.empty((3, around.shape[1]))
    d, t = np.empty((3, most)), np.empty(most)
    for g in range(kinds.shape[0]):
        n = _aim(windows[g], R_lidar_geom[g], around, upward, level, d)
        if n == 0:
            continue
        if kinds[g] == BOX:
            _meet_box(o_geom[g], sizes[g], d, n, t)
        elif kinds[g] == CAPSULE:
            _meet_capsule(o_geom[g], sizes[g], d, n, t)
        elif kinds[g] == CYLINDER:
            _meet_cylinder(o_geom[g], sizes[g], d, n, t)
        elif kinds[g] == ELLIPSOID:
            _meet_ellipsoid(o_geom[g], sizes[g], d, n, t)
        elif kinds[g] == PLANE:
            _meet_plane(o_geom[g], sizes[g], d, n, t)
        _keep_nearest(windows[g], t, ranges)
    for r in range(ranges.shape[0]):
        for c in range(ranges.shape[1]):
            if not near <= ranges[r, c] <= far:
                ranges[r, c] = 0.0


@kernel
def _aim(
    window: NDArray[Any],
    R_lidar_geom: NDArray[Any],
    around: NDArray[Any],
    upward: NDArray[Any],
    level: NDArray[Any],
    d: NDArray[Any],
) -> int:
    """Write the directions of a window's rays in the frame of a geom, ring by ring, and return their number."""
    first_ring, end_ring, first, count = window
    columns = around.shape[1]
    for i in range(count):
        c = first + i if first + i < columns else first + i - columns
        for k in range(3):
            level[k, i] = R_lidar_geom[0, k] * around[0, c] + R_lidar_geom[1, k] * around[1, c]
    rings = end_ring - first_ring
    for r in range(rings):
        along, up = upward[0, first_ring + r], upward[1, first_ring + r]
        for k in range(3):
            rise = up * R_lidar_geom[2, k] + _TINY
            for i in range(count):
                d[k, r * count + i] = along * level[k, i] + rise
    return rings * count


@kernel
def _keep_nearest(window: NDArray[Any], t: NDArray[Any], ranges: NDArray[Any]) -> None:
    first_ring, end_ring, first, count = window
    columns = ranges.shape[1]
    for r in range(end_ring - first_ring):
        for i in range(count):
            c = first + i if first + i < columns else first + i - columns
            hit = t[r * count + i]
            if hit < ranges[first_ring + r, c]:
                ranges[first_ring + r, c] = hit


@kernel
def _meet_box(o: NDArray[Any], size: NDArray[Any], d: NDArray[Any], n: int, t: NDArray[Any]) -> None:
    """Enter the last of three slabs before leaving the first of them."""
    ox, oy, oz = o[0], o[1], o[2]
    sx, sy, sz = size[0], size[1], size[2]
    for i in range(n):
        ix, iy, iz = 1.0 / d[0, i], 1.0 / d[1, i], 1.0 / d[2, i]
        mx, my, mz = -ox * ix, -oy * iy, -oz * iz
        hx, hy, hz = sx * abs(ix), sy * abs(iy), sz * abs(iz)
        enter, leave = mx - hx, mx + hx
        enter = my - hy if my - hy > enter else enter
        leave = my + hy if my + hy < leave else leave
        enter = mz - hz if mz - hz > enter else enter
        leave = mz + hz if mz + hz < leave else leave
        t[i] = enter if (enter <= leave) & (enter > 0.0) else np.inf


@kernel
def _meet_plane(o: NDArray[Any], size: NDArray[Any], d: NDArray[Any], n: int, t: NDArray[Any]) -> None:
    """Meet the rectangle z = 0 from above."""
    ox, oy, oz = o[0], o[1], o[2]
    sx, sy = size[0], size[1]
    for i in range(n):
        s = -oz / d[2, i]
        inside = (abs(ox + s * d[0, i]) <= sx) & (abs(oy + s * d[1, i]) <= sy)
        t[i] = s if inside & (oz > 0.0) & (s > 0.0) else np.inf


@kernel
def _meet_ellipsoid(o: NDArray[Any], size: NDArray[Any], d: NDArray[Any], n: int, t: NDArray[Any]) -> None:
    """Meet the unit sphere in a frame scaled by the semi-axes."""
    px, py, pz = 1.0 / size[0], 1.0 / size[1], 1.0 / size[2]
    ox, oy, oz = px * o[0], py * o[1], pz * o[2]
    outside = ox * ox + oy * oy + oz * oz - 1.0
    for i in range(n):
        dx, dy, dz = px * d[0, i], py * d[1, i], pz * d[2, i]
        square, toward = dx * dx + dy * dy + dz * dz, ox * dx + oy * dy + oz * dz
        rest = toward * toward - square * outside
        s = (-toward - np.sqrt(rest if rest > 0.0 else 0.0)) / square
        t[i] = s if (rest >= 0.0) & (s > 0.0) else np.inf


@kernel
def _meet_capsule(o: NDArray[Any], size: NDArray[Any], d: NDArray[Any], n: int, t: NDArray[Any]) -> None:
    """Meet the endless cylinder about z; a ray that enters it beyond an end can only enter through that end's ball."""
    ox, oy, oz = o[0], o[1], o[2]
    radius, half = size[0], size[1]
    beside = ox * ox + oy * oy - radius * radius
    for i in range(n):
        dx, dy, dz = d[0, i], d[1, i], d[2, i]
        square, toward = dx * dx + dy * dy + _TINY, ox * dx + oy * dy
        rest = toward * toward - square * beside
        t_side = (-toward - np.sqrt(rest if rest > 0.0 else 0.0)) / square
        z = oz + t_side * dz
        ball = oz - half if z > 0.0 else oz + half
        toward_ball = toward + ball * dz
        length = square + dz * dz
        rest_ball = toward_ball * toward_ball - length * (beside + ball * ball)
        t_ball = (-toward_ball - np.sqrt(rest_ball if rest_ball > 0.0 else 0.0)) / length
        on_side = abs(z) <= half
        s = t_side if on_side else t_ball
        t[i] = s if (rest >= 0.0) & (on_side | (rest_ball >= 0.0)) & (s > 0.0) else np.inf


@kernel
def _meet_cylinder(o: NDArray[Any], size: NDArray[Any], d: NDArray[Any], n: int, t: NDArray[Any]) -> None:
    """Meet the endless cylinder about z; a ray that enters it beyond an end can only enter through that end's disc."""
    ox, oy, oz = o[0], o[1], o[2]
    radius, half = size[0], size[1]
    beside = ox * ox + oy * oy - radius * radius
    for i in range(n):
        dx, dy, dz = d[0, i], d[1, i], d[2, i]
        square, toward = dx * dx + dy * dy + _TINY, ox * dx + oy * dy
        rest = toward * toward - square * beside
        t_side = (-toward - np.sqrt(rest if rest > 0.0 else 0.0)) / square
        z = oz + t_side * dz
        t_end = ((half if z > 0.0 else -half) - oz) / dz
        x, y = ox + t_end * dx, oy + t_end * dy
        on_side = abs(z) <= half
        s = t_side if on_side else t_end
        t[i] = s if (rest >= 0.0) & (on_side | (x * x + y * y <= radius * radius)) & (s > 0.0) else np.inf
