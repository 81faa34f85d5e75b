"""Swing clearance: the way of a foot over the ground between two footholds, as two waypoints.

The level sole is swept from lift-off to landing; the foot rises to the first waypoint, crosses at one height above all
ground under the way, and comes down from the second. Where the ground near lift-off is high it rises first and then
moves; where the ground near landing is high it arrives first and then descends. While it rises the sole turns level,
while it descends it turns into the plane of the foothold, both in proportion to the way; on the legs clearance is
checked with that tilt.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skills.footsteps.footstep_parameters import FootstepParameters
from skills.footsteps.terrain import Terrain, slopes
from skills.geometry.pose import Array, Pose, readonly, wrap_angle

# Distances between the soles that are held over the ground, in cells: a sole is many of them long.
_CROSSING, _LEG = 4.0, 2.0


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
    start, end = T_world_start.p, T_world_end.p
    higher = max(start[2], end[2])
    crossing = _crossing(T_world_start, T_world_end, higher, _CROSSING * terrain.raster.resolution)
    ground = higher - _clearances(terrain, crossing, parameters, parameters.swing_margin)
    apex = max(float(np.max(ground)) + parameters.swing_clearance, higher + parameters.swing_height)
    travelled = np.linalg.norm(crossing[:, :2] - start[:2], axis=1)
    left = np.linalg.norm(crossing[:, :2] - end[:2], axis=1)
    near_start = float(np.max(ground[travelled <= parameters.lift_off_zone])) - start[2]
    near_end = float(np.max(ground[left <= parameters.landing_zone])) - end[2]
    up_first = near_start > parameters.lift_off_obstacle
    forward_first = near_end > parameters.landing_obstacle
    first = _corner(terrain, T_world_start, T_world_end, apex, up_first, parameters)
    last = _corner(terrain, T_world_end, T_world_start, apex, forward_first, parameters)
    return SwingClearance(apex - higher, readonly((first, last)))


def _corner(
    terrain: Terrain, T_world_near: Pose, T_world_far: Pose, apex: float, vertical: bool, parameters: FootstepParameters
) -> Array:
    """Where the leg from a foothold to the height of the crossing ends, (3,); right above it where no other clears."""
    near, far = T_world_near.p, T_world_far.p
    leads = () if vertical else (parameters.swing_lead, 0.5 * parameters.swing_lead)
    for lead in leads:
        corner = np.array((*(near[:2] + lead * (far[:2] - near[:2])), apex))
        leg = _leg(T_world_near, T_world_far, corner, _LEG * terrain.raster.resolution)
        risen = leg[:, 2] - near[2]
        needed = np.minimum(parameters.swing_leg_clearance, 0.5 * risen - parameters.ground_above)
        if np.all(_clearances(terrain, leg, parameters, 0.0) >= needed):
            return corner
    return np.array((near[0], near[1], apex))


def _leg(T_world_near: Pose, T_world_far: Pose, corner_world: Array, spacing: float) -> Array:
    """Soles from a foothold to a corner of the way, (N, 6): the slopes fade in proportion, the yaw follows the way."""
    near, far = T_world_near.p, T_world_far.p
    whole = np.linalg.norm(far[:2] - near[:2])
    lead = 0.0 if whole < spacing else np.linalg.norm(corner_world[:2] - near[:2]) / whole
    fraction = np.linspace(0.0, 1.0, 2 + int(np.linalg.norm(corner_world - near) / spacing))[:, None]
    yaw = T_world_near.yaw + fraction * lead * wrap_angle(T_world_far.yaw - T_world_near.yaw)
    return np.hstack((near + fraction * (corner_world - near), yaw, (1.0 - fraction) * np.array(slopes(T_world_near))))


def _crossing(T_world_start: Pose, T_world_end: Pose, height: float, spacing: float) -> Array:
    """Level soles at one height from above one foothold to above the other, (N, 6)."""
    way = T_world_end.p[:2] - T_world_start.p[:2]
    fraction = np.linspace(0.0, 1.0, 2 + int(np.linalg.norm(way) / spacing))[:, None]
    yaw = T_world_start.yaw + fraction * wrap_angle(T_world_end.yaw - T_world_start.yaw)
    heights, level = np.full_like(fraction, height), np.zeros((len(fraction), 2))
    return np.hstack((T_world_start.p[:2] + fraction * way, heights, yaw, level))


def _clearances(terrain: Terrain, soles: Array, parameters: FootstepParameters, margin: float) -> Array:
    """Clearance of soles that are larger by a margin on all sides."""
    return terrain.clearances(soles, 0.5 * parameters.sole_length + margin, 0.5 * parameters.sole_width + margin)
