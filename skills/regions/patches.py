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

from skills.geometry.camera import DepthImage, PinholeCamera
from skills.geometry.pose import Array
from skills.kernels import leaf_kernel
from skills.regions.noise_level import NoiseLevel, depth_noise, estimate_noise
from skills.regions.parameters import RegionParameters
from skills.regions.patch_sums import LANES, sum_patches

SUMS = 10
N, X, Y, W, XX, XY, YY, XW, YW, WW = range(SUMS)
FACET = 9
_STRETCH = 32  # windows of a row that are fitted together, where one of them has enough pixels
_FILLED_MIN = 0.25  # patches with a smaller share of the usual number of valid pixels get no plane
_PIXELS_MIN = 4.0  # fewer in a patch are too few, however usual they are
_ROUND_MIN = 2.5e-4  # least determinant over squared trace of the spread of pixels that carry a plane


@dataclass(frozen=True, slots=True, eq=False)
class Patches:
    """The patch grid of a depth image, in normalised image coordinates.

    Patches at the right and the lower border may hold fewer pixels than others.

    Attributes:
        size: edge of a patch [px].
        edge: the same as a length at depth 1 [1].
        pixels: how many valid pixels a patch usually has; fewer than its size says where many are lost all over.
        sums: sums over the valid pixels of each patch, (rows, columns, 10).
        facets: plane and mean point of each patch in the camera frame, (rows, columns, 9): unit normal away from the
            camera, distance of the plane, mean point, how far noise may move the mean and turn the plane [1, m, m, m,
            rad]; zeros where it has none.
        sigma: spread of the pixels about that plane, (rows, columns) [m]; infinite where it has none.
        noise: how noisy the image is.
    """

    size: int
    edge: float
    pixels: float
    sums: Array
    facets: Array
    sigma: Array
    noise: NoiseLevel


