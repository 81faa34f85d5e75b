"""Ranges of a spinning lidar by casting its rays at boxes, planes, ellipsoids, capsules and cylinders.

Each shape is met in closed form in its own frame, and only by the rings and columns that can meet the sphere around
it. A row of rays is one loop over neighbouring columns without a branch, so that the compiler makes vectors of it.
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
        ranges,
    )
    ranges[(ranges < lidar.near) | (ranges > lidar.far)] = 0.0
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
    ranges: NDArray[Any],
) -> None:
    """Shorten the ranges to the nearest hit of each ray; o_geom is the lidar in the frame of each geom."""
    columns = around.shape[1]
    level = np.empty((3, columns))
    d = np.empty((3, columns))
    for g in range(kinds.shape[0]):
        first, count = windows[g, 2], windows[g, 3]
        for start, stop in ((first, min(first + count, columns)), (0, max(first + count - columns, 0))):
            for k in range(3):
                x, y = R_lidar_geom[g, 0, k], R_lidar_geom[g, 1, k]
                for c in range(start, stop):
                    level[k, c] = x * around[0, c] + y * around[1, c]
            for r in range(windows[g, 0], windows[g, 1]):
                for k in range(3):
                    along, up = upward[0, r], upward[1, r] * R_lidar_geom[g, 2, k] + _TINY
                    for c in range(start, stop):
                        d[k, c] = along * level[k, c] + up
                if kinds[g] == BOX:
                    _meet_box(o_geom[g], sizes[g], d, start, stop, ranges[r])
                elif kinds[g] == CAPSULE:
                    _meet_capsule(o_geom[g], sizes[g], d, start, stop, ranges[r])
                elif kinds[g] == CYLINDER:
                    _meet_cylinder(o_geom[g], sizes[g], d, start, stop, ranges[r])
                elif kinds[g] == ELLIPSOID:
                    _meet_ellipsoid(o_geom[g], sizes[g], d, start, stop, ranges[r])
                elif kinds[g] == PLANE:
                    _meet_plane(o_geom[g], sizes[g], d, start, stop, ranges[r])


@kernel
def _meet_box(o: NDArray[Any], size: NDArray[Any], d: NDArray[Any], start: int, stop: int, row: NDArray[Any]) -> None:
    """Enter the last of three slabs before leaving the first of them."""
    ox, oy, oz = o[0], o[1], o[2]
    sx, sy, sz = size[0], size[1], size[2]
    for c in range(start, stop):
        ix, iy, iz = 1.0 / d[0, c], 1.0 / d[1, c], 1.0 / d[2, c]
        mx, my, mz = -ox * ix, -oy * iy, -oz * iz
        hx, hy, hz = sx * abs(ix), sy * abs(iy), sz * abs(iz)
        enter, leave = mx - hx, mx + hx
        enter = my - hy if my - hy > enter else enter
        leave = my + hy if my + hy < leave else leave
        enter = mz - hz if mz - hz > enter else enter
        leave = mz + hz if mz + hz < leave else leave
        hit = (enter <= leave) & (enter > 0.0) & (enter < row[c])
        row[c] = enter if hit else row[c]


@kernel
def _meet_plane(o: NDArray[Any], size: NDArray[Any], d: NDArray[Any], start: int, stop: int, row: NDArray[Any]) -> None:
    """Meet the rectangle z = 0 from above."""
    ox, oy, oz = o[0], o[1], o[2]
    sx, sy = size[0], size[1]
    for c in range(start, stop):
        t = -oz / d[2, c]
        inside = (abs(ox + t * d[0, c]) <= sx) & (abs(oy + t * d[1, c]) <= sy)
        hit = inside & (oz > 0.0) & (t > 0.0) & (t < row[c])
        row[c] = t if hit else row[c]


@kernel
def _meet_ellipsoid(
    o: NDArray[Any], size: NDArray[Any], d: NDArray[Any], start: int, stop: int, row: NDArray[Any]
) -> None:
    """Meet the unit sphere in a frame scaled by the semi-axes."""
    px, py, pz = 1.0 / size[0], 1.0 / size[1], 1.0 / size[2]
    ox, oy, oz = px * o[0], py * o[1], pz * o[2]
    outside = ox * ox + oy * oy + oz * oz - 1.0
    for c in range(start, stop):
        dx, dy, dz = px * d[0, c], py * d[1, c], pz * d[2, c]
        square, toward = dx * dx + dy * dy + dz * dz, ox * dx + oy * dy + oz * dz
        rest = toward * toward - square * outside
        t = (-toward - np.sqrt(rest if rest > 0.0 else 0.0)) / square
        hit = (rest >= 0.0) & (t > 0.0) & (t < row[c])
        row[c] = t if hit else row[c]


@kernel
def _meet_capsule(
    o: NDArray[Any], size: NDArray[Any], d: NDArray[Any], start: int, stop: int, row: NDArray[Any]
) -> None:
    """Meet the endless cylinder about z; a ray that enters it beyond an end can only enter through that end's ball."""
    ox, oy, oz = o[0], o[1], o[2]
    radius, half = size[0], size[1]
    beside = ox * ox + oy * oy - radius * radius
    for c in range(start, stop):
        dx, dy, dz = d[0, c], d[1, c], d[2, c]
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
        t = t_side if on_side else t_ball
        hit = (rest >= 0.0) & (on_side | (rest_ball >= 0.0)) & (t > 0.0) & (t < row[c])
        row[c] = t if hit else row[c]


@kernel
def _meet_cylinder(
    o: NDArray[Any], size: NDArray[Any], d: NDArray[Any], start: int, stop: int, row: NDArray[Any]
) -> None:
    """Meet the endless cylinder about z; a ray that enters it beyond an end can only enter through that end's disc."""
    ox, oy, oz = o[0], o[1], o[2]
    radius, half = size[0], size[1]
    beside = ox * ox + oy * oy - radius * radius
    for c in range(start, stop):
        dx, dy, dz = d[0, c], d[1, c], d[2, c]
        square, toward = dx * dx + dy * dy + _TINY, ox * dx + oy * dy
        rest = toward * toward - square * beside
        t_side = (-toward - np.sqrt(rest if rest > 0.0 else 0.0)) / square
        z = oz + t_side * dz
        t_end = ((half if z > 0.0 else -half) - oz) / dz
        x, y = ox + t_end * dx, oy + t_end * dy
        on_side = abs(z) <= half
        t = t_side if on_side else t_end
        hit = (rest >= 0.0) & (on_side | (x * x + y * y <= radius * radius)) & (t > 0.0) & (t < row[c])
        row[c] = t if hit else row[c]
