"""What a step over rough ground costs, and why one is not allowed.

Limits and costs follow Griffin et al., "Footstep planning for autonomous walking over rough terrain" (2019).
"""

from __future__ import annotations

import numpy as np

from skills.footsteps.plane_raster import Raster
from skills.footsteps.records import Records
from skills.footsteps.sole_snap import FOOTHOLD, SNAP_REASONS
from skills.footsteps.walls import body_clear, wall_on_way, way_clear
from skills.geometry.pose import Array
from skills.kernels import kernel

REASONS = (
    *SNAP_REASONS,
    "step too high",
    "step too low",
    "too far for a step up",
    "too far for a step down",
    "step down off a foot that stands uphill",
    "swing too long",
    "swing too high",
    "wall under the swing",
    "body at a wall",
    "wall across the body's way",
    "outside the searched ground",
)
(
    _TOO_HIGH,
    _TOO_LOW,
    _FAR_UP,
    _FAR_DOWN,
    _UPHILL,
    _SWING_LONG,
    _SWING_HIGH,
    _WALL_UNDER,
    _BODY_AT_WALL,
    _WALL_ACROSS,
    OUTSIDE,
) = range(len(SNAP_REASONS), len(REASONS))


@kernel
def step_cost(
    raster: Raster, limits: Records, reference: Array, stand: Records, x: float, y: float, ground: Records
) -> float:
    """Cost of a step but for being off the path; where it is not allowed, the reason as a negative number."""
    if ground.outcome != FOOTHOLD:
        return -float(ground.outcome)
    length = stand.cos * (x - stand.x) + stand.sin * (y - stand.y)
    width = abs(stand.cos * (y - stand.y) - stand.sin * (x - stand.x))
    rise = ground.z - stand.z
    reach = np.hypot(length, width - limits.ideal_width)
    if rise > limits.height_change:
        return -float(_TOO_HIGH)
    if rise < -limits.height_change:
        return -float(_TOO_LOW)
    if rise > limits.reach_up_height and reach > limits.reach_up:
        return -float(_FAR_UP)
    if rise < -limits.reach_down_height and reach > limits.reach_down:
        return -float(_FAR_DOWN)
    if rise < -limits.uphill_drop and stand.uphill > limits.uphill_tangent:
        return -float(_UPHILL)
    if np.hypot(x - stand.swing_x, y - stand.swing_y) > limits.swing_reach:
        return -float(_SWING_LONG)
    if abs(ground.z - stand.swing_z) > limits.swing_height_change:
        return -float(_SWING_HIGH)
    if raster.walls.shape[0] > 0:
        hindered = _hindered(raster, limits, stand, x, y, ground.z)
        if hindered > 0:
            return -float(hindered)
    cost = (
        limits.step_cost
        + limits.height_cost * abs(rise)
        + limits.tilt_cost * np.hypot(ground.a, ground.b)
        + limits.width_cost * abs(width - limits.ideal_width)
        + limits.share_cost * (1.0 - ground.share)
    )
    if stand.depth < reference.shape[0] and np.isfinite(reference[stand.depth, 0]):
        off_x, off_y = x - reference[stand.depth, 0], y - reference[stand.depth, 1]
        cost += limits.reference_cost * np.hypot(off_x, off_y)
    return cost


@kernel
def _hindered(raster: Raster, limits: Records, stand: Records, x: float, y: float, z: float) -> int:
    """The reason for which walls do not allow a step; 0 where they do.

    The body is midway between the feet and looks where the stance foot does.
    """
    higher = max(z, stand.swing_z)
    if wall_on_way(raster, stand.swing_x, stand.swing_y, x, y, higher, limits.step_over):
        return _WALL_UNDER
    body_x, body_y, height = 0.5 * (x + stand.x), 0.5 * (y + stand.y), 0.5 * (z + stand.z)
    before_x, before_y = 0.5 * (stand.swing_x + stand.x), 0.5 * (stand.swing_y + stand.y)
    for part in (1.0, 0.5):
        middle_x, middle_y = before_x + part * (body_x - before_x), before_y + part * (body_y - before_y)
        if not body_clear(raster, limits, middle_x, middle_y, height, stand.cos, stand.sin):
            return _BODY_AT_WALL
    if not way_clear(raster, limits, before_x, before_y, body_x, body_y, height):
        return _WALL_ACROSS
    return 0
