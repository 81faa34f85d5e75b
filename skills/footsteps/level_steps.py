"""Steps that a foot may make on level ground, as offsets on the lattice: what depends on the two soles alone.

Limits follow Griffin et al., "Footstep planning for autonomous walking over rough terrain" (2019).
"""

from __future__ import annotations

from math import ceil

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.footstep_parameters import FootstepParameters
from skills.footsteps.records import Records
from skills.geometry.pose import Array
from skills.kernels import kernel


def most_level_steps(parameters: FootstepParameters) -> int:
    """Upper bound of the number of steps from one stance."""
    side = 2 * ceil((parameters.reach + parameters.maximum_width) / parameters.lattice) + 1
    turns = int((parameters.inward_yaw + parameters.outward_yaw + 2e-9) / (2 * np.pi / parameters.headings)) + 1
    return side * side * turns


@kernel
def fill_level_steps(limits: Records, headings: Array, heading: int, sign: float, steps: NDArray[np.int64]) -> int:
    """List the steps that a foot on the side `sign` may make on level ground from a stance foot of a heading.

    Rows of lattice offsets in x and y and heading; returns how many.
    """
    count_headings = headings.shape[0] - 1
    cos, sin = headings[heading, 1], headings[heading, 2]
    most = int(np.ceil((limits.reach + limits.maximum_width) / limits.lattice))
    turns = int(max(limits.inward_yaw, limits.outward_yaw) / limits.heading + 1e-9)
    whole = count_headings * limits.heading > 2 * np.pi - 1e-9
    count = 0
    for j in range(-most, most + 1):
        for i in range(-most, most + 1):
            dx, dy = i * limits.lattice, j * limits.lattice
            length, width = cos * dx + sin * dy, sign * (cos * dy - sin * dx)
            if not _within_reach(limits, length, width):
                continue
            for k in range(-turns, turns + 1):
                if not whole and (heading + k < 0 or heading + k >= count_headings):
                    continue
                if level_step_allowed(limits, length, width, sign * k * limits.heading):
                    steps[count, 0], steps[count, 1], steps[count, 2] = i, j, (heading + k) % count_headings
                    count += 1
    return count


@kernel
def level_step_allowed(limits: Records, length: float, width: float, outward: float) -> bool:
    """Whether a foot may land at length and width from a stance foot, seen in its frame, and turned outward."""
    if not _within_reach(limits, length, width):
        return False
    if outward < -limits.inward_yaw - 1e-9 or outward > limits.outward_yaw + 1e-9:
        return False
    return _soles_clear(limits, length, width, outward)


@kernel
def _within_reach(limits: Records, length: float, width: float) -> bool:
    if length < -limits.back_reach or np.hypot(length, width - limits.ideal_width) > limits.reach:
        return False
    return limits.minimum_width <= width <= limits.maximum_width


@kernel
def _soles_clear(limits: Records, length: float, width: float, outward: float) -> bool:
    """Whether two soles, the second at length, width, outward from the first, keep their gap (separating axes)."""
    cos, sin = np.cos(outward), np.sin(outward)
    along = limits.half_length * (1 + abs(cos)) + limits.half_width * abs(sin) + limits.sole_gap
    across = limits.half_width * (1 + abs(cos)) + limits.half_length * abs(sin) + limits.sole_gap
    turned_length, turned_width = cos * length + sin * width, cos * width - sin * length
    return max(abs(length), abs(turned_length)) >= along or max(abs(width), abs(turned_width)) >= across
