"""Depth images without the robot's own body.

Each capsule of the body is bounded by a rectangle of the image; the pixels there whose points are inside the capsule
lose their depth.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from skills.geometry.camera import DepthImage, PinholeCamera
from skills.geometry.pose import Array
from skills.kernels import leaf_kernel


def without_body(image: DepthImage) -> DepthImage:
    """The same image, with no depth where it sees the robot's body; itself where no part of that is in view."""
    if not image.body_world:
        return image
    T_camera_world = image.T_world_camera.inverse
    starts = T_camera_world @ np.array([capsule.start_world for capsule in image.body_world])
    ends = T_camera_world @ np.array([capsule.end_world for capsule in image.body_world])
    radii = np.array([capsule.radius for capsule in image.body_world])
    boxes = _boxes(starts, ends, radii, image.camera)
    seen = np.flatnonzero((boxes[:, 0] < boxes[:, 2]) & (boxes[:, 1] < boxes[:, 3]))
    if not len(seen):
        return image
    depth = image.depth.copy()
    capsules = np.column_stack((starts, ends, radii))[seen].astype(np.float32)
    camera = image.camera
    _erase(depth, np.array([camera.fx, camera.fy, camera.cx, camera.cy], dtype=np.float32), boxes[seen], capsules)
    return replace(image, depth=depth)


def _boxes(starts: Array, ends: Array, radii: Array, camera: PinholeCamera) -> NDArray[np.int64]:
    """Rows and columns from (v0, u0) to, but not with, (v1, u1) that hold what can be seen of each capsule, (K, 4)."""
    low = np.minimum(starts, ends) - radii[:, None]
    high = np.maximum(starts, ends) + radii[:, None]
    nearest, farthest = np.maximum(low[:, 2], camera.near), np.maximum(high[:, 2], camera.near)
    bounds = []
    for axis, f, c, size in ((1, camera.fy, camera.cy, camera.height), (0, camera.fx, camera.cx, camera.width)):
        first = np.minimum(low[:, axis] / nearest, low[:, axis] / farthest) * f + c
        last = np.maximum(high[:, axis] / nearest, high[:, axis] / farthest) * f + c
        # Behind the lens there is nothing to be seen.
        last = np.where(high[:, 2] > camera.near, last, -1.0)
        bounds.append((np.ceil(np.clip(first, 0, size)), np.floor(np.clip(last, -1, size - 1)) + 1))
    (v0, v1), (u0, u1) = bounds
    return np.column_stack((v0, u0, v1, u1)).astype(np.int64)


@leaf_kernel
def _erase(
    depth: NDArray[np.float32],
    lens: NDArray[np.float32],
    boxes: NDArray[np.int64],
    capsules: NDArray[np.float32],
) -> None:
    fx, fy, cx, cy = lens
    zero, one = np.float32(0.0), np.float32(1.0)
    for k in range(boxes.shape[0]):
        v0, u0, v1, u1 = boxes[k]
        ax, ay, az, bx, by, bz, radius = capsules[k]
        ux, uy, uz = bx - ax, by - ay, bz - az
        share = one / max(ux * ux + uy * uy + uz * uz, np.float32(1e-9))
        square, first, wide = radius * radius, np.uint64(u0), u1 - u0
        for v in range(v0, v1):
            line = depth[v]
            y = (np.float32(v) - cy) / fy
            for j in range(wide):
                u = first + np.uint64(j)
                z = line[u]
                px, py, pz = z * (np.float32(u0 + j) - cx) / fx - ax, z * y - ay, z - az
                t = (ux * px + uy * py + uz * pz) * share
                t = t if t > zero else zero
                t = t if t < one else one
                px, py, pz = px - t * ux, py - t * uy, pz - t * uz
                line[u] = zero if px * px + py * py + pz * pz < square else z
