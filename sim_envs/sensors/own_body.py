"""The robot's own body as its sensors are told of it: capsules that cover all of its geoms that sensors see.

The capsules are made once, in the frames of the geoms, and placed by the robot's estimate whenever a sensor measures.
They cover closely what is flat or thin, a foot above all: ground beside it shall stay in sight.
"""

# mujoco keeps its types in binary modules without stubs.
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from sim_envs.sensors.geom_mesh import visible_geoms
from sim_envs.sensors.snapshot import Snapshot
from skills.geometry.capsule import Capsule
from skills.geometry.pose import Array, readonly

InView = Callable[[Array, Array], NDArray[np.bool_]]
_CUTS = 65  # lengths tried for a capsule around a cylinder


@dataclass(frozen=True, slots=True, eq=False)
class OwnBody:
    """K capsules, each in the frame of a geom of the robot.

    Attributes:
        geom_ids: index in the model of the geom of each capsule, (K,).
        starts_geom, ends_geom: ends of their axes, (K, 3) [m].
        radii: (K,) [m].
    """

    geom_ids: NDArray[np.int64]
    starts_geom: Array
    ends_geom: Array
    radii: Array

    def capsules(self, snapshot: Snapshot, margin: float, in_view: InView) -> tuple[Capsule, ...]:
        """Where the robot believes those parts of itself to be that a sensor may see.

        Args:
            snapshot: the instant, and the error of the estimate.
            margin: added to all radii [m].
            in_view: which spheres a sensor may see, by centres in its frame (K, 3) and radii (K,) [m].
        """
        R, p = snapshot.geom_rotations[self.geom_ids], snapshot.geom_positions[self.geom_ids]
        starts = (R @ self.starts_geom[:, :, None])[:, :, 0] + p
        ends = (R @ self.ends_geom[:, :, None])[:, :, 0] + p
        radii = self.radii + margin
        around = radii + 0.5 * np.linalg.norm(ends - starts, axis=1)
        centers_sensor = (0.5 * (starts + ends) - snapshot.T_world_sensor.p) @ snapshot.T_world_sensor.R
        seen = in_view(centers_sensor, around)
        T = snapshot.T_estimate_world
        return tuple(map(Capsule, T @ starts[seen], T @ ends[seen], radii[seen].tolist()))


NO_BODY = OwnBody(np.zeros(0, dtype=np.int64), readonly(np.zeros((0, 3))), readonly(np.zeros((0, 3))), np.zeros(0))


def own_body(model: mujoco.MjModel, body: int) -> OwnBody:
    """Cover all visible geoms of the robot that a body of the model belongs to.

    Raises:
        ValueError: where one of them has a shape without bounds.
    """
    root = model.body_rootid[body]
    geoms = [geom for geom in visible_geoms(model) if model.body_rootid[model.geom_bodyid[geom]] == root]
    covers = [_cover(model, geom) for geom in geoms]
    geom_ids = np.repeat(np.array(geoms, dtype=np.int64), [len(cover) for cover in covers])
    rows = np.concatenate([np.zeros((0, 7)), *covers])
    return OwnBody(geom_ids, rows[:, :3], rows[:, 3:6], rows[:, 6])


def _cover(model: mujoco.MjModel, geom: int) -> Array:
    """Capsules that together contain a geom, as rows (start, end, radius) in its frame, (N, 7) [m]."""
    size = np.asarray(model.geom_size[geom], dtype=np.float64)
    match mujoco.mjtGeom(int(model.geom_type[geom])):
        case mujoco.mjtGeom.mjGEOM_SPHERE:
            return cover_ellipsoid(np.full(3, size[0]))
        case mujoco.mjtGeom.mjGEOM_ELLIPSOID:
            return cover_ellipsoid(size)
        case mujoco.mjtGeom.mjGEOM_CAPSULE:
            return _along(2, size[1], size[0])
        case mujoco.mjtGeom.mjGEOM_CYLINDER:
            return _along(2, *_around_cylinder(size[0], size[1]))
        case mujoco.mjtGeom.mjGEOM_BOX | mujoco.mjtGeom.mjGEOM_MESH:
            center, half_sizes = np.split(np.asarray(model.geom_aabb[geom], dtype=np.float64), 2)
            return cover_box(half_sizes) + np.concatenate((center, center, (0.0,)))
    kind = mujoco.mjtGeom(int(model.geom_type[geom])).name
    raise ValueError(f'geom "{model.geom(geom).name}" ({geom}): got {kind}, which cannot be a part of the robot')


def cover_ellipsoid(semi_axes: Array) -> Array:
    """The capsule along the longest axis a that contains an ellipsoid, as one row (1, 7).

    Its radius is the middle semi-axis b. With a half length of a - b it touches the ellipsoid's ends: a point
    (b cos s, a sin s) is at most b from the end of its axis for every half length between a - b and a + b.
    """
    axis = int(np.argmax(semi_axes))
    _, middle, longest = np.sort(semi_axes)
    return _along(axis, longest - middle, middle)


def cover_box(half_sizes: Array) -> Array:
    """Capsules along a box that together contain it, (N, 7).

    They lie side by side, as many as the smallest half size goes into the middle one: a plate gets many thin ones.
    """
    thin, wide, long = np.argsort(half_sizes, kind="stable").tolist()
    thickness, width, length = half_sizes[[thin, wide, long]].tolist()
    count = max(1, round(width / thickness)) if thickness > 0.0 else 1
    half_strip = width / count
    rows = np.repeat(_along(long, *_around_cylinder(float(np.hypot(half_strip, thickness)), length)), count, axis=0)
    rows[:, wide] = rows[:, 3 + wide] = half_strip * (2.0 * np.arange(count) - count + 1.0)
    return rows


def _around_cylinder(radius: float, half_length: float) -> tuple[float, float]:
    """Half length and radius of the smallest capsule that contains a cylinder [m]."""
    half = np.linspace(0.0, half_length, _CUTS)
    r = np.hypot(radius, half_length - half)
    best = int(np.argmin(r**2 * (2.0 * half + 4.0 / 3.0 * r)))
    return float(half[best]), float(r[best])


def _along(axis: int, half_length: float, radius: float) -> Array:
    """A capsule along an axis of its geom as one row, (1, 7)."""
    row = np.zeros((1, 7))
    row[0, axis], row[0, 3 + axis], row[0, 6] = -half_length, half_length, radius
    return row
