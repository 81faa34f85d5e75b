"""The geoms of a MuJoCo model as a lidar meets them: kinds and sizes, made once; only their poses change with time."""

# mujoco keeps its types in binary modules without stubs.
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from sim_envs.sensors.geom_mesh import visible_geoms
from skills.geometry.pose import Array

PLANE, BOX, ELLIPSOID, CAPSULE, CYLINDER = range(5)
_KINDS = {
    mujoco.mjtGeom.mjGEOM_PLANE: PLANE,
    mujoco.mjtGeom.mjGEOM_BOX: BOX,
    mujoco.mjtGeom.mjGEOM_SPHERE: ELLIPSOID,
    mujoco.mjtGeom.mjGEOM_ELLIPSOID: ELLIPSOID,
    mujoco.mjtGeom.mjGEOM_CAPSULE: CAPSULE,
    mujoco.mjtGeom.mjGEOM_CYLINDER: CYLINDER,
}


@dataclass(frozen=True, slots=True, eq=False)
class RayShapes:
    """G shapes that rays can be cast at, each in the frame of its geom.

    Attributes:
        geom_ids: index in the model of each geom, (G,).
        kinds: PLANE, BOX, ELLIPSOID, CAPSULE or CYLINDER, (G,).
        sizes: half sizes of a box or a plane, semi-axes of an ellipsoid, (radius, half length, 0) of a capsule or a
            cylinder along z, (G, 3) [m].
        radii: of spheres around the geoms, (G,) [m].
    """

    geom_ids: NDArray[np.int64]
    kinds: NDArray[np.int64]
    sizes: Array
    radii: Array


def ray_shapes(model: mujoco.MjModel) -> RayShapes:
    """Gather the shapes of all visible geoms of a model.

    Raises:
        ValueError: where a visible geom has a shape that rays are not cast at (mesh, height field, distance field).
    """
    geom_ids = visible_geoms(model)
    kinds = [_kind(model, geom) for geom in geom_ids]
    sizes = [_size(model, geom) for geom in geom_ids]
    return RayShapes(
        geom_ids=np.array(geom_ids, dtype=np.int64),
        kinds=np.array(kinds, dtype=np.int64),
        sizes=np.array(sizes, dtype=np.float64).reshape(-1, 3),
        radii=np.array([_radius(kind, size) for kind, size in zip(kinds, sizes, strict=True)], dtype=np.float64),
    )


def _kind(model: mujoco.MjModel, geom: int) -> int:
    kind = mujoco.mjtGeom(int(model.geom_type[geom]))
    if kind not in _KINDS:
        raise ValueError(
            f'geom "{model.geom(geom).name}" ({geom}): got {kind.name}, which cannot be seen by a lidar '
            f"(allowed: {', '.join(known.name for known in _KINDS)})"
        )
    return _KINDS[kind]


def _size(model: mujoco.MjModel, geom: int) -> Array:
    x, y, z = model.geom_size[geom]
    match mujoco.mjtGeom(int(model.geom_type[geom])):
        case mujoco.mjtGeom.mjGEOM_SPHERE:
            return np.array((x, x, x))
        case mujoco.mjtGeom.mjGEOM_PLANE:
            return np.array((x or np.inf, y or np.inf, 0.0))
        case mujoco.mjtGeom.mjGEOM_CAPSULE | mujoco.mjtGeom.mjGEOM_CYLINDER:
            return np.array((x, y, 0.0))
    return np.array((x, y, z))


def _radius(kind: int, size: Array) -> float:
    if kind == ELLIPSOID:
        return float(size.max())
    if kind == CAPSULE:
        return float(size[0] + size[1])
    return float(np.linalg.norm(size))
