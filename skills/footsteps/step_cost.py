"""What a step over rough ground costs, and why one is not allowed.

Limits and costs follow Griffin et al., "Footstep planning for autonomous walking over rough terrain" (2019).
"""

from __future__ import annotations

import numpy as np

from skills.footsteps.level_steps import ROUNDING
from skills.footsteps.plane_raster import Raster
from skills.footsteps.records import Records
from skills.footsteps.rejections import (
    BODY_AT,
    BODY_WAY,
    FAR_DOWN,
    FAR_UP,
    FOOTHOLD,
    IN_PLACE,
    SWING_HIGH,
    SWING_LONG,
    TOO_HIGH,
    TOO_LOW,
    UPHILL,
    WALL_UNDER,
)
from skills.footsteps.walls import body_clear, near_top, wall_on_way, way_clear
from skills.kernels import kernel


@kernel
def step_cost(
    raster: Raster, limits: Records, stand: Records, x: float, y: float, yaw: float, ground: Records
) -> float:
    """Cost of a step but for being off the path; where it is not allowed, the reason as a negative number."""
    if ground.outcome != FOOTHOLD:
        return -float(ground.outcome)
    length = stand.cos * (x - stand.x) + stand.sin * (y - stand.y)
    width = abs(stand.cos * (y - stand.y) - stand.sin * (x - stand.x))
    rise = ground.z - stand.z
    off_width = width - limits.ideal_width
    reach = np.sqrt(length * length + off_width * off_width)
    moved = np.sqrt((x - stand.swing_x) ** 2 + (y - stand.swing_y) ** 2)
    if rise > limits.max_step_height + ROUNDING:
        return -float(TOO_HIGH)
    if rise < -limits.max_step_height - ROUNDING:
        return -float(TOO_LOW)
    if rise > limits.reach_up_height + ROUNDING and reach > limits.reach_up + ROUNDING:
        return -float(FAR_UP)
    if rise < -limits.reach_down_height - ROUNDING and reach > limits.reach_down + ROUNDING:
        return -float(FAR_DOWN)
    if rise < -limits.uphill_drop - ROUNDING and stand.uphill > limits.uphill_tangent + ROUNDING:
        return -float(UPHILL)
    if moved < limits.in_place - ROUNDING and np.cos(yaw - stand.swing_yaw) > np.cos(0.5 * limits.heading):
        return -float(IN_PLACE)
    if moved > limits.swing_reach + ROUNDING:
        return -float(SWING_LONG)
    if abs(ground.z - stand.swing_z) > limits.swing_height_change + ROUNDING:
        return -float(SWING_HIGH)
    hindered = _hindered(raster, limits, stand, x, y, ground.z)
    if hindered > 0:
        return -float(hindered)
    return (
        limits.step_cost
        + limits.height_cost * abs(rise)
        + limits.tilt_cost * np.sqrt(ground.a * ground.a + ground.b * ground.b)
        + limits.width_cost * abs(off_width)
        + limits.share_cost * (1.0 - ground.share)
    )


@kernel
def _hindered(raster: Raster, limits: Records, stand: Records, x: float, y: float, z: float) -> int:
    """The reason for which walls and high ground do not allow a step; 0 where they do.

    The body is midway between the feet and looks where the stance foot does.
    """
    body_x, body_y, height = 0.5 * (x + stand.x), 0.5 * (y + stand.y), 0.5 * (z + stand.z)
    if raster.walls.shape[0] == 0 and raster.top < height + limits.body_base:
        return 0
    higher = max(z, stand.swing_z)
    # Looks at the ends and the middle of the swing reach over all of it.
    near = max(near_top(raster, x, y), near_top(raster, stand.swing_x, stand.swing_y))
    near = max(near, near_top(raster, 0.5 * (x + stand.swing_x), 0.5 * (y + stand.swing_y)))
    high = near > higher + limits.step_over
    if high and wall_on_way(raster, stand.swing_x, stand.swing_y, x, y, higher, limits.step_over):
        return WALL_UNDER
    before_x, before_y = 0.5 * (stand.swing_x + stand.x), 0.5 * (stand.swing_y + stand.y)
    for part in (1.0, 0.5):
        middle_x, middle_y = before_x + part * (body_x - before_x), before_y + part * (body_y - before_y)
        if not body_clear(raster, limits, middle_x, middle_y, height, stand.cos, stand.sin):
            return BODY_AT
    high = near_top(raster, body_x, body_y) >= height + limits.body_base
    if high and not way_clear(raster, limits, before_x, before_y, body_x, body_y, height):
        return BODY_WAY
    return 0
