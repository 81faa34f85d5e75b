"""Where else a step may land: the places around its foothold at which the whole sole lies on the same region.

Walking keeps its balance after a push by landing elsewhere; this is how far the ground lets it.
"""

from __future__ import annotations

import numpy as np

from skills.footsteps.footstep_parameters import FootstepParameters
from skills.footsteps.terrain import Terrain
from skills.geometry.polygon import clip_half_plane, contains_point
from skills.geometry.pose import Array, Pose
from skills.kernels import kernel

_MOST_CORNERS = 8
_SHORTEST = 1e-6  # edges shorter than this have no direction [m]
_NOWHERE = np.zeros((0, 2))


def landing_region(terrain: Terrain, T_world_sole: Pose, parameters: FootstepParameters) -> Array:
    """Places of the sole's centre in its own plane and frame, (N, 2) convex and counter-clockwise [m].

    They lie within one convex part of the foothold's region, shrunk by the sole and a margin; empty where the planned
    place itself does not.
    """
    region = terrain.region(T_world_sole.p)
    if region is None:
        return _NOWHERE
    T_sole_region = T_world_sole.inverse @ region.T_world_region
    for part in region.convex_parts_region:
        outline = part @ T_sole_region.R[:2, :2].T + T_sole_region.p[:2]
        if contains_point(outline, 0.0, 0.0):
            half_length, half_width = 0.5 * parameters.sole_length, 0.5 * parameters.sole_width
            return _shrunk(outline, parameters.landing_move, half_length, half_width, parameters.landing_margin)
    return _NOWHERE


@kernel
def _shrunk(outline: Array, move: float, half_length: float, half_width: float, margin: float) -> Array:
    """Places within a square about the origin where a sole of these half sizes keeps a margin inside an outline."""
    places = np.array(((-move, -move), (move, -move), (move, move), (-move, move)))
    for i in range(outline.shape[0]):
        j = i + 1 if i + 1 < outline.shape[0] else 0
        dx, dy = outline[j, 0] - outline[i, 0], outline[j, 1] - outline[i, 1]
        length = np.sqrt(dx * dx + dy * dy)
        if length < _SHORTEST or places.shape[0] == 0:
            continue
        a, b = dy / length, -dx / length
        reach = abs(a) * half_length + abs(b) * half_width + margin
        places = clip_half_plane(places, a, b, a * outline[i, 0] + b * outline[i, 1] - reach)
    if places.shape[0] == 0 or not contains_point(places, 0.0, 0.0):
        return np.empty((0, 2))
    # Fewer corners of a convex polygon lie within it.
    count = min(places.shape[0], _MOST_CORNERS)
    fewer = np.empty((count, 2))
    for k in range(count):
        fewer[k] = places[k * (places.shape[0] - 1) // (count - 1)]
    return fewer
