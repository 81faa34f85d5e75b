"""Flat pictures of what perception knows: depth, the map of regions from above, heights from above."""

from __future__ import annotations

from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import NDArray

from skills.geometry import Array, DepthImage, Pose
from skills.height_map import HeightMap
from skills.regions import PlanarRegions

Picture = NDArray[np.uint8]

_PAGE, _INK, _SOLE = (24, 26, 30), (14, 16, 20), (250, 250, 250)
_PIXELS_PER_METRE = 160.0
_FILLED = 0.6  # brightness of cells without data of their own
_CELL_PIXELS = 5


def depth_picture(image: DepthImage) -> Picture:
    """Near is red, far is blue, no depth is black, (height, width, 3) RGB."""
    valid = np.isfinite(image.depth) & (image.depth > 0.0)
    inverse = np.divide(1.0, image.depth, out=np.full(image.depth.shape, np.nan, np.float32), where=valid)
    return colored(inverse)


def height_picture(heights: HeightMap) -> Picture:
    """The known part from above, x to the right and y up; red is high, blue is low, filled cells are darker."""
    colors = colored(heights.heights)
    known = ~np.isnan(heights.heights)
    picture = np.where(heights.filled[..., None], _FILLED * colors, colors).astype(np.uint8)
    rows, columns = (np.flatnonzero(known.any(axis=axis)) for axis in (1, 0))
    if len(rows):
        picture = picture[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
    return np.flipud(picture).repeat(_CELL_PIXELS, axis=0).repeat(_CELL_PIXELS, axis=1)


def map_picture(regions: PlanarRegions, colors: Picture, soles: Sequence[Pose], sole: Array) -> Picture:
    """Regions from above, x to the right and y up, newer ones over older ones, and where the feet stand."""
    hulls = [region.hull_world for region in regions.regions]
    outlines = [pose @ np.column_stack((sole, np.zeros(len(sole)))) for pose in soles]
    corners = np.vstack((*hulls, *outlines))[:, :2]
    low, high = corners.min(axis=0) - 0.1, corners.max(axis=0) + 0.1
    width, height = np.ceil((high - low) * _PIXELS_PER_METRE).astype(int)
    picture = np.full((height, width, 3), _PAGE, dtype=np.uint8)
    for hull, color in zip(hulls, colors.tolist(), strict=True):
        on_picture = _from_above(hull, low, height)
        cv2.fillPoly(picture, [on_picture], color)
        cv2.polylines(picture, [on_picture], True, _INK, 1, cv2.LINE_AA)
    cv2.polylines(picture, [_from_above(outline, low, height) for outline in outlines], True, _SOLE, 2, cv2.LINE_AA)
    return picture


def colored(values: NDArray[np.float32]) -> Picture:
    """Values from blue, low, to red, high; what is not a number is black, (rows, columns, 3) RGB."""
    known = ~np.isnan(values)
    low, high = np.percentile(values[known], (1.0, 99.0)) if known.any() else (0.0, 1.0)
    share = np.clip((np.where(known, values, low) - low) / max(high - low, 1e-3), 0.0, 1.0)
    bgr = cv2.applyColorMap((255.0 * share).astype(np.uint8), cv2.COLORMAP_TURBO)
    return np.where(known[..., None], bgr[..., ::-1], np.uint8(0)).astype(np.uint8)


def _from_above(points_world: Array, low: Array, height: int) -> NDArray[np.int32]:
    xy = (points_world[:, :2] - low) * _PIXELS_PER_METRE
    return np.column_stack((xy[:, 0], height - 1 - xy[:, 1])).round().astype(np.int32)
