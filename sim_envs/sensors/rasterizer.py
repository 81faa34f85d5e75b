"""Depth of convex planar faces in a pinhole image, drawn face by face, row by row, into a buffer of inverse depth.

On a plane n . p = d the inverse depth along the ray r(u, v) = ((u - cx) / fx, (v - cy) / fy, 1) is n . r / d, affine in
the pixel: a row of a face costs one multiplication and one comparison a pixel, is exact, and needs no clipping but that
of the outline. The nearest face is the one with the greatest inverse depth, and 0 stands for nothing.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sim_envs.sensors.geom_mesh import GeomMesh
from skills.geometry.camera import PinholeCamera
from skills.geometry.pose import Array, Pose
from skills.kernels import kernel

# Faces are cut off at this depth before projection [m]. What lies between it and the camera's `near` still hides what
# lies behind.
_LENS = 1e-3
# A pixel centre this near to an outline counts as inside [px]: neighbours that share an edge leave no gap.
_ON_EDGE = 1e-9
# A face whose plane passes this close to the lens, seen under an angle this small [rad], covers no pixel.
_EDGE_ON = 1e-7
_NO_FACE = np.zeros((0, 0), dtype=np.int32)


@dataclass(frozen=True, slots=True, eq=False)
class Raster:
    """What a camera sees.

    Attributes:
        depth: depth along the optical axis, (height, width) float32 [m]; 0 where nothing is within [near, far].
        face: index of the visible face in the mesh, (height, width) int32; -1 where there is none.
    """

    depth: NDArray[np.float32]
    face: NDArray[np.int32]


def rasterize_depth(
    mesh: GeomMesh, geom_positions: Array, geom_rotations: Array, camera: PinholeCamera, T_world_camera: Pose
) -> NDArray[np.float32]:
    """Depth along the optical axis, (height, width) float32 [m]; 0 where nothing is within [near, far].

    Args:
        mesh: faces of the geoms in their frames.
        geom_positions: origins of all geoms of the model in the world, (ngeom, 3) [m].
        geom_rotations: R_world_geom of all geoms, (ngeom, 3, 3).
        camera: intrinsics.
        T_world_camera: camera frame, x right, y down, z forward.
    """
    return _raster(mesh, geom_positions, geom_rotations, camera, T_world_camera, _NO_FACE)


def rasterize_faces(
    mesh: GeomMesh, geom_positions: Array, geom_rotations: Array, camera: PinholeCamera, T_world_camera: Pose
) -> Raster:
    """Depth, and which face is seen, in each pixel; takes what `rasterize_depth` takes."""
    face = np.full((camera.height, camera.width), -1, dtype=np.int32)
    depth = _raster(mesh, geom_positions, geom_rotations, camera, T_world_camera, face)
    face[depth == 0] = -1
    return Raster(depth, face)


def _raster(
    mesh: GeomMesh,
    geom_positions: Array,
    geom_rotations: Array,
    camera: PinholeCamera,
    T_world_camera: Pose,
    face: NDArray[np.int32],
) -> NDArray[np.float32]:
    image = np.zeros((camera.height, camera.width), dtype=np.float32)
    R_camera_world = T_world_camera.R.T
    R_camera_geom = R_camera_world @ geom_rotations[mesh.geom_ids]
    p_camera = (geom_positions[mesh.geom_ids] - T_world_camera.p) @ R_camera_world.T
    centers_camera = np.einsum("gij,gj->gi", R_camera_geom, mesh.centers_geom) + p_camera
    _draw_geoms(
        np.flatnonzero(in_view(centers_camera, mesh.radii, camera)),
        np.ascontiguousarray(R_camera_geom),
        p_camera,
        mesh.vertices_geom,
        mesh.vertex_start,
        mesh.faces,
        mesh.face_start,
        mesh.one_sided,
        np.array([camera.fx, camera.fy, camera.cx, camera.cy]),
        np.arange(camera.width, dtype=np.float32),
        image,
        face,
    )
    _invert(image, camera.near, camera.far)
    return image


def in_view(centers_camera: Array, radii: Array, camera: PinholeCamera) -> NDArray[np.bool_]:
    """Which spheres a camera may see, by centres in its frame (N, 3) and radii (N,) [m]: those within its frustum."""
    left, right = -camera.cx / camera.fx, (camera.width - 1 - camera.cx) / camera.fx
    top, bottom = -camera.cy / camera.fy, (camera.height - 1 - camera.cy) / camera.fy
    inward = np.array([(1, 0, -left), (-1, 0, right), (0, 1, -top), (0, -1, bottom), (0, 0, 1), (0, 0, -1)])
    inward /= np.linalg.norm(inward, axis=1, keepdims=True)
    offsets = np.array([0, 0, 0, 0, -_LENS, camera.far])
    return (centers_camera @ inward.T + offsets + radii[:, None] >= 0).all(axis=1)


@kernel
def _draw_geoms(
    visible: NDArray[Any],
    R_camera_geom: NDArray[Any],
    p_camera: NDArray[Any],
    vertices: NDArray[Any],
    vertex_start: NDArray[Any],
    faces: NDArray[Any],
    face_start: NDArray[Any],
    one_sided: NDArray[Any],
    optics: NDArray[Any],
    ramp: NDArray[Any],
    inverse_depth: NDArray[Any],
    face_image: NDArray[Any],
) -> None:
    """Draw the faces of the visible geoms."""
    most_vertices = 0
    for g in visible:
        most_vertices = max(most_vertices, vertex_start[g + 1] - vertex_start[g])
    p = np.empty((most_vertices, 3))
    corners = np.empty((5, 3))
    edges = np.empty((5, 5))
    for g in visible:
        first, closed = int(vertex_start[g]), bool(one_sided[g])
        for j in range(vertex_start[g + 1] - first):
            for i in range(3):
                p[j, i] = p_camera[g, i]
                for k in range(3):
                    p[j, i] += R_camera_geom[g, i, k] * vertices[first + j, k]
        for f in range(face_start[g], face_start[g + 1]):
            _draw_face(f, faces[f], first, closed, p, corners, edges, optics, ramp, inverse_depth, face_image)


@kernel
def _draw_face(
    f: int,
    face: NDArray[Any],
    first: int,
    one_sided: bool,
    p: NDArray[Any],
    corners: NDArray[Any],
    edges: NDArray[Any],
    optics: NDArray[Any],
    ramp: NDArray[Any],
    inverse_depth: NDArray[Any],
    face_image: NDArray[Any],
) -> None:
    """Draw one face; p (V, 3) are the corners of its geom in the camera frame."""
    a, b, c, d = face[0] - first, face[1] - first, face[2] - first, face[3] - first
    # The cross product of the diagonals is normal to a quad, and to a triangle that repeats its last corner.
    ex, ey, ez = p[c, 0] - p[a, 0], p[c, 1] - p[a, 1], p[c, 2] - p[a, 2]
    gx, gy, gz = p[d, 0] - p[b, 0], p[d, 1] - p[b, 1], p[d, 2] - p[b, 2]
    nx, ny, nz = ey * gz - ez * gy, ez * gx - ex * gz, ex * gy - ey * gx
    offset = nx * p[a, 0] + ny * p[a, 1] + nz * p[a, 2]
    if one_sided and offset >= 0.0:
        return
    far_off = np.abs(p[a, 0]) + np.abs(p[a, 1]) + np.abs(p[a, 2])
    if np.abs(offset) <= _EDGE_ON * far_off * (np.abs(nx) + np.abs(ny) + np.abs(nz)):
        return
    n = _cut_at_lens(face, first, p, corners)
    if n < 3:
        return

    fx, fy, cx, cy = optics
    height, width = inverse_depth.shape
    u_min, u_max, v_min, v_max = np.inf, -np.inf, np.inf, -np.inf
    for k in range(n):
        u = cx + fx * corners[k, 0] / corners[k, 2]
        v = cy + fy * corners[k, 1] / corners[k, 2]
        corners[k, 0], corners[k, 1] = u, v
        u_min, u_max = min(u_min, u), max(u_max, u)
        v_min, v_max = min(v_min, v), max(v_max, v)
    if u_max < 0.0 or u_min > width - 1 or v_max < 0.0 or v_min > height - 1:
        return
    row_first = int(np.ceil(max(v_min - _ON_EDGE, 0.0)))
    row_last = int(np.floor(min(v_max + _ON_EDGE, height - 1.0)))
    if row_first > row_last or np.ceil(u_min - _ON_EDGE) > np.floor(u_max + _ON_EDGE):
        return
    _lay_edges(corners, n, edges)

    per_column, per_row = nx / (fx * offset), ny / (fy * offset)
    for v in range(row_first, row_last + 1):
        left, right = _row_between(edges, n, v)
        start = int(np.ceil(max(left - _ON_EDGE, 0.0)))
        stop = int(np.floor(min(right + _ON_EDGE, width - 1.0))) + 1
        if start >= stop:
            continue
        # The first pixel in float64: float32 then only adds what changes along the row.
        w_first = np.float32(nz / offset + per_row * (v - cy) + per_column * (start - cx))
        w_step = np.float32(per_column)
        if face_image.shape[0] == 0:
            for k in range(stop - start):
                w = w_first + w_step * ramp[k]
                seen = inverse_depth[v, start + k]
                inverse_depth[v, start + k] = w if w > seen else seen
        else:
            for k in range(stop - start):
                w = w_first + w_step * ramp[k]
                if w > inverse_depth[v, start + k]:
                    inverse_depth[v, start + k] = w
                    face_image[v, start + k] = f


@kernel
def _cut_at_lens(face: NDArray[Any], first: int, p: NDArray[Any], corners: NDArray[Any]) -> int:
    """Copy the part of a face in front of the lens to corners and return its number of corners, at most 5."""
    n = 0
    size = 3 if face[3] == face[2] else 4
    for k in range(size):
        i, j = face[k] - first, face[k + 1 if k + 1 < size else 0] - first
        if p[i, 2] >= _LENS:
            for m in range(3):
                corners[n, m] = p[i, m]
            n += 1
        if (p[i, 2] >= _LENS) != (p[j, 2] >= _LENS):
            # Always from the corner in front to the one behind: both faces at this edge find the same point.
            front, behind = (i, j) if p[i, 2] >= _LENS else (j, i)
            share = (p[front, 2] - _LENS) / (p[front, 2] - p[behind, 2])
            for m in range(2):
                corners[n, m] = p[front, m] + share * (p[behind, m] - p[front, m])
            corners[n, 2] = _LENS
            n += 1
    return n


@kernel
def _lay_edges(outline: NDArray[Any], n: int, edges: NDArray[Any]) -> None:
    """Describe each edge of an outline from its upper to its lower end: rows of both, column and run, 1 / rise."""
    for k in range(n):
        after = k + 1 if k + 1 < n else 0
        low, high = (k, after) if outline[k, 1] <= outline[after, 1] else (after, k)
        rise = outline[high, 1] - outline[low, 1]
        edges[k, 0], edges[k, 1] = outline[low, 1], outline[high, 1]
        edges[k, 2], edges[k, 3] = outline[low, 0], outline[high, 0] - outline[low, 0]
        edges[k, 4] = 1.0 / rise if rise > _ON_EDGE else 0.0


@kernel
def _row_between(edges: NDArray[Any], n: int, v: int) -> tuple[float, float]:
    """Columns between which row v lies inside a convex outline; the first is greater where it does not."""
    left, right = np.inf, -np.inf
    for k in range(n):
        if edges[k, 0] - _ON_EDGE <= v <= edges[k, 1] + _ON_EDGE:
            if edges[k, 4] > 0.0:
                share = min(max((v - edges[k, 0]) * edges[k, 4], 0.0), 1.0)
                u = edges[k, 2] + share * edges[k, 3]
                left, right = min(left, u), max(right, u)
            else:
                left = min(left, edges[k, 2], edges[k, 2] + edges[k, 3])
                right = max(right, edges[k, 2], edges[k, 2] + edges[k, 3])
    return left, right


@kernel
def _invert(image: NDArray[Any], near: float, far: float) -> None:
    """Turn inverse depth into depth in place; 0 where it is out of [near, far]."""
    height, width = image.shape
    nearest, farthest, one, zero = np.float32(near), np.float32(far), np.float32(1.0), np.float32(0.0)
    for v in range(height):
        row = image[v]
        for u in range(width):
            z = one / row[u]
            row[u] = z if (z >= nearest) & (z <= farthest) else zero
