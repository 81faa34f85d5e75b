"""The debug image of an extraction: what became of every pixel.

Each region has a colour, what was rejected is hatched in grey, what belongs to no plane is dark and shaded by depth,
pixels without depth are black.
"""

from __future__ import annotations

import cv2
import numpy as np
from numpy.typing import NDArray

from skills.regions.extraction import RegionExtraction

_HATCH = 8  # distance of the hatching's lines [px]
_NOTHING, _FOUND, _REJECTED = 0, 1, 2


def debug_image(extraction: RegionExtraction, stride: int = 1) -> NDArray[np.uint8]:
    """Draw an extraction over its depth image, uint8 RGB.

    Args:
        extraction: what was found.
        stride: draws every nth pixel of every nth row.

    Returns:
        Picture, (ceil(height / stride), ceil(width / stride), 3).
    """
    depth, labels = extraction.image.depth[::stride, ::stride], extraction.labels[::stride, ::stride]
    grey = (30.0 + 60.0 * _nearness(depth)).astype(np.uint8)
    picture = np.repeat(grey[..., None], 3, axis=2)
    found = sorted(set(extraction.region_labels))
    colours = np.zeros((int(labels.max(initial=0)) + 2, 3), dtype=np.uint8)
    colours[found] = _colours(len(found))
    kinds = np.full(len(colours), _REJECTED, dtype=np.uint8)
    kinds[found], kinds[-1] = _FOUND, _NOTHING
    kind = kinds[labels]
    v, u = np.ogrid[: kind.shape[0], : kind.shape[1]]
    cv2.copyTo(colours[labels], (kind == _FOUND).astype(np.uint8), picture)
    picture[(kind == _REJECTED) & ((u + v) % _HATCH < 2)] = 150
    picture[depth == 0.0] = 0
    for rejected in extraction.rejected:
        outline = np.round(rejected.outline_image / stride).astype(np.int32).reshape(-1, 1, 2)
        cv2.polylines(picture, [outline], True, (90, 90, 90))
    return picture


def _nearness(depth: NDArray[np.float32]) -> NDArray[np.float32]:
    """1 at the nearest pixel, falling to 0 with depth."""
    valid = depth > 0.0
    nearest = depth[valid].min() if valid.any() else 1.0
    return np.where(valid, nearest / np.where(valid, depth, np.float32(1.0)), np.float32(0.0))


def _colours(count: int) -> NDArray[np.uint8]:
    """Colours of equal brightness whose hues are far apart from one to the next, (count, 3)."""
    hue = (np.arange(count) * 0.5 * (5.0**0.5 - 1.0)) % 1.0 * 179.0
    hsv = np.column_stack((hue, np.full(count, 150.0), np.full(count, 240.0))).astype(np.uint8)
    rgb = cv2.cvtColor(hsv[None], cv2.COLOR_HSV2RGB)[0] if count else hsv
    return rgb.astype(np.uint8)
