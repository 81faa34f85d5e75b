"""What a camera truly sees: the depth without noise, and the planar face behind every pixel.

A face that others cut into separate pieces counts as several, because no depth image tells that they are one; so does
one face for each of two neighbours in the same plane, but neither may be held against the other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from lookstep.bench.perception.scenes import Scene
from sim_envs.courses import Box
from sim_envs.sensors import GeomMesh, rasterize_faces
from sim_envs.sensors.shapes import box as box_shape
from skills.geometry.camera import DepthImage, PinholeCamera
from skills.geometry.pose import Array

VOID, BEYOND = -1, -2
"""Faces of pixels that see nothing, and of those that see something deeper than is judged."""

_SAME_COSINE = np.cos(np.deg2rad(1.0))
_SAME_OFFSET = 0.003  # Faces this close to one plane are one plane [m].


@dataclass(frozen=True, slots=True, eq=False)
class Truth:
    """The faces that a camera sees.

    Attributes:
        image: noise-free depth.
        face: visible face of each pixel, (height, width) int32; `VOID` or `BEYOND` where there is none.
        planes: outward unit normal n and offset d of each face, n . p = d in the world, (F, 4).
        points: world point of each pixel, (height, width, 3) [m].
        middles: mean visible point of each face, (F, 3) [m].
        pixels: how many pixels show each face, (F,).
        same_plane: which pairs of faces lie in the same plane, (F, F) bool; each one with itself.
    """

    image: DepthImage
    face: NDArray[np.int32]
    planes: Array
    points: Array
    middles: Array
    pixels: NDArray[np.int64]
    same_plane: NDArray[np.bool_]


def true_view(scene: Scene, depth_max: float = np.inf) -> Truth:
    """What the camera of a scene sees; surfaces deeper than `depth_max` [m] are not judged."""
    mesh = boxes_mesh(scene.boxes)
    no_shift, no_turn = np.zeros((len(scene.boxes), 3)), np.tile(np.eye(3), (len(scene.boxes), 1, 1))
    raster = rasterize_faces(mesh, no_shift, no_turn, scene.camera, scene.T_world_camera)
    image = DepthImage(raster.depth, scene.camera, scene.T_world_camera, 0.0, scene.seed)
    mesh_face = np.where(raster.depth > depth_max, BEYOND, raster.face)
    return truth_of(image, mesh_face, _mesh_planes(mesh))


def truth_of(image: DepthImage, surface: NDArray[np.int32], planes: Array) -> Truth:
    """Truth from a noise-free image, the surface in each pixel and the surfaces' planes, as in `Truth`."""
    face, surface_of_face = _visible_pieces(surface)
    points = back_project(image)
    pixels = np.bincount(face.ravel() + 2, minlength=len(surface_of_face) + 2)[2:]
    planes = planes[surface_of_face]
    sums = [np.bincount(face.ravel() + 2, points[..., k].ravel(), len(planes) + 2)[2:] for k in range(3)]
    middles = np.column_stack(sums) / pixels[:, None]
    off = np.abs(planes[:, :3] @ middles.T - planes[:, 3:])
    same = (planes[:, :3] @ planes[:, :3].T > _SAME_COSINE) & (np.maximum(off, off.T) < _SAME_OFFSET)
    return Truth(image, face, planes, points, middles, pixels, same)


def back_project(image: DepthImage) -> Array:
    """World point of each pixel, (height, width, 3) [m]; the camera itself where there is no depth."""
    x, y = _rays(image.camera)
    z = image.depth.astype(np.float64)
    R, p = image.T_world_camera.R, image.T_world_camera.p
    return np.stack([z * (R[k, 0] * x + R[k, 1] * y[:, None] + R[k, 2]) + p[k] for k in range(3)], axis=-1)


def boxes_mesh(boxes: Sequence[Box]) -> GeomMesh:
    """Faces of boxes as one geom each, in the world; all seen from outside only."""
    made = [box_shape(0.5 * np.array(box.size)) for box in boxes]
    vertices = [box.T_world_box @ corners for box, (corners, _) in zip(boxes, made, strict=True)]
    return GeomMesh(
        geom_ids=np.arange(len(boxes)),
        vertices_geom=np.concatenate(vertices),
        vertex_start=8 * np.arange(len(boxes) + 1),
        faces=np.concatenate([faces + 8 * k for k, (_, faces) in enumerate(made)]),
        face_start=6 * np.arange(len(boxes) + 1),
        centers_geom=np.array([box.T_world_box.p for box in boxes]),
        radii=np.array([0.5 * float(np.linalg.norm(box.size)) for box in boxes]),
        one_sided=np.ones(len(boxes), dtype=np.bool_),
    )


def _mesh_planes(mesh: GeomMesh) -> Array:
    corners = mesh.vertices_geom[mesh.faces]
    normals = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return np.column_stack((normals, np.einsum("fi,fi->f", normals, corners[:, 0])))


def _rays(camera: PinholeCamera) -> tuple[Array, Array]:
    x = (np.arange(camera.width, dtype=np.float64) - camera.cx) / camera.fx
    y = (np.arange(camera.height, dtype=np.float64) - camera.cy) / camera.fy
    return x, y


def _visible_pieces(surface: NDArray[np.int32]) -> tuple[NDArray[np.int32], NDArray[np.int64]]:
    """Connected pieces of equal surfaces: the piece of each pixel, and the surface of each piece."""
    face = np.where(surface < 0, surface, VOID).astype(np.int32)
    surfaces: list[int] = []
    for index in np.flatnonzero(np.bincount(surface.ravel() + 2)[2:]):
        mask = (surface == index).view(np.uint8)
        x, y, width, height = cv2.boundingRect(mask)
        window = np.s_[y : y + height, x : x + width]
        count, pieces = cv2.connectedComponents(mask[window], connectivity=4)
        inside = pieces > 0
        face[window][inside] = pieces[inside] + (len(surfaces) - 1)
        surfaces += [int(index)] * (count - 1)
    return face, np.array(surfaces, dtype=np.int64)
