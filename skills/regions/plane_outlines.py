"""Outlines of an image on the planes that they show.

The inverse depth of a plane is affine in the pixel, so the way from pixels to coordinates on the plane is a homography:
three dot products and a division a point, for every loop around a region at once.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skills.geometry.camera import DepthImage, PinholeCamera
from skills.geometry.pose import Array, Pose
from skills.kernels import kernel
from skills.regions.outline import Indices, Outlines


@dataclass(frozen=True, slots=True, eq=False)
class PlaneOutlines:
    """Where the loops of an image lie on the planes of their regions.

    Attributes:
        R_world_planes: axes of each plane, (R, 3, 3): z out of the surface, x along the world's x as far as it can.
        heights: z of each plane along its own axes, (R,) [m].
        points: x and y of the loops' vertices along the axes of their planes, from the world's origin, (N, 2) [m].
        pixels: size of a pixel on the plane at each vertex, (N,) [m].
        areas: area of each loop, (L,) [m^2]; negative around a hole.
        depths: mean depth of each loop's vertices, (L,) [m]; infinite where one is beyond the camera's range.
    """

    R_world_planes: Array
    heights: Array
    points: Array
    pixels: Array
    areas: Array
    depths: Array


def back_project(outlines: Outlines, image: DepthImage, planes: Array) -> PlaneOutlines:
    """Put the outlines of an image on planes.

    Args:
        outlines: loops in the image.
        image: the image that they were found in.
        planes: plane of each region, (R, 3) [1/m]: inverse depth is its product with a ray (x, y, 1).
    """
    T_world_camera = image.T_world_camera
    R = _axes(planes, T_world_camera)
    heights = R[:, :, 2] @ T_world_camera.p - 1.0 / np.linalg.norm(planes, axis=1)
    rays = _rays_of_pixels(image.camera)
    homographies = np.empty((len(planes), 3, 3))
    homographies[:, :2] = R[:, :, :2].transpose(0, 2, 1) @ (T_world_camera.R @ rays)
    homographies[:, 2] = planes @ rays
    offsets = T_world_camera.p @ R[:, :, :2]
    projected = _project(
        outlines.points, outlines.starts, outlines.labels, homographies, offsets, 1.0 / image.camera.far
    )
    return PlaneOutlines(R, heights, *projected)


def _axes(planes: Array, T_world_camera: Pose) -> Array:
    normals = -(planes @ T_world_camera.R.T) / np.linalg.norm(planes, axis=1, keepdims=True)
    nx, ny, nz = normals.T
    zero = np.zeros(len(planes))
    y = np.where(np.abs(nx) < 0.9, np.array((zero, nz, -ny)), np.array((-nz, zero, nx))).T
    y /= np.linalg.norm(y, axis=1, keepdims=True)
    return np.stack((np.cross(y, normals), y, normals), axis=2)


def _rays_of_pixels(camera: PinholeCamera) -> Array:
    """The matrix from pixels (u, v, 1) to rays (x, y, 1)."""
    return np.array(
        [
            [1.0 / camera.fx, 0.0, -camera.cx / camera.fx],
            [0.0, 1.0 / camera.fy, -camera.cy / camera.fy],
            [0.0, 0.0, 1.0],
        ]
    )


@kernel
def _project(
    pixels: Array, starts: Indices, labels: Indices, homographies: Array, offsets: Array, inverse_depth_min: float
) -> tuple[Array, Array, Array, Array]:
    points, sizes = np.empty(pixels.shape), np.empty(pixels.shape[0])
    areas, depths = np.empty(labels.shape[0]), np.empty(labels.shape[0])
    for loop in range(labels.shape[0]):
        h, offset = homographies[labels[loop]], offsets[labels[loop]]
        first, last = starts[loop], starts[loop + 1]
        depth = 0.0
        for k in range(first, last):
            u, v = pixels[k, 0], pixels[k, 1]
            w = h[2, 0] * u + h[2, 1] * v + h[2, 2]
            # Written so that a plane that is not a number fails.
            if not w >= inverse_depth_min:
                depth = np.inf
                break
            x = (h[0, 0] * u + h[0, 1] * v + h[0, 2]) / w
            y = (h[1, 0] * u + h[1, 1] * v + h[1, 2]) / w
            along_u = (h[0, 0] - x * h[2, 0]) ** 2 + (h[1, 0] - y * h[2, 0]) ** 2
            along_v = (h[0, 1] - x * h[2, 1]) ** 2 + (h[1, 1] - y * h[2, 1]) ** 2
            points[k, 0], points[k, 1] = x + offset[0], y + offset[1]
            sizes[k] = np.sqrt(max(along_u, along_v)) / w
            depth += 1.0 / w
        depths[loop] = depth / (last - first)
        area = 0.0
        if depth < np.inf:
            j = last - 1
            for k in range(first, last):
                area += points[j, 0] * points[k, 1] - points[k, 0] * points[j, 1]
                j = k
        areas[loop] = 0.5 * area
    return points, sizes, areas, depths
