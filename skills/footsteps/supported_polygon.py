"""The part of a sole that carries: the sole's outline clipped exactly by the regions that lie flush under it."""

from __future__ import annotations

from collections.abc import Iterable
from functools import lru_cache

import numpy as np

from skills.footsteps.footstep_parameters import FootstepParameters
from skills.geometry.polygon import clip_convex, clip_half_plane, convex_hull
from skills.geometry.pose import Array, Pose, readonly
from skills.regions.planar_region import PlanarRegion


@lru_cache(maxsize=8)
def whole_sole(parameters: FootstepParameters) -> Array:
    """The sole's outline in its frame, (4, 2) counter-clockwise, read-only [m]."""
    x, y = 0.5 * parameters.sole_length, 0.5 * parameters.sole_width
    return readonly(((-x, -y), (x, -y), (x, y), (-x, y)))


def supported_polygon(T_world_sole: Pose, regions: Iterable[PlanarRegion], parameters: FootstepParameters) -> Array:
    """Convex hull of what regions carry of a sole, (N, 2) in the sole frame, counter-clockwise [m].

    Ground carries where it is no further above or below the sole's plane than the parameters say.
    """
    sole = whole_sole(parameters)
    pieces = [piece for region in regions for piece in _pieces(T_world_sole, sole, region, parameters)]
    return convex_hull(np.concatenate(pieces)) if pieces else np.zeros((0, 2))


def _pieces(T_world_sole: Pose, sole: Array, region: PlanarRegion, parameters: FootstepParameters) -> list[Array]:
    """The convex parts of a region within a sole, where they are flush with it."""
    R, p = T_world_sole.R, T_world_sole.p
    normal, origin = region.normal_world, region.T_world_region.p
    # Height of the region over the sole's plane, as a function of the place on the sole.
    over = [float(-(normal @ (p - origin)) / normal[2])]
    over += [float(-(normal @ axis) / normal[2]) for axis in (R[:, 0], R[:, 1])]
    pieces = []
    for part in region.convex_parts_region:
        if len(part) < 3:
            continue
        points = region.T_world_region @ np.column_stack((part, np.zeros(len(part))))
        # Straight down or up onto the sole's plane.
        drop = ((points - p) @ R[:, 2]) / R[2, 2]
        points[:, 2] -= drop
        on_sole = (points - p) @ R[:, :2]
        piece = clip_convex(np.ascontiguousarray(on_sole), sole)
        if len(piece) >= 3:
            piece = clip_half_plane(piece, over[1], over[2], parameters.ground_above - over[0])
        if len(piece) >= 3:
            piece = clip_half_plane(piece, -over[1], -over[2], parameters.support_below + over[0])
        if len(piece) >= 3:
            pieces.append(piece)
    return pieces
