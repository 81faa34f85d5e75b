"""The faces of a MuJoCo model's geoms, made once in the frames of the geoms; only the geoms' poses change with time."""

# mujoco keeps its types in binary modules without stubs.
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from sim_envs.sensors import shapes
from skills.geometry.pose import Array

# Half size that stands for a plane without bounds; numbers of this size cost no precision in float64.
_UNBOUNDED = 1000.0
_VISIBLE_GROUPS = (0, 1, 2)  # MuJoCo's own default of what is drawn


@dataclass(frozen=True, slots=True, eq=False)
class GeomMesh:
    """Faces of G geoms, stored one geom after the other.

    Attributes:
        geom_ids: index in the model of each geom, (G,).
        vertices_geom: corners in the frame of their geom, (V, 3) [m].
        vertex_start: first vertex of each geom, (G + 1,).
        faces: vertex indices of convex planar faces, counter-clockwise from outside, (F, 4); triangles repeat the last.
        face_start: first face of each geom, (G + 1,).
        centers_geom, radii: spheres around the geoms, (G, 3) and (G,) [m].
        one_sided: whether the geom is seen from outside only, so that back faces need no drawing, (G,).
    """

    geom_ids: NDArray[np.int64]
    vertices_geom: Array
    vertex_start: NDArray[np.int64]
    faces: NDArray[np.int64]
    face_start: NDArray[np.int64]
    centers_geom: Array
    radii: Array
    one_sided: NDArray[np.bool_]

    @property
    def face_geom_ids(self) -> NDArray[np.int64]:
        """Index in the model of the geom of each face, (F,)."""
        return np.repeat(self.geom_ids, np.diff(self.face_start))


def geom_mesh(model: mujoco.MjModel, *, groups: Sequence[int] = _VISIBLE_GROUPS, segments: int = 32) -> GeomMesh:
    """Make the faces of all visible geoms of a model.

    Args:
        model: the compiled model.
        groups: geom groups that are seen.
        segments: faces around a round shape.

    Raises:
        ValueError: where a visible geom has a shape that has no faces here (a signed distance field).
    """
    geom_ids = visible_geoms(model, groups)
    made = [_shape(model, geom, segments) for geom in geom_ids]
    vertex_start = np.cumsum([0, *(len(vertices) for vertices, _ in made)])
    spheres = [_sphere_around(vertices) for vertices, _ in made]
    one_sided = [
        _is_surface(model, geom) or shapes.is_closed(shape) for geom, shape in zip(geom_ids, made, strict=True)
    ]
    faces = [faces + start for (_, faces), start in zip(made, vertex_start, strict=False)]
    return GeomMesh(
        geom_ids=np.array(geom_ids, dtype=np.int64),
        vertices_geom=np.concatenate([np.zeros((0, 3)), *(vertices for vertices, _ in made)]),
        vertex_start=vertex_start.astype(np.int64),
        faces=np.concatenate([np.zeros((0, 4), dtype=np.int64), *faces]),
        face_start=np.cumsum([0, *(len(faces) for _, faces in made)]).astype(np.int64),
        centers_geom=np.array([center for center, _ in spheres]).reshape(-1, 3),
        radii=np.array([radius for _, radius in spheres], dtype=np.float64),
        one_sided=np.array(one_sided, dtype=np.bool_),
    )


def visible_geoms(model: mujoco.MjModel, groups: Sequence[int] = _VISIBLE_GROUPS) -> list[int]:
    """Which geoms sensors see: those of the groups that are not fully transparent."""
    return [geom for geom in range(model.ngeom) if model.geom_group[geom] in groups and _opacity(model, geom) > 0]


def geom_rgba(model: mujoco.MjModel, geom: int) -> Array:
    """Colour of a geom, (4,) in 0..1: its material's where it has one."""
    material = model.geom_matid[geom]
    rgba = model.geom_rgba[geom] if material < 0 else model.mat_rgba[material]
    return np.asarray(rgba, dtype=np.float64)


def _opacity(model: mujoco.MjModel, geom: int) -> float:
    return float(geom_rgba(model, geom)[3])


def _kind(model: mujoco.MjModel, geom: int) -> mujoco.mjtGeom:
    return mujoco.mjtGeom(int(model.geom_type[geom]))


def _is_surface(model: mujoco.MjModel, geom: int) -> bool:
    """Planes and height fields are seen from above only, in MuJoCo too."""
    return _kind(model, geom) in (mujoco.mjtGeom.mjGEOM_PLANE, mujoco.mjtGeom.mjGEOM_HFIELD)


def _shape(model: mujoco.MjModel, geom: int, segments: int) -> shapes.Shape:
    size = np.asarray(model.geom_size[geom], dtype=np.float64)
    match _kind(model, geom):
        case mujoco.mjtGeom.mjGEOM_BOX:
            return shapes.box(size)
        case mujoco.mjtGeom.mjGEOM_PLANE:
            return shapes.rectangle(size[0] or _UNBOUNDED, size[1] or _UNBOUNDED)
        case mujoco.mjtGeom.mjGEOM_SPHERE:
            return shapes.ellipsoid(np.full(3, size[0]), segments)
        case mujoco.mjtGeom.mjGEOM_ELLIPSOID:
            return shapes.ellipsoid(size, segments)
        case mujoco.mjtGeom.mjGEOM_CAPSULE:
            return shapes.capsule(size[0], size[1], segments)
        case mujoco.mjtGeom.mjGEOM_CYLINDER:
            return shapes.cylinder(size[0], size[1], segments)
        case mujoco.mjtGeom.mjGEOM_MESH:
            return _mesh_shape(model, int(model.geom_dataid[geom]))
        case mujoco.mjtGeom.mjGEOM_HFIELD:
            return _height_field_shape(model, int(model.geom_dataid[geom]))
    raise ValueError(
        f'geom "{model.geom(geom).name}" ({geom}): got {_kind(model, geom).name}, which cannot be seen by a camera'
    )


def _mesh_shape(model: mujoco.MjModel, mesh: int) -> shapes.Shape:
    vertex, face = model.mesh_vertadr[mesh], model.mesh_faceadr[mesh]
    vertices = model.mesh_vert[vertex : vertex + model.mesh_vertnum[mesh]]
    return shapes.triangles(vertices, model.mesh_face[face : face + model.mesh_facenum[mesh]])


def _height_field_shape(model: mujoco.MjModel, field: int) -> shapes.Shape:
    rows, columns, start = model.hfield_nrow[field], model.hfield_ncol[field], model.hfield_adr[field]
    half_x, half_y, top, _ = model.hfield_size[field]
    heights = model.hfield_data[start : start + rows * columns].reshape(rows, columns)
    return shapes.height_field(top * heights.astype(np.float64), half_x, half_y)


def _sphere_around(vertices: Array) -> tuple[Array, float]:
    center = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    return center, float(np.linalg.norm(vertices - center, axis=1).max())
