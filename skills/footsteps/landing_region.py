"""Where else a step may land: the places around its foothold at which the whole sole lies on the same region.

Walking keeps its balance after a push by landing elsewhere; this is how far the ground lets it.
"""

from __future__ import annotations

import numpy as np

from skills.footsteps.footstep_parameters import FootstepParameters
from skills.footsteps.terrain import Terrain
from skills.geometry.polygon import clip_half_plane, contains_point
from skills.geometry.pose import Array, Pose

_MOST_CORNERS = 8
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
            return _shrunk(outline, parameters)
    return _NOWHERE


def _shrunk(outline: Array, parameters: FootstepParameters) -> Array:
    move = parameters.landing_move
    places = move * np.array(((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)))
    half = 0.5 * np.array((parameters.sole_length, parameters.sole_width))
    for corner, span in zip(outline, np.roll(outline, -1, axis=0) - outline, strict=True):
        length = float(np.hypot(span[0], span[1]))
        if length < 1e-6 or not len(places):
            continue
        a, b = span[1] / length, -span[0] / length
        reach = abs(a) * half[0] + abs(b) * half[1] + parameters.landing_margin
        places = clip_half_plane(places, float(a), float(b), float(a * corner[0] + b * corner[1] - reach))
    if not len(places) or not contains_point(places, 0.0, 0.0):
        return _NOWHERE
    # Fewer corners of a convex polygon lie within it.
    chosen = np.unique(np.linspace(0, len(places) - 1, min(len(places), _MOST_CORNERS)).astype(int))
    return places[chosen]
