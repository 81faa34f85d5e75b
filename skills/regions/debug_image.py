"""The debug image of an extraction: what became of every pixel, after the coloured region images of Calvert et al.

Each region has a colour and its number, with the outline of its polygon and of its convex parts; what was rejected is
hatched and says why. All is shaded by the slant of the measured surface, so that the depth structure shows through.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from skills.geometry.camera import DepthImage
from skills.geometry.pose import Array
from skills.regions.extraction import RegionExtraction
from skills.regions.patches import patch_size
from skills.regions.pieces import PixelKind, homography, in_image, kind_of_pixels, piece_of_pixels

Picture = NDArray[np.uint8]

_COLORS = {
    PixelKind.REJECTED: (122, 124, 128),
    PixelKind.NO_PLANE: (62, 64, 70),
    PixelKind.OWN_BODY: (128, 76, 100),
    PixelKind.OUT_OF_RANGE: (30, 36, 56),
    PixelKind.NO_DEPTH: (0, 0, 0),
}
_NAMES = {
    PixelKind.REGION: "region",
    PixelKind.REJECTED: "rejected",
    PixelKind.NO_PLANE: "on no plane",
    PixelKind.OWN_BODY: "own body",
    PixelKind.OUT_OF_RANGE: "out of range",
    PixelKind.NO_DEPTH: "no depth",
}
_INK, _PAPER, _PAGE = (14, 16, 20), (240, 242, 244), (24, 26, 30)
_GRID, _GRID_PITCH_MIN = 0.95, 6  # brightness of the patch grid's lines; finer grids are left out [px]
_HATCH, _HATCHED = 8, 0.6  # distance of the hatching's lines [px] and their brightness
_PART = 0.5  # brightness of the outlines of convex parts
_LIGHT = (0.4, 0.5, 0.8)  # the way of the light in the camera frame: from above and from the left
_AMBIENT = 0.55
_SMOOTH = 1.0 / 220.0  # half of the window over which the slant of the surface is taken, of the width
_LEGEND_WIDE = 72  # how many times wider than its text a legend must be for a single row
_TEXT_SHARE, _TEXT_MIN, _TEXT_MAX, _TEXT_WEIGHT = 1.0 / 46.0, 11, 18, 600  # of the width, [px]
_FRACTION_BITS = 4  # of a pixel, for smooth lines


def debug_image(extraction: RegionExtraction, stride: int = 1, colors: ArrayLike | None = None) -> Picture:
    """Draw an extraction over its depth image, with a legend below, uint8 RGB.

    Args:
        extraction: what was found.
        stride: draws every nth pixel of every nth row.
        colors: of the regions, (R, 3) RGB from 0 to 255; `region_colors` where None.

    Returns:
        Picture as wide as ceil(width / stride); its first ceil(height / stride) rows are the image, then the legend.
    """
    regions = extraction.regions.regions
    chosen = region_colors(len(regions)) if colors is None else np.asarray(colors, dtype=np.uint8).reshape(-1, 3)
    pieces = piece_of_pixels(extraction, stride)
    kinds = kind_of_pixels(extraction, pieces, stride)
    picture = _painted(kinds, pieces, chosen, _shade(extraction.image, stride))
    _draw_grid(picture, max(1, patch_size(extraction.image.camera, extraction.parameters) // stride))
    _draw_outlines(picture, extraction, chosen, stride)
    _write_labels(picture, extraction, pieces)
    return np.vstack((picture, _legend(extraction, kinds, chosen)))


def region_colors(count: int) -> NDArray[np.uint8]:
    """Colours of equal brightness whose hues are far apart from one to the next, (count, 3) RGB."""
    hue = (np.arange(count) * 0.5 * (5.0**0.5 - 1.0)) % 1.0 * 180.0
    hsv = np.column_stack((hue, np.full(count, 140.0), np.full(count, 245.0))).astype(np.uint8)
    return cv2.cvtColor(hsv[None], cv2.COLOR_HSV2RGB)[0].astype(np.uint8) if count else hsv


def _painted(kinds: Picture, pieces: NDArray[np.int16], colors: Picture, shade: Picture) -> Picture:
    of_kind = [_COLORS.get(kind, _PAPER) for kind in PixelKind]
    table = np.vstack((np.array(of_kind, dtype=np.uint8), colors))
    flat = table[np.where(pieces >= 0, pieces + len(PixelKind), kinds)]
    light = np.where(_hatching(kinds.shape) & (kinds == PixelKind.REJECTED), (_HATCHED * shade).astype(np.uint8), shade)
    return cv2.multiply(flat, cv2.cvtColor(light, cv2.COLOR_GRAY2RGB), scale=1.0 / 255.0).astype(np.uint8)


def _shade(image: DepthImage, stride: int) -> Picture:
    """How bright the measured surface is in slanting light, 0 to 255.

    The inverse depth of a plane is affine in the pixel, w = a x + b y + c, and (a, b, c) its normal away from the
    camera: smoothing takes noise away without bending planes.
    """
    camera = image.camera.scaled(1.0 / stride)
    depth = image.depth[::stride, ::stride]
    valid = np.isfinite(depth) & (depth > 0.0)
    inverse = np.divide(np.float32(1.0), depth, out=np.zeros_like(depth), where=valid)
    window = 2 * max(1, round(_SMOOTH * depth.shape[1])) + 1
    share = _blurred(valid.astype(np.float32), window)
    smooth = _blurred(inverse, window) / np.maximum(share, np.float32(1e-3))
    a = cv2.Sobel(smooth, cv2.CV_32F, 1, 0, scale=camera.fx / 8.0)
    b = cv2.Sobel(smooth, cv2.CV_32F, 0, 1, scale=camera.fy / 8.0)
    x = ((np.arange(depth.shape[1]) - camera.cx) / camera.fx).astype(np.float32)
    y = ((np.arange(depth.shape[0]) - camera.cy) / camera.fy).astype(np.float32)
    c = smooth - a * x - b * y[:, None]
    light = [np.float32(component / math.hypot(*_LIGHT)) for component in _LIGHT]
    lit = (a * light[0] + b * light[1] + c * light[2]) / np.maximum(cv2.magnitude(cv2.magnitude(a, b), c), 1e-6)
    return (255.0 * (_AMBIENT + (1.0 - _AMBIENT) * np.clip(lit, 0.0, 1.0))).astype(np.uint8)


def _blurred(values: NDArray[np.float32], window: int) -> NDArray[np.float32]:
    """Twice through a box: nearly a Gaussian, at the price of neither."""
    return cv2.blur(cv2.blur(values, (window, window)), (window, window)).astype(np.float32)


def _draw_grid(picture: Picture, pitch: int) -> None:
    if pitch >= _GRID_PITCH_MIN:
        for lines in (picture[::pitch], picture[:, ::pitch]):
            lines[:] = (_GRID * lines).astype(np.uint8)


def _draw_outlines(picture: Picture, extraction: RegionExtraction, colors: Picture, stride: int) -> None:
    """Outlines of regions and rejected pieces over those of convex parts."""
    regions = extraction.regions.regions
    homographies = [homography(extraction.image, region) for region in regions]
    for region, H, color in zip(regions, homographies, colors, strict=True):
        parts = [in_image(part, H) for part in region.convex_parts_region]
        _draw_loops(picture, parts, [int(_PART * c) for c in color], stride)
    outlines = [in_image(r.hull_region, H) for r, H in zip(regions, homographies, strict=True)]
    holes = [in_image(hole, H) for r, H in zip(regions, homographies, strict=True) for hole in r.holes_region]
    rejected = [piece.outline_image for piece in extraction.rejected]
    _draw_loops(picture, [*outlines, *holes, *rejected], _INK, stride)


def _draw_loops(picture: Picture, loops: Sequence[Array], color: Sequence[int], stride: int) -> None:
    fixed = [np.round(loop * (2**_FRACTION_BITS / stride)).astype(np.int32) for loop in loops]
    cv2.polylines(picture, fixed, True, color, 1, cv2.LINE_AA, _FRACTION_BITS)


def _write_labels(picture: Picture, extraction: RegionExtraction, pieces: NDArray[np.int16]) -> None:
    """The number of each region and the cause of each rejection, where they are widest and the text fits."""
    font, size = cv2.FontFace("sans"), _text_size(picture)
    borders = np.zeros(pieces.shape, dtype=np.uint8)
    borders[1:-1, 1:-1] = 1
    borders[:, 1:] &= pieces[:, 1:] == pieces[:, :-1]
    borders[1:] &= pieces[1:] == pieces[:-1]
    room = np.asarray(cv2.distanceTransform(borders, cv2.DIST_L2, 3), dtype=np.float32)
    for piece, (u, v) in _roomiest(pieces, room).items():
        text = str(piece) if piece >= 0 else extraction.rejected[-2 - piece].cause
        x, y, w, h = cv2.getTextSize((0, 0), text, (0, 0), font, size, _TEXT_WEIGHT)
        if room[v, u] >= 0.5 * max(0.7 * w, h):
            at = (round(u - x - 0.5 * w), round(v - y - 0.5 * h))
            cv2.putText(picture, text, at, _INK if piece >= 0 else _PAPER, font, size, _TEXT_WEIGHT)


def _roomiest(pieces: NDArray[np.int16], room: NDArray[np.float32]) -> dict[int, tuple[int, int]]:
    """Of each region and rejected piece the pixel (u, v) furthest from its border, every second one looked at."""
    pieces, room = pieces[::2, ::2], room[::2, ::2]
    most = np.zeros(int(pieces.max(initial=0)) - int(pieces.min(initial=0)) + 1, dtype=np.float32)
    np.maximum.at(most, pieces.ravel(), room.ravel())  # negative pieces count from the end
    v, u = np.nonzero((room == most[pieces]) & (pieces != -1))
    return {int(pieces[i, j]): (2 * int(j), 2 * int(i)) for i, j in zip(v, u, strict=True)}


def _legend(extraction: RegionExtraction, kinds: Picture, colors: Picture) -> Picture:
    """A strip as wide as the picture: what the tints mean, how much of the image each has, what was rejected why."""
    font, size, width = cv2.FontFace("sans"), _text_size(kinds), kinds.shape[1]
    shares = np.bincount(kinds.ravel(), minlength=len(PixelKind)) / max(kinds.size, 1)
    across = len(PixelKind) if width > _LEGEND_WIDE * size else (len(PixelKind) + 1) // 2
    rows = -(-len(PixelKind) // across)
    strip = np.full((2 * size * (rows + 1), width, 3), _PAGE, dtype=np.uint8)
    for slot, kind in enumerate(PixelKind):
        x, y = size // 2 + slot % across * width // across, size // 2 + slot // across * 2 * size
        box = strip[y : y + size + 2, x : x + 2 * size]
        box[:] = _COLORS[kind] if kind is not PixelKind.REGION else _stripes(box.shape[1], colors)
        if kind is PixelKind.REJECTED:
            box[_hatching(box.shape)] = [int(_HATCHED * c) for c in _COLORS[kind]]
        text = f"{_NAMES[kind]} {100.0 * shares[kind]:.0f}%"
        cv2.putText(strip, text, (x + 2 * size + size // 3, y + size), _PAPER, font, size, _TEXT_WEIGHT)
    causes = Counter(piece.cause for piece in extraction.rejected).most_common()
    told = ", ".join(f"{cause} {count}" for cause, count in causes)
    summary = f"{len(colors)} regions; {len(extraction.rejected)} rejected{': ' if causes else ''}{told}"
    cv2.putText(strip, summary, (size // 2, len(strip) - size // 2 - 1), _PAPER, font, size, _TEXT_WEIGHT)
    return strip


def _hatching(shape: tuple[int, ...]) -> NDArray[np.bool_]:
    lines = np.arange(shape[0] + shape[1]) % _HATCH < 2
    return np.lib.stride_tricks.sliding_window_view(lines, shape[1])[: shape[0]]


def _stripes(width: int, colors: Picture) -> Picture:
    """The first few colours side by side, (width, 3)."""
    shown = colors[:4] if len(colors) else np.array([_PAPER], dtype=np.uint8)
    return shown[np.arange(width) * len(shown) // width]


def _text_size(picture: Picture) -> int:
    return round(min(max(_TEXT_SHARE * picture.shape[1], _TEXT_MIN), _TEXT_MAX))
