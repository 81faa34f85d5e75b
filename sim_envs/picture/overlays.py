"""Flat things drawn onto a scene: planned soles, outlines of regions, and lines through the air."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import cv2
import numpy as np
from numpy.typing import ArrayLike, NDArray

from skills.footsteps.footstep import Footstep, Side
from skills.geometry.camera import PinholeCamera
from skills.geometry.pose import Array, Pose
from skills.regions.planar_region import PlanarRegion

Color = tuple[float, float, float]

_LENS = 0.05  # nothing nearer than this is drawn [m]
_SUBPIXEL_BITS = 4
_LEFT_COLOR: Color = (0.90, 0.30, 0.20)
_RIGHT_COLOR: Color = (0.16, 0.45, 0.86)
_SOLE_RIM = 0.012  # width of the line around a planned sole [m]
_REGION_LINE = 0.012  # width of the line around a region [m]


@dataclass(frozen=True, slots=True, eq=False)
class Overlay:
    """Flat polygons of one colour, drawn as one layer.

    Attributes:
        polygons_world: planar polygons, each (N, 3) [m].
        color: red, green, blue as screens take them, 0..1.
        opacity: 0..1.
    """

    polygons_world: tuple[Array, ...]
    color: Color
    opacity: float


def line(points_world: ArrayLike, color: Color, *, width: float, seen_from: ArrayLike, opacity: float = 1.0) -> Overlay:
    """A line through the air, as a ribbon that faces the viewer.

    Args:
        points_world: corners of the line, (N, 3) [m].
        color: red, green, blue, 0..1.
        width: of the ribbon [m].
        seen_from: position of the viewer, (3,) [m].
        opacity: 0..1.
    """
    points = np.asarray(points_world, dtype=np.float64)
    sights = points - np.asarray(seen_from, dtype=np.float64)
    along = np.gradient(points, axis=0)
    side = np.cross(along, sights)
    side *= 0.5 * width / np.maximum(np.linalg.norm(side, axis=1, keepdims=True), 1e-12)
    return Overlay(_ribbon(points - side, points + side), color, opacity)


def outline(polygon_world: ArrayLike, color: Color, *, width: float, opacity: float = 1.0) -> Overlay:
    """The rim of a planar polygon (N, 3) as a line of the given width inside it [m]."""
    corners = np.asarray(polygon_world, dtype=np.float64)
    ring = np.vstack((corners, corners[:1]))
    after = np.roll(corners, -1, axis=0)
    normal = np.cross(corners, after).sum(axis=0)
    inward = np.cross(normal, after - corners)
    inward /= np.maximum(np.linalg.norm(inward, axis=1, keepdims=True), 1e-12)
    strips = [np.array([a, b, b + width * n, a + width * n]) for a, b, n in zip(ring, after, inward, strict=False)]
    return Overlay(tuple(strips), color, opacity)


def planned_steps(steps: Iterable[Footstep], *, opacity: float = 0.75) -> tuple[Overlay, ...]:
    """Translucent soles with a solid rim, in the colour of their side, fading along the plan."""
    overlays: list[Overlay] = []
    for k, step in enumerate(steps):
        color = _LEFT_COLOR if step.side is Side.LEFT else _RIGHT_COLOR
        strength = max(0.35, 1.0 - 0.12 * k)
        sole = step.T_world_sole @ np.column_stack((step.foothold_sole, np.zeros(len(step.foothold_sole))))
        overlays.append(Overlay((sole,), color, opacity * strength))
        overlays.append(outline(sole, color, width=_SOLE_RIM, opacity=strength))
    return tuple(overlays)


def region_outlines(
    regions: Sequence[PlanarRegion], colors: Sequence[Color], *, fill: float = 0.18
) -> tuple[Overlay, ...]:
    """Outlines of planar regions over a faint fill; colors are used in turn."""
    overlays: list[Overlay] = []
    for k, region in enumerate(regions):
        color = colors[k % len(colors)]
        overlays.append(Overlay((region.hull_world,), color, fill))
        overlays.append(outline(region.hull_world, color, width=_REGION_LINE, opacity=0.9))
    return tuple(overlays)


@dataclass(frozen=True, slots=True, eq=False)
class Layer:
    """An overlay as it falls into an image.

    Attributes:
        pixels: index into the flattened image, (N,).
        cover: opacity of each, (N,) float32.
        depth: of the overlay there, (N,) float32 [m].
    """

    pixels: NDArray[np.int64]
    cover: NDArray[np.float32]
    depth: NDArray[np.float32]


def project(overlay: Overlay, camera: PinholeCamera, T_world_camera: Pose) -> Layer:
    """Find the pixels of an overlay, and its depth in each; what lies behind the lens is left out."""
    cover = np.zeros((camera.height, camera.width), dtype=np.uint8)
    depth = np.zeros((camera.height, camera.width), dtype=np.float32)
    T_camera_world = T_world_camera.inverse
    for polygon in overlay.polygons_world:
        corners = _cut_at_lens(T_camera_world @ polygon)
        if len(corners) >= 3:
            _draw(corners, camera, cover, depth)
    pixels = np.flatnonzero(cover)
    share = cover.reshape(-1)[pixels].astype(np.float32) * np.float32(overlay.opacity / 255)
    return Layer(pixels, share, depth.reshape(-1)[pixels])


def _draw(corners: Array, camera: PinholeCamera, cover: NDArray[np.uint8], depth: NDArray[np.float32]) -> None:
    u = camera.cx + camera.fx * corners[:, 0] / corners[:, 2]
    v = camera.cy + camera.fy * corners[:, 1] / corners[:, 2]
    left, top = max(int(u.min()) - 1, 0), max(int(v.min()) - 1, 0)
    right, bottom = min(int(u.max()) + 3, camera.width), min(int(v.max()) + 3, camera.height)
    if left >= right or top >= bottom:
        return
    patch = np.zeros((bottom - top, right - left), dtype=np.uint8)
    fixed = np.round(np.column_stack((u - left, v - top)) * (1 << _SUBPIXEL_BITS)).astype(np.int32)
    cv2.fillPoly(patch, [fixed], (255,), lineType=cv2.LINE_AA, shift=_SUBPIXEL_BITS)
    normal = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)  # Newell's normal of a planar polygon
    offset = normal @ corners.mean(axis=0)
    if abs(offset) < 1e-12:
        return
    rows, columns = np.nonzero(patch)
    rays = np.column_stack(
        ((columns + left - camera.cx) / camera.fx, (rows + top - camera.cy) / camera.fy, np.ones(len(rows)))
    )
    inverse = np.clip(rays @ normal / offset, 1 / corners[:, 2].max(), 1 / corners[:, 2].min())
    depth[top:bottom, left:right][rows, columns] = 1 / inverse
    window = cover[top:bottom, left:right]
    np.maximum(window, patch, out=window)


def _cut_at_lens(corners: Array) -> Array:
    kept: list[Array] = []
    for here, after in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        if here[2] >= _LENS:
            kept.append(here)
        if (here[2] >= _LENS) != (after[2] >= _LENS):
            kept.append(here + (after - here) * (_LENS - here[2]) / (after[2] - here[2]))
    return np.array(kept).reshape(-1, 3)


def _ribbon(one_side: Array, other_side: Array) -> tuple[Array, ...]:
    return tuple(
        np.array([one_side[k], one_side[k + 1], other_side[k + 1], other_side[k]]) for k in range(len(one_side) - 1)
    )
