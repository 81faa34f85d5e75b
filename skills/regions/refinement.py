"""From regions of patches to pixels: labels, a second look at what is left, and planes fitted once more.

Pixels are labelled along the borders of the regions. What fits no plane there, and what had no region at all, is cut
into patches once more, now without the pixels that are spoken for: so faces narrower than the window of a patch come
out between two regions. All planes are then fitted again to all pixels but those next to a border.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skills.geometry.camera import DepthImage
from skills.geometry.pose import Array
from skills.kernels import kernel, leaf_kernel
from skills.regions.growing import PatchRegions
from skills.regions.noise_level import NoiseLevel, depth_noise
from skills.regions.parameters import RegionParameters
from skills.regions.patch_sums import LANES
from skills.regions.patches import SUMS, Patches, fit_plane, intrinsics, off_plane
from skills.regions.pixel_labels import label_pixels
from skills.regions.pixel_sums import EROSION, sum_pixels
from skills.regions.plane_contest import PixelLabels
from skills.regions.second_look import look_again


@dataclass(frozen=True, slots=True, eq=False)
class Segmentation:
    """Which pixel belongs to which plane.

    Attributes:
        labels: index into planes for each pixel, (height, width) int16; -1 for none.
        planes: plane of each region, (R, 3) [1/m], as in `Patches`.
        sigma: spread of each region's pixels about its plane, (R,) [m].
        bend: spread of the means of its inner patches about its plane, (R,) [m]; infinite where it has no plane.
        noise: how noisy the image is.
    """

    labels: PixelLabels
    planes: Array
    sigma: Array
    bend: Array
    noise: NoiseLevel


def refine_regions(
    image: DepthImage, patches: Patches, coarse: PatchRegions, parameters: RegionParameters
) -> Segmentation:
    """Label the pixels of an image whose patches are labelled, and fit the planes to them."""
    camera = image.camera
    lens = intrinsics(camera)
    near, far = camera.near, min(camera.far, parameters.depth_max)
    limits = np.array([near, far, parameters.pixel_offset, parameters.noise_factor, *patches.noise.law])
    depth = image.depth
    labels, bare = np.full(depth.shape, -1, dtype=np.int16), np.zeros(depth.shape, dtype=np.int16)
    inner = np.zeros(coarse.labels.shape, dtype=np.bool_)
    planes, pixel_planes = coarse.planes, _in_pixels(coarse.planes, lens)
    of_patches = depth, patches.size, limits, patches.sums
    label_pixels(*of_patches, coarse.labels, None, planes, pixel_planes, inner, labels, bare)
    found = look_again(image, patches, coarse, inner, bare, parameters)
    if found is not None:
        planes, pixel_planes = found.planes, _in_pixels(found.planes, lens)
        if (found.numbers != np.arange(len(found.numbers))).any():
            labels = np.append(found.numbers, -1).astype(np.int16)[labels]
        label_pixels(*of_patches, found.coarse, found.fine, planes, pixel_planes, inner, labels, bare)
    planes = np.array(planes)
    sums, sigma, bend = np.zeros((len(planes), SUMS)), np.zeros(len(planes)), np.zeros(len(planes))
    lanes, met = np.empty(6 * LANES, np.float32), np.empty(patches.size**2, np.int16)
    _sum_regions(depth, patches.size, limits, lens, patches.sums, inner, labels, pixel_planes, lanes, met, sums)
    _refit(patches.sums, patches.size, limits[4:], inner, labels, sums, planes, sigma, bend)
    return Segmentation(labels, planes, sigma, bend, patches.noise)


def _in_pixels(planes: Array, lens: Array) -> NDArray[np.float32]:
    """Planes as inverse depth over pixel coordinates, w = a u + b v + c, (R, 3)."""
    fx, fy, cx, cy = lens
    a, b = planes[:, 0] / fx, planes[:, 1] / fy
    return np.column_stack((a, b, planes[:, 2] - a * cx - b * cy)).astype(np.float32)


@leaf_kernel
def _sum_regions(
    depth: NDArray[np.float32],
    size: int,
    limits: Array,
    lens: Array,
    patch_sums: Array,
    inner: NDArray[np.bool_],
    labels: PixelLabels,
    planes: NDArray[np.float32],
    lanes: NDArray[np.float32],
    found: PixelLabels,
    sums: Array,
) -> None:
    """Sums over the pixels of each region that lie in its plane."""
    rows, columns = inner.shape
    height, width = depth.shape
    for row in range(rows):
        for column in range(columns):
            v0, u0 = row * size, column * size
            if inner[row, column]:
                for k in range(10):
                    sums[labels[v0, u0], k] += patch_sums[row, column, k]
                continue
            s = patch_sums[row, column]
            if s[0] == 0.0:
                continue
            if _alone(labels, v0, u0, size):
                label = labels[v0, u0]
                if label >= 0:
                    for k in range(10):
                        sums[label, k] += s[k]
                continue
            v1, u1 = min(v0 + size, height), min(u0 + size, width)
            mean_depth = s[0] / s[3]
            allowed = (limits[2] + limits[3] * depth_noise(limits[4:], mean_depth, 1.0)) / mean_depth
            count = 0
            before = np.int16(-1)
            for v in range(v0, v1):
                for u in range(u0, u1):
                    label = labels[v, u]
                    if label == before or label < 0:
                        continue
                    before = label
                    known = False
                    for k in range(count):
                        known |= found[k] == label
                    if not known:
                        found[count] = label
                        count += 1
            for k in range(count):
                label = found[k]
                box, plane = (v0, u0, v1, u1), (planes[label, 0], planes[label, 1], planes[label, 2])
                sum_pixels(depth, labels, label, box, lens, plane, (limits[0], limits[1], allowed), lanes, sums[label])


@leaf_kernel
def _alone(labels: PixelLabels, v0: int, u0: int, size: int) -> bool:
    """Whether a patch and the pixels about it that matter to it have the same label."""
    beside = EROSION
    if size < 2 * beside:
        return False
    if v0 < beside or u0 < beside or v0 + size + beside > labels.shape[0] or u0 + size + beside > labels.shape[1]:
        return False
    label, change = labels[v0, u0], np.int16(0)
    first, last = np.uint64(u0 - beside), np.uint64(u0 + beside)
    for v in range(v0 - beside, v0 + size + beside):
        line = labels[v]
        for j in range(size):
            change |= (line[first + np.uint64(j)] ^ label) | (line[last + np.uint64(j)] ^ label)
    return change == 0


@kernel
def _refit(
    patch_sums: Array,
    size: int,
    noise: Array,
    inner: NDArray[np.bool_],
    labels: PixelLabels,
    sums: Array,
    planes: Array,
    sigma: Array,
    bend: Array,
) -> None:
    plane = np.empty(3)
    count = np.zeros(len(planes))
    for label in range(planes.shape[0]):
        sigma[label] = fit_plane(sums[label], plane)
        if np.isfinite(sigma[label]):
            for k in range(3):
                planes[label, k] = plane[k]
    for row in range(inner.shape[0]):
        for column in range(inner.shape[1]):
            if inner[row, column] and patch_sums[row, column, 0] > 0.0:
                label = labels[row * size, column * size]
                count[label] += 1.0
                bend[label] += off_plane(patch_sums[row, column], planes[label]) ** 2
    for label in range(planes.shape[0]):
        bend[label] = np.sqrt(bend[label] / max(count[label], 1.0)) if np.isfinite(sigma[label]) else np.inf
