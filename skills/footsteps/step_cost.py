"""What a step over rough ground costs, and why one is not allowed.

Limits and costs follow Griffin et al., "Footstep planning for autonomous walking over rough terrain" (2019).
"""

from __future__ import annotations

import numpy as np

from skills.footsteps.plane_raster import FOOTHOLD, SNAP_REASONS
from skills.footsteps.search_space import Records
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
    "outside the searched ground",
)
_TOO_HIGH, _TOO_LOW, _FAR_UP, _FAR_DOWN, _UPHILL, _SWING_LONG, _SWING_HIGH, OUTSIDE = range(
    len(SNAP_REASONS), len(REASONS)
)


@kernel
def step_cost(limits: Records, reference: Array, stand: Records, x: float, y: float, ground: Records) -> float:
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
