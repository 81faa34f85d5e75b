"""The paper's own way to planar regions, written plainly: what `skills.regions` is measured against.

Dead pixels filled, Gaussian blur, a patch grid with a normal and a centroid a patch (normals by summed cross products
over back-projected points), links to the eight neighbours, a depth-first search over patches, and one least-squares
plane a region, after Mishra et al. as used by Calvert et al. (look-and-step, 2022). Polygons and convex parts come from
the same code as ours, which is kinder than the original's. The parameters are the best that were found on the tuning
scenes, over all noise models at once.
"""

from __future__ import annotations

from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import NDArray

from skills.geometry.camera import DepthImage, PinholeCamera
from skills.geometry.pose import Array
from skills.kernels import kernel
from skills.regions import PlanarRegions, RegionParameters
from skills.regions.extraction import polygons_of

Labels = NDArray[np.int16]


@dataclass(frozen=True, slots=True, kw_only=True)
class BaselineParameters:
    """What the paper's method can be told.

    Attributes:
        patch: edge of a patch [px].
        span: distance of the points whose differences are multiplied [px].
        blur: standard deviation of the Gaussian blur; 0 for none [px].
        link_angle: between the normals of patches that link [rad].
        link_offset: sum of both centroids' distances from the other's plane [m].
        link_distance: distance of the centroids over the one that a surface seen head-on would have.
        links_min: patches with fewer links end the search, as boundary.
        patches_min: smaller regions are dropped.
    """

    patch: int = 4
    span: int = 6
    blur: float = 1.5
    link_angle: float = np.deg2rad(10.0)
    link_offset: float = 0.003
    link_distance: float = 10.0
    links_min: int = 3
    patches_min: int = 48


def find_regions(
    image: DepthImage, parameters: RegionParameters, baseline: BaselineParameters | None = None
) -> tuple[PlanarRegions, Labels]:
    """Planar regions of one depth image, and the label of each pixel.

    Args:
        image: the depth image.
        parameters: for outlines, polygons and limits.
        baseline: of the method.
    """
    own = baseline or BaselineParameters()
    depth = fill_and_blur(image.depth, own.blur)
    normals, centroids = pack_patches(depth, image.camera, own)
    patch_labels, count = search_regions(normals, centroids, image.camera, own)
    planes, sigma = region_planes(centroids, patch_labels, count)
    labels = _spread(patch_labels, own.patch, image.depth.shape)
    regions, _, _ = polygons_of(image, labels, planes, sigma, np.zeros(count), parameters)
    return PlanarRegions(regions, image.time, image.frame_id), labels


def fill_and_blur(depth: NDArray[np.float32], sigma: float) -> NDArray[np.float32]:
    """Depth whose dead pixels have the nearest depth around them, then blurred over a deviation [px]."""
    filled = depth.copy()
    _fill_dead_pixels(depth, filled)
    return cv2.GaussianBlur(filled, (0, 0), sigma) if sigma > 0.0 else filled  # type: ignore[return-value]


