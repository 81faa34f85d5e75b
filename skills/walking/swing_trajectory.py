"""The way of a sole through the air: over the step's waypoints, or over an apex where it has none.

The travel along the way is a minimum-jerk motion; the height is a cubic B-spline whose control points are each the
highest of the way within two knots around them, so that the curve stays above the polyline through start, waypoints
and foothold and has continuous acceleration. At a wall-like beginning or end of the polyline the sole first rises and
then travels, or travels and then sinks; it leaves and meets the ground along its normal.
"""

from __future__ import annotations

import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports]

from skills.footsteps.footstep import Footstep
from skills.geometry.pose import Array, Pose, rotation_z, wrap_angle
from skills.walking.uniform_spline import UniformSpline, minimum_jerk, minimum_jerk_at
from skills.walking.walking_parameters import WalkingParameters

# A metre up counts as this many metres of travel: it gives upright parts of the polyline a place on the way.
_UPRIGHT = 0.05
_DENSITY = 8


class SwingTrajectory:
    """Sole poses from lift-off to landing.

    Args:
        T_world_start: sole at lift-off.
        step: the step to make.
        parameters: settings of the swing.
    """

    def __init__(self, T_world_start: Pose, step: Footstep, parameters: WalkingParameters) -> None:
        self.duration = step.swing_duration
        self.T_world_end = step.T_world_sole
        self._parameters = parameters
        way = _polyline(T_world_start, step, parameters)
        self._spline = _spline(way, T_world_start, step.T_world_sole, parameters)
        self._yaw = T_world_start.yaw
        self._turn = wrap_angle(step.T_world_sole.yaw - self._yaw)
        self._start_tilt = pin.log3(rotation_z(-self._yaw) @ T_world_start.R)
        self._end_tilt = pin.log3(rotation_z(-step.T_world_sole.yaw) @ step.T_world_sole.R)

    def pose(self, t: float) -> Pose:
        """T_world_sole at a time since lift-off [s]."""
        if t >= self.duration:
            return self.T_world_end
        u = max(t, 0.0) / self.duration
        return Pose(self._rotation(u), self._spline.value(u))

    def poses(self, times: Array) -> tuple[Array, Array]:
        """Sole orientations (M, 3, 3) and positions (M, 3) in the world at times since lift-off (M,) [s, m]."""
        shares = np.clip(np.asarray(times) / self.duration, 0.0, 1.0)
        return self._rotations(shares), self._spline.values(shares)

    def _rotation(self, u: float) -> Array:
        level, aligned = self._parameters.swing_level, self._parameters.swing_aligned
        yaw = self._yaw + self._turn * minimum_jerk_at(u / aligned)
        leaving = 1.0 - minimum_jerk_at(u / level)
        arriving = minimum_jerk_at((u - level) / (aligned - level))
        return rotation_z(yaw) @ pin.exp3(leaving * self._start_tilt + arriving * self._end_tilt)

    def _rotations(self, shares: Array) -> Array:
        level, aligned = self._parameters.swing_level, self._parameters.swing_aligned
        yaw = self._yaw + self._turn * minimum_jerk(shares / aligned)
        leaving = 1.0 - minimum_jerk(shares / level)
        arriving = minimum_jerk((shares - level) / (aligned - level))
        tilts = leaving[:, None] * self._start_tilt + arriving[:, None] * self._end_tilt
        headings = np.zeros((len(shares), 3, 3))
        headings[:, 0, 0] = headings[:, 1, 1] = np.cos(yaw)
        headings[:, 1, 0], headings[:, 0, 1], headings[:, 2, 2] = np.sin(yaw), -np.sin(yaw), 1.0
        return headings @ _exponentials(tilts)


def _exponentials(rotation_vectors: Array) -> Array:
    """Rotation matrices of rotation vectors (M, 3), (M, 3, 3) (Rodrigues)."""
    angles = np.linalg.norm(rotation_vectors, axis=1)[:, None, None]
    x, y, z = rotation_vectors.T
    skew = np.zeros((len(rotation_vectors), 3, 3))
    skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0] = x, y, z
    skew -= skew.transpose(0, 2, 1)
    # sinc keeps both factors finite without a tilt.
    first, second = np.sinc(angles / np.pi), 0.5 * np.sinc(angles / (2.0 * np.pi)) ** 2
    return np.eye(3) + first * skew + second * (skew @ skew)


