"""Region labels finer than a patch, and planes fitted once more to them.

The image is cut into quarters of a patch ("cells"). A cell inside one region keeps its label; one near a border takes,
of the regions in the 3 x 3 patches around it, the plane that its pixels fit best. Pixels off a plane by more than a
tolerance count as if at the tolerance, so a cell across a depth edge goes with the majority. The planes are then fitted
again to the cells whose neighbours all have the same label.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.geometry.camera import DepthImage
from skills.geometry.pose import Array
from skills.kernels import kernel
from skills.regions.growing import Labels, Segmentation
from skills.regions.parameters import RegionParameters
from skills.regions.patches import SUMS, Patches, fit_plane, intrinsics


def refine_regions(
    image: DepthImage, patches: Patches, coarse: Segmentation, parameters: RegionParameters
) -> tuple[Segmentation, Array]:
    """Label cells of half a patch's edge and fit the planes to them.

    Returns:
        The labels of cells with their planes, and how much each region is bent: the standard deviation of its inner
        cells' means about its plane, (R,) [m]; infinite where it has too few.
    """
    size = patches.size // 2
    rows, columns = coarse.labels.shape
    lens = intrinsics(image.camera)
    labels = np.full((2 * rows, 2 * columns), -1, dtype=np.int32)
    inverse_depth = np.zeros(labels.shape)
    _label_cells(
        image.depth, lens, size, patches.sums, coarse.labels, coarse.planes, parameters.pixel_offset, labels,
        inverse_depth,
    )  # fmt: skip
    smooth = labels.copy()
    _majority(labels, smooth)
    planes = coarse.planes.copy()
    sums, bend = np.zeros((len(planes), SUMS)), np.zeros(len(planes))
    _refit(smooth, inverse_depth, lens, size, parameters.patches_min, sums, planes, bend)
    return Segmentation(smooth, planes, coarse.sigma), bend


@kernel
def _label_cells(
    depth: NDArray[np.float32],
    lens: Array,
    size: int,
    patch_sums: Array,
    patch_labels: Labels,
    planes: Array,
    tolerance: float,
    labels: Labels,
    inverse_depth: Array,
) -> None:
    rows, columns = patch_labels.shape
    candidates = np.empty(9, np.int32)
    scales = np.empty(planes.shape[0])
    for k in range(planes.shape[0]):
        scales[k] = 1.0 / np.sqrt(planes[k, 0] ** 2 + planes[k, 1] ** 2 + planes[k, 2] ** 2)
    for row in range(rows):
        for column in range(columns):
            count = 0
            for i in range(max(row - 1, 0), min(row + 2, rows)):
                for j in range(max(column - 1, 0), min(column + 2, columns)):
                    label = patch_labels[i, j]
                    known = label < 0
                    for k in range(count):
                        known |= candidates[k] == label
                    if not known:
                        candidates[count] = label
                        count += 1
            if count == 0:
                continue
            # Patches inside a region have nothing to choose, but those with holes in them do.
            inner = count == 1 and patch_labels[row, column] == candidates[0]
            inner = inner and patch_sums[row, column, 0] == 4.0 * size * size
            for quarter in range(4):
                cell_row, cell_column = 2 * row + quarter // 2, 2 * column + quarter % 2
                total, valid = 0.0, 0
                for i in range(cell_row * size, (cell_row + 1) * size):
                    for j in range(cell_column * size, (cell_column + 1) * size):
                        if depth[i, j] > 0.0:
                            total += 1.0 / np.float64(depth[i, j])
                            valid += 1
                if 2 * valid < size * size:
                    continue
                inverse_depth[cell_row, cell_column] = total / valid
                if inner:
                    labels[cell_row, cell_column] = candidates[0]
                    continue
                least = 0.5 * valid * tolerance * tolerance
                for k in range(count):
                    a, b, c = planes[candidates[k], 0], planes[candidates[k], 1], planes[candidates[k], 2]
                    cost = 0.0
                    for i in range(cell_row * size, (cell_row + 1) * size):
                        y = (i - lens[3]) / lens[1]
                        for j in range(cell_column * size, (cell_column + 1) * size):
                            z = np.float64(depth[i, j])
                            if z > 0.0:
                                off = (z * (a * (j - lens[2]) / lens[0] + b * y + c) - 1.0) * scales[candidates[k]]
                                cost += min(off * off, tolerance * tolerance)
                    if cost < least:
                        least = cost
                        labels[cell_row, cell_column] = candidates[k]


@kernel
def _majority(labels: Labels, smooth: Labels) -> None:
    """A label that few of its 3 x 3 cells share gives way to one that five of them have: specks go, edges settle."""
    rows, columns = labels.shape
    for row in range(1, rows - 1):
        for column in range(1, columns - 1):
            here = labels[row, column]
            same = 0
            other, others = here, 0
            for i in range(row - 1, row + 2):
                for j in range(column - 1, column + 2):
                    label = labels[i, j]
                    if label == here:
                        same += 1
                    elif label == other:
                        others += 1
                    elif others == 0:
                        other, others = label, 1
            if same < 4 and others >= 5:
                smooth[row, column] = other


@kernel
def _refit(
    labels: Labels,
    inverse_depth: Array,
    lens: Array,
    size: int,
    cells_min: int,
    sums: Array,
    planes: Array,
    bend: Array,
) -> None:
    rows, columns = labels.shape
    for row in range(1, rows - 1):
        y = ((row + 0.5) * size - 0.5 - lens[3]) / lens[1]
        for column in range(1, columns - 1):
            label = labels[row, column]
            w = inverse_depth[row, column]
            if label < 0 or w == 0.0:
                continue
            inner = True
            for i in range(row - 1, row + 2):
                for j in range(column - 1, column + 2):
                    inner = inner and labels[i, j] == label
            if inner:
                x = ((column + 0.5) * size - 0.5 - lens[2]) / lens[0]
                s = sums[label]
                s[0] += 1.0
                s[1] += x
                s[2] += y
                s[3] += w
                s[4] += x * x
                s[5] += x * y
                s[6] += y * y
                s[7] += x * w
                s[8] += y * w
                s[9] += w * w
    plane = np.empty(3)
    for label in range(planes.shape[0]):
        bend[label] = fit_plane(sums[label], plane) if sums[label, 0] >= cells_min else np.inf
        if np.isfinite(bend[label]):
            for k in range(3):
                planes[label, k] = plane[k]
