"""Steps that a foot may make on level ground, as offsets on the lattice: what depends on the two soles alone.

Limits follow Griffin et al., "Footstep planning for autonomous walking over rough terrain" (2019).
"""

from __future__ import annotations

from math import ceil, sqrt

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.footstep_parameters import FootstepParameters
from skills.footsteps.records import Records
from skills.footsteps.rejections import (
    OUTSIDE,
    SOLES_NEAR,
    TOO_FAR,
    TOO_FAR_BACK,
    TOO_NARROW,
    TOO_WIDE,
    TURNED,
)
from skills.geometry.pose import Array
from skills.kernels import kernel

# A step right at a limit is within it, in whatever way its place was computed.
ROUNDING = 1e-10


def most_level_steps(parameters: FootstepParameters) -> int:
    """Upper bound of the number of steps from one stance."""
    # Cells that touch a rectangle, however it is turned, lie in the one that is larger by a cell's diagonal all around.
    around = 2 * sqrt(2.0) * parameters.lattice
    length = parameters.reach + parameters.back_reach + around
    width = parameters.maximum_width - parameters.minimum_width + around
    turns = int((parameters.inward_yaw + parameters.outward_yaw + 4e-9) / (2 * np.pi / parameters.headings)) + 1
    return ceil(length * width / parameters.lattice**2) * turns


@kernel
def fill_level_steps(
    limits: Records,
    headings: Array,
    yaw: float,
    nearest: int,
    sign: float,
    steps: NDArray[np.int64],
    rejections: NDArray[np.int64],
) -> int:
    """List the steps that a foot on the side `sign` may make on level ground from a stance foot turned by `yaw`.

    `nearest` is the lattice's heading next to it; `headings` ends with two that are not the lattice's. Rows of lattice
    offsets in x and y and heading; returns how many. All other offsets within reach on any side are counted in
    `rejections` by reason.
    """
    count_headings = headings.shape[0] - 2
    cos, sin = np.cos(yaw), np.sin(yaw)
    most = int(np.ceil((limits.reach + limits.maximum_width) / limits.lattice))
    turns = int(max(limits.inward_yaw, limits.outward_yaw) / limits.heading + 0.5 + 1e-9)
    whole = count_headings * limits.heading > 2 * np.pi - 1e-9
    count = 0
    for j in range(-most, most + 1):
        for i in range(-most, most + 1):
            dx, dy = i * limits.lattice, j * limits.lattice
            length, width = cos * dx + sin * dy, sign * (cos * dy - sin * dx)
            reason = _out_of_reach(limits, length, width)
            if reason > 0:
                rejections[reason] += 2 * turns + 1
                continue
            for k in range(-turns, turns + 1):
                if not whole and (nearest + k < 0 or nearest + k >= count_headings):
                    rejections[OUTSIDE] += 1
                    continue
                heading = (nearest + k) % count_headings
                turned = headings[heading, 0] - yaw
                turned -= 2 * np.pi * np.floor((turned + np.pi) / (2 * np.pi))
                reason = level_step_rejection(limits, length, width, sign * turned)
                if reason > 0:
                    rejections[reason] += 1
                    continue
                steps[count, 0], steps[count, 1], steps[count, 2] = i, j, heading
                count += 1
    return count


@kernel
def level_step_rejection(limits: Records, length: float, width: float, outward: float) -> int:
    """Why a foot must not land at length and width from a stance foot, in its frame, turned outward; 0 where it may."""
    reason = _out_of_reach(limits, length, width)
    if reason > 0:
        return reason
    if outward < -limits.inward_yaw - ROUNDING or outward > limits.outward_yaw + ROUNDING:
        return TURNED
    return 0 if _soles_clear(limits, length, width, outward) else SOLES_NEAR


@kernel
def _out_of_reach(limits: Records, length: float, width: float) -> int:
    if length < -limits.back_reach - ROUNDING:
        return TOO_FAR_BACK
    if width < limits.minimum_width - ROUNDING:
        return TOO_NARROW
    if width > limits.maximum_width + ROUNDING:
        return TOO_WIDE
    return TOO_FAR if np.hypot(length, width - limits.ideal_width) > limits.reach + ROUNDING else 0


@kernel
def _soles_clear(limits: Records, length: float, width: float, outward: float) -> bool:
    """Whether two soles, the second at length, width, outward from the first, keep their gap (separating axes)."""
    cos, sin = np.cos(outward), np.sin(outward)
    along = limits.half_length * (1 + abs(cos)) + limits.half_width * abs(sin) + limits.sole_gap - ROUNDING
    across = limits.half_width * (1 + abs(cos)) + limits.half_length * abs(sin) + limits.sole_gap - ROUNDING
    turned_length, turned_width = cos * length + sin * width, cos * width - sin * length
    return max(abs(length), abs(turned_length)) >= along or max(abs(width), abs(turned_width)) >= across