def fit_patches(image: DepthImage, parameters: RegionParameters, noise: NoiseLevel | None = None) -> Patches:
    """Fit a plane to every patch of a depth image.

    Args:
        image: the depth image.
        parameters: tolerances and limits.
        noise: of the camera, where it is known; measured on the image where it is not.
    """
    camera = image.camera
    size = patch_size(camera, parameters)
    sums = np.zeros((-(-camera.height // size), -(-camera.width // size), SUMS))
    far, work = min(camera.far, parameters.depth_max), np.empty((7, LANES), np.float32)
    sum_patches(image.depth, intrinsics(camera), camera.near, far, size, work[:6].reshape(-1), work[6], sums)
    edge = float(size / np.sqrt(camera.fx * camera.fy))
    nothing = np.empty((0, 0, 0))
    pixels = _usual_pixels(sums, size)
    patches = Patches(size, edge, pixels, sums, nothing, nothing, noise or estimate_noise(sums, pixels))
    return fit_facets(patches, sums, parameters)


def fit_facets(patches: Patches, sums: Array, parameters: RegionParameters, facets: Array | None = None) -> Patches:
    """The same grid of patches with other sums, and planes fitted to these; facets are room for them, all zeros."""
    rows, columns = sums.shape[:2]
    facets = np.zeros((rows, columns, FACET)) if facets is None else facets
    sigma = np.full((rows, columns), np.inf)
    limits = np.array((parameters.noise_factor, parameters.pixel_offset, parameters.grow_offset))
    fits, down, best = np.empty((3, rows, columns)), np.empty((10, columns)), np.empty((2, columns))
    spread = np.full((rows + 2, columns + 2), np.inf)  # with a border
    law, pixels = patches.noise.law, patches.pixels
    filled = np.ascontiguousarray(sums[:, :, 0])
    _fit_facets(filled, sums, law, pixels, patches.edge, limits, fits, spread, down, best[0], best[1], facets, sigma)
    return replace(patches, sums=sums, facets=facets, sigma=sigma)


def _usual_pixels(sums: Array, size: int) -> float:
    """Median of the valid pixels of those patches that have any."""
    counts = sums[:, :, N]
    counts = counts[counts > 0.0]
    return max(float(np.median(counts)), _PIXELS_MIN) if len(counts) else float(size**2)


def patch_size(camera: PinholeCamera, parameters: RegionParameters) -> int:
    """Edge of a patch [px], even."""
    if parameters.patch_size:
        return parameters.patch_size + parameters.patch_size % 2
    return max(4, 2 * round(0.5 * parameters.patch_angle * camera.fx))


def intrinsics(camera: PinholeCamera) -> Array:
    """The camera as kernels take it: (fx, fy, cx, cy)."""
    return np.array([camera.fx, camera.fy, camera.cx, camera.cy])


@leaf_kernel
def fit_plane(s: Array, plane: Array) -> float:
    """Write the least-squares plane of sums; its spread as a standard deviation [m], infinite where it has none."""
    n = s[0]
    if n < 3.0:
        return np.inf
    x, y, w = s[1] / n, s[2] / n, s[3] / n
    xx, xy, yy = s[4] / n - x * x, s[5] / n - x * y, s[6] / n - y * y
    xw, yw, ww = s[7] / n - x * w, s[8] / n - y * w, s[9] / n - w * w
    det = xx * yy - xy * xy
    if det <= _ROUND_MIN * (xx + yy) ** 2 or w <= 0.0:
        return np.inf
    a = (xw * yy - yw * xy) / det
    b = (yw * xx - xw * xy) / det
    plane[0], plane[1], plane[2] = a, b, w - a * x - b * y
    variance = max(ww - a * xw - b * yw, 0.0)
    # An error of w moves a point by z^2 along its ray, and off the plane by less: w / |(a, b, c)| is that cosine.
    length = np.sqrt(a * a + b * b + plane[2] * plane[2])
    return np.sqrt(variance) / (w * length)


@leaf_kernel
def _fit_facets(
    filled: Array,
    sums: Array,
    noise: Array,
    pixels: float,
    edge: float,
    limits: Array,
    fits: Array,
    spread: Array,
    down: Array,
    best: Array,
    which: Array,
    facets: Array,
    sigma: Array,
) -> None:
    rows, columns = sums.shape[0], sums.shape[1]
    for row in range(1, rows - 1):
        for left in range(0, columns - 2, _STRETCH):
            right = min(left + _STRETCH, columns - 2) + 2
            seen = 0.0
            for column in range(left, right):
                seen = max(seen, filled[row - 1, column], filled[row, column], filled[row + 1, column])
            # Windows with enough pixels hold a patch that is at least half full.
            if seen < 0.5 * pixels:
                continue
            for column in range(left, right):
                for k in range(10):
                    down[k, column] = sums[row - 1, column, k] + sums[row, column, k] + sums[row + 1, column, k]
            _fit_row(down, left, right, 4.5 * pixels, fits[0, row], fits[1, row], fits[2, row], spread[row + 1])
    for row in range(rows):
        seen = 0.0
        for column in range(columns):
            best[column], which[column] = np.inf, 0.0
            seen = max(seen, filled[row, column])
        if seen < _FILLED_MIN * pixels:
            continue
        for i in range(3):
            for j in range(3):
                _choose(spread[row + i, j : j + columns], 3.0 * i + j, best, which)
        for column in range(columns):
            s = sums[row, column]
            if filled[row, column] < _FILLED_MIN * pixels:
                continue
            ratio = 1.0 / s[3]
            depth = s[0] * ratio
            off = limits[0] * depth_noise(noise, depth, pixels)
            f = facets[row, column]
            f[4], f[5], f[6] = s[1] * ratio, s[2] * ratio, depth
            f[7], f[8] = off, off / (np.sqrt(6.0) * edge * depth)
            if best[column] > limits[1] + limits[0] * depth_noise(noise, depth, 1.0):
                continue
            i, j = row - 1 + int(which[column]) // 3, column - 1 + int(which[column]) % 3
            a, b, c = fits[0, i, j], fits[1, i, j], fits[2, i, j]
            scale = 1.0 / np.sqrt(a * a + b * b + c * c)
            # Not a number is no plane: a patch in which its best window's plane does not lie has none.
            if abs(scale * (a * f[4] + b * f[5] + c * f[6] - 1.0)) <= limits[2] + off:
                f[0], f[1], f[2], f[3] = scale * a, scale * b, scale * c, scale
                sigma[row, column] = best[column]


@leaf_kernel
def _fit_row(
    down: Array, left: int, right: int, pixels_min: float, a: Array, b: Array, c: Array, spread: Array
) -> None:
    """Fit planes to windows of three sums of columns from left to right; the same as `fit_plane`, in vectors."""
    for k in range(left + 1, right - 1):
        n = down[0, k - 1] + down[0, k] + down[0, k + 1]
        r = 1.0 / n
        x = r * (down[1, k - 1] + down[1, k] + down[1, k + 1])
        y = r * (down[2, k - 1] + down[2, k] + down[2, k + 1])
        w = r * (down[3, k - 1] + down[3, k] + down[3, k + 1])
        xx = r * (down[4, k - 1] + down[4, k] + down[4, k + 1]) - x * x
        xy = r * (down[5, k - 1] + down[5, k] + down[5, k + 1]) - x * y
        yy = r * (down[6, k - 1] + down[6, k] + down[6, k + 1]) - y * y
        xw = r * (down[7, k - 1] + down[7, k] + down[7, k + 1]) - x * w
        yw = r * (down[8, k - 1] + down[8, k] + down[8, k + 1]) - y * w
        ww = r * (down[9, k - 1] + down[9, k] + down[9, k + 1]) - w * w
        det = xx * yy - xy * xy
        q = 1.0 / det
        p = (xw * yy - yw * xy) * q
        q = (yw * xx - xw * xy) * q
        height = w - p * x - q * y
        variance = max(ww - p * xw - q * yw, 0.0) / (w * w * (p * p + q * q + height * height))
        good = (n >= pixels_min) & (det > _ROUND_MIN * (xx + yy) * (xx + yy))
        a[k], b[k] = p, q
        spread[k + 1] = np.sqrt(variance) if good else np.inf
    for k in range(left + 1, right - 1):  # on its own, because vectors allow for few results
        n = down[0, k - 1] + down[0, k] + down[0, k + 1]
        x = down[1, k - 1] + down[1, k] + down[1, k + 1]
        y = down[2, k - 1] + down[2, k] + down[2, k + 1]
        c[k] = (down[3, k - 1] + down[3, k] + down[3, k + 1] - a[k] * x - b[k] * y) / n


@leaf_kernel
def _choose(spread: Array, index: float, best: Array, which: Array) -> None:
    for k in range(best.shape[0]):
        better = spread[k] < best[k]
        best[k] = spread[k] if better else best[k]
        which[k] = index if better else which[k]


@leaf_kernel
def off_plane(s: Array, plane: Array) -> float:
    """Signed distance of the mean point of sums from a plane [m], positive behind it."""
    w = s[3] / s[0]
    a, b, c = plane[0], plane[1], plane[2]
    return ((a * s[1] + b * s[2]) / s[0] + c - w) / (w * np.sqrt(a * a + b * b + c * c))


@leaf_kernel
def misfit(s: Array, own: Array, other: Array) -> float:
    """Root mean square distance, over the pixels of sums, between their own plane and another [m]."""
    n = s[0]
    da, db, dc = other[0] - own[0], other[1] - own[1], other[2] - own[2]
    square = da * da * s[4] + db * db * s[6] + dc * dc * n + 2.0 * (da * db * s[5] + da * dc * s[1] + db * dc * s[2])
    length = np.sqrt(own[0] ** 2 + own[1] ** 2 + own[2] ** 2)
    return np.sqrt(max(square, 0.0) / n) * n / (s[3] * length)
