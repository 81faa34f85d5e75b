"""Patch planes in closed form, from inverse depth.

Along a plane n . p = d the inverse depth is affine in the pixel: 1/z = (n_x x + n_y y + n_z) / d with x = (u - cx) / fx
and y = (v - cy) / fy. So the sums of 1, x, y, w, x^2, xy, y^2, xw, yw and w^2 (w = 1/z) over the pixels of a patch hold
all that a least-squares plane needs; sums of neighbouring patches add, and no point cloud is made. Each patch then
takes the best of the nine 3 x 3 windows that hold it (Kuwahara et al., 1976), which keeps edges sharp. A plane is
q = (a, b, c) with w = a x + b y + c: its normal away from the camera is q / |q|, its distance 1 / |q|.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from skills.geometry.camera import DepthImage, PinholeCamera
from skills.geometry.pose import Array
from skills.kernels import kernel
from skills.regions.noise_level import NoiseLevel, depth_noise, estimate_noise
from skills.regions.parameters import RegionParameters

SUMS = 10
N, X, Y, W, XX, XY, YY, XW, YW, WW = range(SUMS)


@dataclass(frozen=True, slots=True, eq=False)
class Patches:
    """The patch grid of a depth image, in normalised image coordinates.

    Attributes:
        size: edge of a patch [px].
        edge: the same as a length at depth 1 [1].
        sums: sums over the valid pixels of each patch, (rows, columns, 10).
        planes: plane of each patch, (rows, columns, 3) [1/m]; not a number where it has none.
        sigma: spread of the pixels about that plane, (rows, columns) [m]; infinite where it has none.
        noise: how noisy the image is.
    """

    size: int
    edge: float
    sums: Array
    planes: Array
    sigma: Array
    noise: NoiseLevel


def fit_patches(image: DepthImage, parameters: RegionParameters, noise: NoiseLevel | None = None) -> Patches:
    """Fit a plane to every patch of a depth image; patches on the robot's own body get none.

    Args:
        image: the depth image.
        parameters: tolerances and limits.
        noise: of the camera, where it is known; measured on the image where it is not.
    """
    camera = image.camera
    size = patch_size(camera, parameters)
    rows, columns = camera.height // size, camera.width // size
    sums = np.zeros((rows, columns, SUMS))
    _sum_patches(image.depth, intrinsics(camera), camera.near, min(camera.far, parameters.depth_max), size, sums)
    if image.body_world:
        _drop_body(sums, _capsules_in_camera(image))
    edge = size / np.sqrt(camera.fx * camera.fy)
    nothing = np.empty((0, 0, 3))
    patches = Patches(size, float(edge), sums, nothing, nothing[..., 0], noise or estimate_noise(sums, size**2))
    return fit_patch_planes(patches, sums, parameters)


def fit_patch_planes(patches: Patches, sums: Array, parameters: RegionParameters) -> Patches:
    """The same grid of patches with other sums, and planes fitted to these."""
    rows, columns = sums.shape[:2]
    planes = np.full((rows, columns, 3), np.nan)
    sigma = np.full((rows, columns), np.inf)
    limits = np.array((parameters.noise_factor, parameters.pixel_offset, parameters.grow_offset))
    _fit_windows(sums, patches.noise.law, patches.size**2, limits, planes, sigma)
    return replace(patches, sums=sums, planes=planes, sigma=sigma)


def _capsules_in_camera(image: DepthImage) -> Array:
    """The robot's body as rows of two ends in the camera frame and a radius, (K, 7) [m]."""
    T_camera_world = image.T_world_camera.inverse
    rows = [(*(T_camera_world @ c.start_world), *(T_camera_world @ c.end_world), c.radius) for c in image.body_world]
    return np.array(rows)


def patch_size(camera: PinholeCamera, parameters: RegionParameters) -> int:
    """Edge of a patch [px]: even, because refinement works on its quarters."""
    if parameters.patch_size:
        return parameters.patch_size + parameters.patch_size % 2
    return max(4, 2 * round(0.5 * parameters.patch_angle * camera.fx))


def intrinsics(camera: PinholeCamera) -> Array:
    """The camera as kernels take it: (fx, fy, cx, cy)."""
    return np.array([camera.fx, camera.fy, camera.cx, camera.cy])


@kernel
def _sum_patches(depth: NDArray[np.float32], lens: Array, near: float, far: float, size: int, sums: Array) -> None:
    """Sum down the columns of a band first: those loops run over neighbouring pixels and vectorise."""
    rows, columns = sums.shape[0], sums.shape[1]
    width = columns * size
    n, i1, i2 = np.empty(width), np.empty(width), np.empty(width)
    w1, iw, ww = np.empty(width), np.empty(width), np.empty(width)
    for row in range(rows):
        for u in range(width):
            n[u], i1[u], i2[u], w1[u], iw[u], ww[u] = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for i in range(size):
            line = depth[row * size + i]
            for u in range(width):
                z = np.float64(line[u])
                valid = (z >= near) & (z <= far)
                w = 1.0 / z if valid else 0.0
                m = 1.0 if valid else 0.0
                n[u] += m
                i1[u] += i * m
                i2[u] += i * i * m
                w1[u] += w
                iw[u] += i * w
                ww[u] += w * w
        y0 = (row * size - lens[3]) / lens[1]
        dy = 1.0 / lens[1]
        for column in range(columns):
            out = sums[row, column]
            for j in range(size):
                u = column * size + j
                x = (u - lens[2]) / lens[0]
                y1 = y0 * n[u] + dy * i1[u]
                out[0] += n[u]
                out[1] += x * n[u]
                out[2] += y1
                out[3] += w1[u]
                out[4] += x * x * n[u]
                out[5] += x * y1
                out[6] += y0 * y0 * n[u] + 2.0 * y0 * dy * i1[u] + dy * dy * i2[u]
                out[7] += x * w1[u]
                out[8] += y0 * w1[u] + dy * iw[u]
                out[9] += ww[u]