def pack_patches(depth: NDArray[np.float32], camera: PinholeCamera, own: BaselineParameters) -> tuple[Array, Array]:
    """Unit normal and centroid of each patch in the camera frame, (rows, columns, 3); NaN where there is none."""
    shape = (camera.height // own.patch, camera.width // own.patch, 3)
    normals, centroids = np.full(shape, np.nan), np.full(shape, np.nan)
    lens = np.array([camera.fx, camera.fy, camera.cx, camera.cy])
    _pack(depth, lens, camera.near, camera.far, own.patch, own.span, normals, centroids)
    return normals, centroids


def search_regions(
    normals: Array, centroids: Array, camera: PinholeCamera, own: BaselineParameters
) -> tuple[Labels, int]:
    """Region of each patch, (rows, columns) int16, -1 for none; and how many regions there are."""
    shape = normals.shape[:2]
    links, labels = np.zeros(shape, np.uint8), np.full(shape, -1, np.int16)
    reach = own.link_distance * own.patch / camera.fx
    _link(normals, centroids, np.cos(own.link_angle), own.link_offset, reach, links)
    return labels, _search(links, own.links_min, own.patches_min, labels)


def region_planes(centroids: Array, labels: Labels, count: int) -> tuple[Array, Array]:
    """Least-squares plane of each region's centroids, as (a, b, c) with 1/z = a x + b y + c, and its spread [m]."""
    sums = np.zeros((count, 10))
    _sum_moments(centroids, labels, sums)
    n = np.maximum(sums[:, 0], 1.0)
    mean = sums[:, 1:4] / n[:, None]
    moments = sums[:, [4, 5, 6, 5, 7, 8, 6, 8, 9]].reshape(count, 3, 3) / n[:, None, None]
    variances, axes = np.linalg.eigh(moments - mean[:, :, None] * mean[:, None, :])
    normals = axes[:, :, 0]
    return normals / np.einsum("ri,ri->r", normals, mean)[:, None], np.sqrt(np.maximum(variances[:, 0], 0.0))


def _spread(patch_labels: Labels, patch: int, shape: tuple[int, ...]) -> Labels:
    labels = np.full(shape, -1, dtype=np.int16)
    rows, columns = patch_labels.shape[0] * patch, patch_labels.shape[1] * patch
    labels[:rows, :columns] = cv2.resize(patch_labels, (columns, rows), interpolation=cv2.INTER_NEAREST)
    return labels


@kernel
def _fill_dead_pixels(depth: NDArray[np.float32], filled: NDArray[np.float32]) -> None:
    """Give each pixel without depth the deepest around it; the outermost columns stay, so that the loop vectorises."""
    height, width = depth.shape
    for v in range(height):
        above, here, below = depth[max(v - 1, 0)], depth[v], depth[min(v + 1, height - 1)]
        out = filled[v]
        for u in range(1, width - 1):
            upper = max(above[u - 1], above[u], above[u + 1])
            lower = max(below[u - 1], below[u], below[u + 1])
            around = max(upper, lower, here[u - 1], here[u + 1])
            out[u] = here[u] if here[u] > np.float32(0.0) else around


@kernel
def _pack(
    depth: NDArray[np.float32],
    lens: Array,
    near: float,
    far: float,
    patch: int,
    span: int,
    normals: Array,
    centroids: Array,
) -> None:
    """Sum down the columns of a band of patches first: those loops run over neighbouring pixels and vectorise."""
    rows, columns = normals.shape[0], normals.shape[1]
    width = columns * patch
    height, full_width = depth.shape
    n, sx, sy, sz = np.empty(width), np.empty(width), np.empty(width), np.empty(width)
    nx, ny, nz = np.empty(width), np.empty(width), np.empty(width)
    for row in range(rows):
        for u in range(width):
            n[u], sx[u], sy[u], sz[u], nx[u], ny[u], nz[u] = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for v in range(row * patch, (row + 1) * patch):
            # The differences of a window at the far border go the other way, which leaves their product as it is.
            down = span if v + span < height else -span
            here, there = depth[v], depth[v + down]
            y, y_there = (v - lens[3]) / lens[1], (v + down - lens[3]) / lens[1]
            for u in range(width):
                z = np.float64(here[u])
                valid = (z >= near) & (z <= far)
                x = (u - lens[2]) / lens[0]
                m = 1.0 if valid else 0.0
                n[u] += m
                sx[u] += m * x * z
                sy[u] += m * y * z
                sz[u] += m * z
            turn = 1.0 if down > 0 else -1.0
            for u in range(min(width, full_width - span)):
                z, z_right, z_down = np.float64(here[u]), np.float64(here[u + span]), np.float64(there[u])
                valid = (min(z, z_right, z_down) >= near) & (max(z, z_right, z_down) <= far)
                m = turn if valid else 0.0
                x, x_right = (u - lens[2]) / lens[0], (u + span - lens[2]) / lens[0]
                ax, ay, az = x_right * z_right - x * z, y * (z_right - z), z_right - z
                bx, by, bz = x * (z_down - z), y_there * z_down - y * z, z_down - z
                nx[u] += m * (ay * bz - az * by)
                ny[u] += m * (az * bx - ax * bz)
                nz[u] += m * (ax * by - ay * bx)
        for column in range(columns):
            count, px, py, pz, qx, qy, qz = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            for u in range(column * patch, (column + 1) * patch):
                count += n[u]
                px, py, pz = px + sx[u], py + sy[u], pz + sz[u]
                qx, qy, qz = qx + nx[u], qy + ny[u], qz + nz[u]
            length = np.sqrt(qx * qx + qy * qy + qz * qz)
            if 2.0 * count >= patch * patch and length > 0.0:
                centroids[row, column, 0] = px / count
                centroids[row, column, 1] = py / count
                centroids[row, column, 2] = pz / count
                normals[row, column, 0] = qx / length
                normals[row, column, 1] = qy / length
                normals[row, column, 2] = qz / length


@kernel
def _link(
    normals: Array, centroids: Array, cosine: float, offset: float, reach: float, links: NDArray[np.uint8]
) -> None:
    """Set one bit for each of the eight neighbours, in reading order, that continues a patch's plane."""
    rows, columns = links.shape
    for row in range(rows):
        for column in range(columns):
            n, p = normals[row, column], centroids[row, column]
            bit = 0
            for i in range(row - 1, row + 2):
                for j in range(column - 1, column + 2):
                    if i == row and j == column:
                        continue
                    if i >= 0 and j >= 0 and i < rows and j < columns:
                        m, q = normals[i, j], centroids[i, j]
                        dx, dy, dz = q[0] - p[0], q[1] - p[1], q[2] - p[2]
                        off = abs(n[0] * dx + n[1] * dy + n[2] * dz) + abs(m[0] * dx + m[1] * dy + m[2] * dz)
                        far = reach * max(p[2], q[2])
                        # A patch without a normal is not a number, and every test of it fails.
                        if (
                            n[0] * m[0] + n[1] * m[1] + n[2] * m[2] >= cosine
                            and off <= offset
                            and dx * dx + dy * dy + dz * dz <= far * far
                        ):
                            links[row, column] |= np.uint8(1 << bit)
                    bit += 1


@kernel
def _search(links: NDArray[np.uint8], links_min: int, patches_min: int, labels: Labels) -> int:
    """Label patches region by region, depth first; the number of regions."""
    rows, columns = links.shape
    stack = np.empty(rows * columns, np.int64)
    members = np.empty(rows * columns, np.int64)
    region = 0
    for seed in range(rows * columns):
        if (
            labels[seed // columns, seed % columns] != -1
            or _count(int(links[seed // columns, seed % columns])) < links_min
        ):
            continue
        stack[0], top, size = seed, 1, 0
        labels[seed // columns, seed % columns] = region
        while top > 0:
            top -= 1
            here = stack[top]
            members[size] = here
            size += 1
            row, column = here // columns, here % columns
            if _count(int(links[row, column])) < links_min:
                continue
            bit = 0
            for i in range(row - 1, row + 2):
                for j in range(column - 1, column + 2):
                    if i == row and j == column:
                        continue
                    if links[row, column] & (1 << bit) and labels[i, j] == -1:
                        labels[i, j] = region
                        stack[top] = i * columns + j
                        top += 1
                    bit += 1
        if size >= patches_min:
            region += 1
        else:
            # Not to be found again, and no region either.
            for k in range(size):
                labels[members[k] // columns, members[k] % columns] = -2
    for row in range(rows):
        for column in range(columns):
            labels[row, column] = max(labels[row, column], -1)
    return region


@kernel
def _sum_moments(centroids: Array, labels: Labels, sums: Array) -> None:
    """Sums of 1, x, y, z, xx, xy, xz, yy, yz and zz over the centroids of each region."""
    for row in range(labels.shape[0]):
        for column in range(labels.shape[1]):
            if labels[row, column] < 0:
                continue
            s, p = sums[labels[row, column]], centroids[row, column]
            x, y, z = p[0], p[1], p[2]
            s[0] += 1.0
            s[1] += x
            s[2] += y
            s[3] += z
            s[4] += x * x
            s[5] += x * y
            s[6] += x * z
            s[7] += y * y
            s[8] += y * z
            s[9] += z * z


@kernel
def _count(bits: int) -> int:
    """How many bits are set."""
    count = 0
    for k in range(8):
        count += (bits >> k) & 1
    return count
