"""Kernel that checks a whole way of footholds against every limit of a step, and sums up what it costs."""

from __future__ import annotations

import numpy as np

from skills.footsteps.level_steps import level_step_rejection
from skills.footsteps.path_progress import judge
from skills.footsteps.plane_raster import Raster
from skills.footsteps.records import Records
from skills.footsteps.rejections import FOOTHOLD
from skills.footsteps.step_cost import step_cost
from skills.geometry.pose import Array
from skills.kernels import kernel


@kernel
def check_way(
    raster: Raster,
    limits: Records,
    goal: Records,
    path: Array,
    field: Array,
    soles: Array,
    sign: float,
    stand: Records,
    ground: Records,
    node: Records,
) -> float:
    """Cost of some steps of a way; where one of them is not allowed, the reason as a negative number.

    Args:
        raster: as in `SearchSpace`.
        limits: as there.
        goal: as there.
        path: as there.
        field: as there.
        soles: (N + 2, 7) rows of x, y from the corner, z, yaw, slopes a and b, supported share: the swing foot and the
            stance foot before the first step, then the footholds of the steps.
        sign: +1 where the left foot makes the first step, -1 where the right one does.
        stand: one `STAND` to work on.
        ground: one `GROUND` to work on.
        node: one `NODE` to work on.
    """
    heading = np.empty(3)
    cost = 0.0
    ground.outcome = FOOTHOLD
    for k in range(soles.shape[0] - 2):
        side = sign if k % 2 == 0 else -sign
        start, support, landing = soles[k], soles[k + 1], soles[k + 2]
        stand.x, stand.y, stand.z = support[0], support[1], support[2]
        stand.cos, stand.sin = np.cos(support[3]), np.sin(support[3])
        stand.uphill = support[4] * stand.cos + support[5] * stand.sin
        stand.swing_x, stand.swing_y, stand.swing_z, stand.swing_yaw = start[0], start[1], start[2], start[3]
        dx, dy, turned = landing[0] - support[0], landing[1] - support[1], landing[3] - support[3]
        turned -= 2 * np.pi * np.floor((turned + np.pi) / (2 * np.pi))
        length, width = stand.cos * dx + stand.sin * dy, side * (stand.cos * dy - stand.sin * dx)
        reason = level_step_rejection(limits, length, width, side * turned)
        if reason > 0:
            return -float(reason)
        ground.z, ground.a, ground.b, ground.share = landing[2], landing[4], landing[5], landing[6]
        edge = step_cost(raster, limits, stand, landing[0], landing[1], landing[3], ground)
        if edge < 0.0:
            return edge
        heading[0], heading[1], heading[2] = landing[3], np.cos(landing[3]), np.sin(landing[3])
        judge(limits, goal, path, field, landing[0], landing[1], landing[2], heading, side, node)
        cost += edge + node.off_path_cost
    return cost