@kernel
def _drop_body(sums: Array, capsules: Array) -> None:
    """Empty every patch whose mean point is inside a capsule."""
    for row in range(sums.shape[0]):
        for column in range(sums.shape[1]):
            s = sums[row, column]
            if s[0] == 0.0:
                continue
            z = s[0] / s[3]
            x, y = s[1] / s[0] * z, s[2] / s[0] * z
            for k in range(capsules.shape[0]):
                c = capsules[k]
                ux, uy, uz = c[3] - c[0], c[4] - c[1], c[5] - c[2]
                px, py, pz = x - c[0], y - c[1], z - c[2]
                along = ux * px + uy * py + uz * pz
                t = min(max(along / max(ux * ux + uy * uy + uz * uz, 1e-12), 0.0), 1.0)
                if (px - t * ux) ** 2 + (py - t * uy) ** 2 + (pz - t * uz) ** 2 < c[6] * c[6]:
                    for m in range(10):
                        s[m] = 0.0
                    break


@kernel
def fit_plane(s: Array, plane: Array) -> float:
    """Write the least-squares plane of sums; its spread as a standard deviation [m], infinite where it has none."""
    n = s[0]
    if n < 3.0:
        return np.inf
    x, y, w = s[1] / n, s[2] / n, s[3] / n
    xx, xy, yy = s[4] / n - x * x, s[5] / n - x * y, s[6] / n - y * y
    xw, yw, ww = s[7] / n - x * w, s[8] / n - y * w, s[9] / n - w * w
    det = xx * yy - xy * xy
    if det <= 1e-3 * (xx + yy) ** 2 * 0.25 or w <= 0.0:
        return np.inf
    a = (xw * yy - yw * xy) / det
    b = (yw * xx - xw * xy) / det
    plane[0], plane[1], plane[2] = a, b, w - a * x - b * y
    variance = max(ww - a * xw - b * yw, 0.0)
    # An error of w moves a point by z^2 along its ray, and off the plane by less: w / |(a, b, c)| is that cosine.
    length = np.sqrt(a * a + b * b + plane[2] * plane[2])
    return np.sqrt(variance) / (w * length)


@kernel
def _fit_windows(sums: Array, noise: Array, pixels: float, limits: Array, planes: Array, sigma: Array) -> None:
    rows, columns = sums.shape[0], sums.shape[1]
    window = np.empty(10)
    fit = np.empty((rows, columns, 3))
    spread = np.empty((rows, columns))
    for row in range(rows):
        for column in range(columns):
            spread[row, column] = np.inf
    for row in range(1, rows - 1):
        for column in range(1, columns - 1):
            for k in range(10):
                window[k] = 0.0
            for i in range(row - 1, row + 2):
                for j in range(column - 1, column + 2):
                    for k in range(10):
                        window[k] += sums[i, j, k]
            if window[0] >= 4.5 * pixels:
                spread[row, column] = fit_plane(window, fit[row, column])
    for row in range(rows):
        for column in range(columns):
            s = sums[row, column]
            if s[0] < 0.5 * pixels:
                continue
            depth = s[0] / s[3]
            best, least = -1, limits[1] + limits[0] * depth_noise(noise, depth, 1.0)
            for i in range(max(row - 1, 0), min(row + 2, rows)):
                for j in range(max(column - 1, 0), min(column + 2, columns)):
                    if spread[i, j] < least:
                        best, least = i * columns + j, spread[i, j]
            if best < 0:
                continue
            plane = fit[best // columns, best % columns]
            if abs(off_plane(s, plane)) > limits[2] + limits[0] * depth_noise(noise, depth, pixels):
                continue
            for k in range(3):
                planes[row, column, k] = plane[k]
            sigma[row, column] = least


@kernel
def off_plane(s: Array, plane: Array) -> float:
    """Signed distance of the mean point of sums from a plane [m], positive behind it."""
    w = s[3] / s[0]
    a, b, c = plane[0], plane[1], plane[2]
    return ((a * s[1] + b * s[2]) / s[0] + c - w) / (w * np.sqrt(a * a + b * b + c * c))


@kernel
def cosine(p: Array, q: Array) -> float:
    """Cosine of the angle between the normals of two planes."""
    pq = p[0] * q[0] + p[1] * q[1] + p[2] * q[2]
    return pq / np.sqrt((p[0] ** 2 + p[1] ** 2 + p[2] ** 2) * (q[0] ** 2 + q[1] ** 2 + q[2] ** 2))


@kernel
def misfit(s: Array, own: Array, other: Array) -> float:
    """Root mean square distance, over the pixels of sums, between their own plane and another [m]."""
    n = s[0]
    da, db, dc = other[0] - own[0], other[1] - own[1], other[2] - own[2]
    square = da * da * s[4] + db * db * s[6] + dc * dc * n + 2.0 * (da * db * s[5] + da * dc * s[1] + db * dc * s[2])
    length = np.sqrt(own[0] ** 2 + own[1] ** 2 + own[2] ** 2)
    return np.sqrt(max(square, 0.0) / n) * n / (s[3] * length)
