"""What a picture shows in each pixel: the point that is seen, its normal, and its colour.

Faces are flat, yet round geoms are shaded round and boxes as if their edges were worn: normals come from the shape
itself, not from its faces.
"""

# mujoco keeps its types in binary modules without stubs.
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from sim_envs.sensors import GeomMesh, Raster, geom_rgba
from skills.geometry.camera import PinholeCamera
from skills.geometry.pose import Array, Pose

Image = NDArray[np.float32]

FLOOR = -1  # stands for the floor among the geoms
_WORN = 0.006  # radius at which edges look worn [m]
_TINT = 0.05  # neighbouring geoms of one colour differ in brightness by up to this
_GOLDEN_RATIO = 0.5 * (1 + np.sqrt(5))


@dataclass(frozen=True, slots=True, eq=False)
class Surfaces:
    """The N pixels of an image in which something is seen.

    Attributes:
        pixels: index into the flattened image, (N,), rising.
        geoms: index of the geom in the model, (N,); FLOOR for the floor.
        points_world, normals_world: (N, 3) float32 [m].
        colors: linear red, green, blue, (N, 3) float32; may be painted over.
    """

    pixels: NDArray[np.int64]
    geoms: NDArray[np.int64]
    points_world: Image
    normals_world: Image
    colors: Image


def surfaces_of(
    model: mujoco.MjModel,
    mesh: GeomMesh,
    raster: Raster,
    geom_positions: Array,
    geom_rotations: Array,
    camera: PinholeCamera,
    T_world_camera: Pose,
) -> Surfaces:
    """Collect point, normal and colour of each pixel of a raster of the mesh."""
    pixels = np.flatnonzero(raster.depth)
    faces = raster.face.reshape(-1)[pixels]
    geoms = mesh.face_geom_ids[faces]
    points = _points(raster.depth, pixels, camera, T_world_camera)
    normals = _face_normals(mesh, geom_rotations)[faces]
    order = np.argsort(geoms, kind="stable")
    visible, starts = np.unique(geoms[order], return_index=True)
    colors = np.empty_like(points)
    for geom, rows in zip(visible, np.split(order, starts)[1:], strict=True):
        colors[rows] = _color(model, geom)
        if mujoco.mjtGeom(int(model.geom_type[geom])) in _NORMALS:
            R = geom_rotations[geom].astype(np.float32)
            local = ((points[rows] - geom_positions[geom].astype(np.float32)) @ R).astype(np.float32)
            normals[rows] = _shape_normals(model, geom, local) @ R.T
    return Surfaces(pixels, geoms, points, normals, colors)


def floor_under(depth: Image, height: float, camera: PinholeCamera, T_world_camera: Pose) -> Surfaces:
    """The white level floor at a height where nothing else is seen; depth 0 is nothing [m]."""
    v, u = np.divmod(np.flatnonzero(depth == 0), camera.width)
    rays = np.column_stack(((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, np.ones(len(u))))
    falling = rays @ T_world_camera.R[2]
    z = (height - T_world_camera.p[2]) / np.where(falling == 0, np.inf, falling)
    hit = (z > camera.near) & (z < camera.far)
    points = ((rays[hit] * z[hit, None]) @ T_world_camera.R.T + T_world_camera.p).astype(np.float32)
    pixels = (v * camera.width + u)[hit]
    normals = np.broadcast_to(np.array((0, 0, 1), dtype=np.float32), points.shape)
    colors = np.ones_like(points)
    return Surfaces(pixels, np.full(len(pixels), FLOOR), points, normals, colors)


def together(one: Surfaces, other: Surfaces) -> Surfaces:
    """Surfaces of different pixels of one image."""
    pixels = np.concatenate((one.pixels, other.pixels))
    order = np.argsort(pixels, kind="stable")
    return Surfaces(
        pixels[order],
        np.concatenate((one.geoms, other.geoms))[order],
        np.concatenate((one.points_world, other.points_world))[order],
        np.concatenate((one.normals_world, other.normals_world))[order],
        np.concatenate((one.colors, other.colors))[order],
    )


def _points(depth: Image, pixels: NDArray[np.int64], camera: PinholeCamera, T_world_camera: Pose) -> Image:
    v, u = np.divmod(pixels, camera.width)
    z = depth.reshape(-1)[pixels]
    x = ((u - camera.cx) / camera.fx).astype(np.float32) * z
    y = ((v - camera.cy) / camera.fy).astype(np.float32) * z
    R, p = T_world_camera.R.astype(np.float32), T_world_camera.p.astype(np.float32)
    return np.column_stack((x, y, z)) @ R.T + p


def _face_normals(mesh: GeomMesh, geom_rotations: Array) -> Image:
    corners = mesh.vertices_geom[mesh.faces]
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    return np.einsum("fij,fj->fi", geom_rotations[mesh.face_geom_ids], normals).astype(np.float32)


def _shape_normals(model: mujoco.MjModel, geom: int, local: Image) -> Image:
    size = model.geom_size[geom].astype(np.float32)
    normals = _NORMALS[mujoco.mjtGeom(int(model.geom_type[geom]))](local, size)
    return normals / np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), np.float32(1e-12))


def _worn_box(local: Image, size: Image) -> Image:
    worn = min(_WORN, 0.25 * float(size.min()))
    return np.sign(local) * np.maximum(np.abs(local) - (size - worn), 0)


def _worn_cylinder(local: Image, size: Image) -> Image:
    worn = min(_WORN, 0.25 * float(size[:2].min()))
    radius = np.maximum(np.linalg.norm(local[:, :2], axis=1, keepdims=True), np.float32(1e-12))
    outward = local[:, :2] / radius * np.maximum(radius - (size[0] - worn), 0)
    upward = np.sign(local[:, 2:]) * np.maximum(np.abs(local[:, 2:]) - (size[1] - worn), 0)
    return np.hstack((outward, upward))


def _capsule(local: Image, size: Image) -> Image:
    normals = local.copy()
    normals[:, 2] -= np.clip(local[:, 2], -size[1], size[1])
    return normals


_NORMALS = {
    mujoco.mjtGeom.mjGEOM_BOX: _worn_box,
    mujoco.mjtGeom.mjGEOM_CYLINDER: _worn_cylinder,
    mujoco.mjtGeom.mjGEOM_CAPSULE: _capsule,
    mujoco.mjtGeom.mjGEOM_SPHERE: lambda local, size: local,
    mujoco.mjtGeom.mjGEOM_ELLIPSOID: lambda local, size: local / size**2,
}


def _color(model: mujoco.MjModel, geom: int) -> Array:
    tint = 1 + _TINT * (2 * (geom * _GOLDEN_RATIO % 1) - 1)
    return tint * linear(geom_rgba(model, geom)[:3])


def linear(srgb: Array) -> Array:
    """Colours as screens take them (0..1) to amounts of light (IEC 61966-2-1)."""
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def srgb(linear: Image) -> Image:
    """Amounts of light (0..1) to colours as screens take them (IEC 61966-2-1)."""
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 0.0031308) ** (1 / 2.4) - 0.055)
