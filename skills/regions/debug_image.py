"""The debug image of an extraction: what became of every pixel.

Each region has a colour, what was rejected is hatched in grey, what belongs to no plane is dark and shaded by depth,
pixels without depth are black; lines show the patch grid.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from skills.regions.extraction import RegionExtraction

_HATCH = 8  # distance of the hatching's lines [px]
_GRID = 0.85  # brightness of the patch grid's lines


def debug_image(extraction: RegionExtraction) -> NDArray[np.uint8]:
    """Draw an extraction over its depth image, (height, width, 3) uint8 RGB."""
    image = extraction.image
    rgb = np.repeat((30.0 + 60.0 * _nearness(image.depth))[..., None], 3, axis=2)
    labels = np.repeat(np.repeat(extraction.labels, extraction.cell_size, axis=0), extraction.cell_size, axis=1)
    drawn = rgb[: labels.shape[0], : labels.shape[1]]
    hatch = np.add.outer(np.arange(labels.shape[0]), np.arange(labels.shape[1])) % _HATCH < 2
    drawn[(labels >= 0) & hatch] = 150.0
    found = sorted(set(extraction.region_labels))
    palette = np.zeros((int(extraction.labels.max(initial=0)) + 2, 3))
    palette[found] = _colours(len(found))
    accepted = np.isin(labels, found)
    drawn[accepted] = palette[labels[accepted]]
    patch = 2 * extraction.cell_size
    drawn[::patch] *= _GRID
    drawn[:, ::patch] *= _GRID
    rgb[image.depth == 0.0] = 0.0
    picture = rgb.astype(np.uint8)
    for rejected in extraction.rejected:
        outline = np.round(rejected.outline_image).astype(np.int32).reshape(-1, 1, 2)
        cv2.polylines(picture, [outline], True, (90, 90, 90))
    return picture


def _nearness(depth: NDArray[np.float32]) -> NDArray[np.float64]:
    """1 at the nearest pixel, falling to 0 with depth."""
    valid = depth > 0.0
    nearest = depth[valid].min() if valid.any() else 1.0
    return np.where(valid, nearest / np.where(valid, depth, 1.0), 0.0)


def _colours(count: int) -> NDArray[np.float64]:
    """Colours of equal brightness whose hues are far apart from one to the next, (count, 3)."""
    hue = (np.arange(count) * 0.5 * (5.0**0.5 - 1.0)) % 1.0 * 179.0
    hsv = np.column_stack((hue, np.full(count, 150.0), np.full(count, 240.0))).astype(np.uint8)
    return cv2.cvtColor(hsv[None], cv2.COLOR_HSV2RGB)[0].astype(np.float64) if count else np.zeros((0, 3))
