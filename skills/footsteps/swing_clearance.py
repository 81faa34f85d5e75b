"""Swing clearance: the way of a foot over the ground between two footholds, as two waypoints.

The level sole is swept from lift-off to landing; the foot rises to the first waypoint, crosses at one height above all
ground under the way, and comes down from the second. Where the ground near lift-off is high it rises first and then
moves; where the ground near landing is high it arrives first and then descends. While it rises the sole turns level,
while it descends it turns into the plane of the foothold, both in proportion to the way; on the legs clearance is
checked with that tilt.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.footstep_parameters import FootstepParameters
from skills.footsteps.path_progress import wrapped
from skills.footsteps.plane_raster import Raster
from skills.footsteps.records import Records
from skills.footsteps.sole_snap import sweep_soles
from skills.footsteps.terrain import Terrain, pack, slopes
from skills.geometry.pose import Array, Pose, readonly
from skills.kernels import kernel

# Distances between the soles that are held over the ground, in cells: a sole is many of them long.
_CROSSING, _LEG = 4.0, 2.0
# Fields are named after the parameters.
_LIMITS = np.dtype(
    [
        (name, np.float64)
        for name in (
            *("half_length", "half_width", "swing_margin", "swing_clearance", "swing_height", "swing_lead"),
            *("swing_leg_clearance", "ground_above"),
            *("lift_off_zone", "lift_off_obstacle", "landing_zone", "landing_obstacle"),
        )
    ]
)


@dataclass(frozen=True, slots=True, eq=False)
class SwingClearance:
    """A way for a foot that clears the ground.

    Attributes:
        height: how far the sole's centre rises above the higher end of its way [m].
        waypoints_world: the sole's centre where it starts and where it stops crossing, (2, 3) [m].
    """

    height: float
    waypoints_world: Array


def swing_clearance(
    terrain: Terrain, T_world_start: Pose, T_world_end: Pose, parameters: FootstepParameters
) -> SwingClearance:
    """Find the way of a foot between two footholds that clears the ground by the parameters' margin."""
    waypoints = np.empty((2, 3))
    height = _clear_way(
        terrain.raster, terrain.corner_world, _row(T_world_start), _row(T_world_end), _limits(parameters), waypoints
    )
    return SwingClearance(height, readonly(waypoints))


@lru_cache(maxsize=8)
def _limits(parameters: FootstepParameters) -> NDArray[np.void]:
    half = {"half_length": 0.5 * parameters.sole_length, "half_width": 0.5 * parameters.sole_width}
    return pack(_LIMITS, parameters, half)


def _row(T_world_sole: Pose) -> Array:
    """A sole as `sweep_soles` takes it."""
    return np.array((*T_world_sole.p, T_world_sole.yaw, *slopes(T_world_sole)))


@kernel
def _clear_way(raster: Raster, corner: Array, start: Array, end: Array, limits: Records, waypoints: Array) -> float:
    """Fill in the waypoints of a way between two soles; its height above the higher of them."""
    p = limits[0]
    higher = max(start[2], end[2])
    length = np.sqrt((end[0] - start[0]) ** 2 + (end[1] - start[1]) ** 2)
    soles = _crossing(start, end, higher, 2 + int(length / (_CROSSING * raster.resolution)))
    clearances = np.empty(soles.shape[0])
    half_length, half_width = p.half_length + p.swing_margin, p.half_width + p.swing_margin
    sweep_soles(raster, corner, half_length, half_width, soles, clearances)
    highest, near_start, near_end = -np.inf, -np.inf, -np.inf
    for k in range(soles.shape[0]):
        ground, travelled = higher - clearances[k], length * k / (soles.shape[0] - 1)
        highest = max(highest, ground)
        if travelled <= p.lift_off_zone:
            near_start = max(near_start, ground)
        if length - travelled <= p.landing_zone:
            near_end = max(near_end, ground)
    apex = max(highest + p.swing_clearance, higher + p.swing_height)
    up_first = near_start - start[2] > p.lift_off_obstacle
    forward_first = near_end - end[2] > p.landing_obstacle
    _corner(raster, corner, start, end, apex, up_first, limits, waypoints[0])
    _corner(raster, corner, end, start, apex, forward_first, limits, waypoints[1])
    return apex - higher


@kernel
def _corner(
    raster: Raster,
    corner: Array,
    near: Array,
    far: Array,
    apex: float,
    vertical: bool,
    limits: Records,
    waypoint: Array,
) -> None:
    """Where the leg from a foothold to the height of the crossing ends; right above it where no other clears."""
    p = limits[0]
    for k in range(0 if vertical else 2):
        lead = p.swing_lead / (1.0 + k)
        waypoint[0], waypoint[1] = near[0] + lead * (far[0] - near[0]), near[1] + lead * (far[1] - near[1])
        waypoint[2] = apex
        leg = _leg(near, far, waypoint, _LEG * raster.resolution)
        clearances = np.empty(leg.shape[0])
        sweep_soles(raster, corner, p.half_length, p.half_width, leg, clearances)
        clear = True
        for n in range(leg.shape[0]):
            needed = min(p.swing_leg_clearance, 0.5 * (leg[n, 2] - near[2]) - p.ground_above)
            clear = clear and clearances[n] >= needed
        if clear:
            return
    waypoint[0], waypoint[1], waypoint[2] = near[0], near[1], apex


@kernel
def _leg(near: Array, far: Array, waypoint: Array, spacing: float) -> Array:
    """Soles from a foothold to a corner of the way, (N, 6): the slopes fade in proportion, the yaw follows the way."""
    whole = np.sqrt((far[0] - near[0]) ** 2 + (far[1] - near[1]) ** 2)
    level = np.sqrt((waypoint[0] - near[0]) ** 2 + (waypoint[1] - near[1]) ** 2)
    length = np.sqrt(level * level + (waypoint[2] - near[2]) ** 2)
    lead = 0.0 if whole < spacing else level / whole
    turn = lead * wrapped(far[3] - near[3])
    soles = np.empty((2 + int(length / spacing), 6))
    for k in range(soles.shape[0]):
        fraction = k / (soles.shape[0] - 1)
        for i in range(3):
            soles[k, i] = near[i] + fraction * (waypoint[i] - near[i])
        soles[k, 3] = near[3] + fraction * turn
        soles[k, 4], soles[k, 5] = (1.0 - fraction) * near[4], (1.0 - fraction) * near[5]
    return soles


@kernel
def _crossing(start: Array, end: Array, height: float, count: int) -> Array:
    """Level soles at one height from above one foothold to above the other, (count, 6)."""
    turn = wrapped(end[3] - start[3])
    soles = np.zeros((count, 6))
    for k in range(count):
        fraction = k / (count - 1)
        soles[k, 0] = start[0] + fraction * (end[0] - start[0])
        soles[k, 1] = start[1] + fraction * (end[1] - start[1])
        soles[k, 2] = height
        soles[k, 3] = start[3] + fraction * turn
    return soles