def _polyline(T_world_start: Pose, step: Footstep, parameters: WalkingParameters) -> Array:
    """Points of the way from lift-off to landing, (K, 3) in the world."""
    start, end = T_world_start.p, step.T_world_sole.p
    if len(step.swing_waypoints_world):
        return np.vstack((start, step.swing_waypoints_world, end))
    apex = max(start[2], end[2]) + step.swing_height
    shoulder = parameters.swing_shoulder * (end - start)
    before, behind = start + shoulder, end - shoulder
    before[2] = behind[2] = apex
    return np.vstack((start, before, behind, end))


def _spline(way: Array, T_world_start: Pose, T_world_end: Pose, parameters: WalkingParameters) -> UniformSpline:
    """The sole's position over the share of the swing."""
    count = parameters.swing_knots
    knots = np.arange(-1, count + 2) / count
    parts = np.diff(way, axis=0)
    places = np.append(0.0, np.cumsum(np.linalg.norm(parts[:, :2], axis=1) + _UPRIGHT * np.abs(parts[:, 2])))
    length = max(places[-1], 1e-9)
    leave, arrive = _travel_window(way, places / length, parameters)
    travel = minimum_jerk((knots - leave) / (arrive - leave)) * length
    dense = np.arange(count * _DENSITY + 1) / (count * _DENSITY)
    travelled = UniformSpline(0.0, 1.0 / count, travel[:, None]).values(dense)[:, 0]
    heights = _heights(knots, dense, np.interp(travelled, places, way[:, 2]), parameters.swing_ramp, 1.0 / count)
    controls = np.column_stack((np.interp(travel, places, way[:, 0]), np.interp(travel, places, way[:, 1]), heights))
    middle = minimum_jerk((knots - leave) / (arrive - leave))
    for pose, weight in ((T_world_start, 1.0 - middle), (T_world_end, middle)):
        normal, along = pose.R[:, 2], parameters.swing_normal
        rise = along * np.tanh(np.maximum(0.0, heights - pose.p[2]) / along)
        controls[:, :2] += (weight * rise)[:, None] * normal[:2] / normal[2]
    return UniformSpline(0.0, 1.0 / count, controls)


def _travel_window(way: Array, places: Array, parameters: WalkingParameters) -> tuple[float, float]:
    """Shares of the swing between which the foot travels: less where the way begins or ends upright."""
    apex = way[:, 2].max()
    near = parameters.swing_shoulder / 8.0
    climbed, sunk = (np.interp(place, places, way[:, 2]) for place in (near, 1.0 - near))
    upright_start = (climbed - way[0, 2]) / max(apex - way[0, 2], 1e-6)
    upright_end = (sunk - way[-1, 2]) / max(apex - way[-1, 2], 1e-6)
    leave = parameters.swing_leave + parameters.swing_detour * float(np.clip(upright_start, 0.0, 1.0))
    return leave, parameters.swing_arrive - parameters.swing_detour * float(np.clip(upright_end, 0.0, 1.0))


def _heights(knots: Array, dense: Array, way: Array, ramp: float, spacing: float) -> Array:
    """Control points of the height, (len(knots),), from the height of the way at dense shares of the swing."""
    apex = way.max()
    near = np.abs(knots[:, None] - dense) <= 2.0 * spacing + 1e-9
    highest = np.where(near, way, -np.inf).max(axis=1)
    # A smooth rise that ends where the way first is at its apex, and a smooth descent from where it last is: slow near
    # the ground, and almost always above the way.
    top = knots[highest > apex - 1e-9]
    rise, descent = np.clip((top[0] - spacing, 1.0 - spacing - top[-1]), 2.0 * spacing, ramp)
    rising = way[0] + (apex - way[0]) * minimum_jerk((knots - spacing) / rise)
    sinking = way[-1] + (apex - way[-1]) * minimum_jerk((1.0 - spacing - knots) / descent)
    heights = np.maximum(highest, np.minimum(rising, sinking))
    heights[:3], heights[-3:] = way[0], way[-1]
    return heights
