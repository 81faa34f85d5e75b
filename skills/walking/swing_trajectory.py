"""The way of a sole through the air: over the step's waypoints, or over an apex where it has none.

The travel along the way is a minimum-jerk motion; the height is a cubic B-spline whose control points are each the
highest of the way within two knots around them, so that the curve stays above the polyline through start, waypoints
and foothold and has continuous acceleration. At a wall-like beginning or end of the polyline the sole first rises and
then travels, or travels and then sinks; it leaves and meets the ground along its normal.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports]

from skills.footsteps.footstep import Footstep
from skills.geometry.pose import Array, Pose, rotation_z, wrap_angle
from skills.walking.swing_parameters import SwingParameters
from skills.walking.uniform_spline import UniformSpline, minimum_jerk, minimum_jerk_at

# A metre up counts as this many metres of travel: it gives upright parts of the polyline a place on the way.
_UPRIGHT = 0.05
_DENSITY = 8


@dataclass(frozen=True, slots=True, eq=False)
class SoleMotion:
    """Where a sole shall be and how it shall move, in the world.

    Attributes:
        pose: T_world_sole.
        velocity, acceleration: linear first, then angular, along the world's axes, (6,).
    """

    pose: Pose
    velocity: Array
    acceleration: Array


class SwingTrajectory:
    """Sole poses from lift-off to landing, and on downwards where the ground does not come.

    Args:
        T_world_start: sole at lift-off.
        step: the step to make.
        parameters: settings of the swing.
    """

    def __init__(self, T_world_start: Pose, step: Footstep, parameters: SwingParameters) -> None:
        self.duration = step.swing_duration
        self._R_start = T_world_start.R
        way = _polyline(T_world_start, step, parameters)
        controls, self._travel = _positions(way, T_world_start, step, parameters)
        turns = _turns(T_world_start.R, step.T_world_sole.R, parameters)
        self._spline = UniformSpline(0.0, 1.0 / parameters.knots, np.hstack((controls, turns)))
        self._landing_rate = np.array((0.0, 0.0, -parameters.touchdown_speed * self.duration, 0.0, 0.0, 0.0))

    def pose(self, t: float) -> Pose:
        """T_world_sole at a time since lift-off [s]."""
        x = self._spline.value(t / self.duration)
        return Pose(self._R_start @ pin.exp3(x[3:]), x[:3])

    def poses(self, times: Array) -> tuple[Array, Array]:
        """Sole orientations (M, 3, 3) and positions (M, 3) in the world at times since lift-off (M,) [s, m]."""
        x = self._spline.values(np.asarray(times) / self.duration)
        return self._R_start @ _exponentials(x[:, 3:]), x[:, :3]

    def travelled(self, u: float) -> tuple[float, float]:
        """Share of the way over ground made at a share u of the swing, and its derivative by u."""
        leave, arrive = self._travel
        x = min(max((u - leave) / (arrive - leave), 0.0), 1.0)
        return minimum_jerk_at(x), 30.0 * (x * (1.0 - x)) ** 2 / (arrive - leave)

    def motion(self, u: float, rate: float) -> SoleMotion:
        """The sole at a share u of the swing that passes at a rate [1/s]; behind its end it sinks on steadily."""
        if u >= 1.0:
            x = self._spline.value(1.0) + (u - 1.0) * self._landing_rate
            dx, ddx = self._landing_rate, np.zeros(6)
        else:
            x, dx, ddx = self._spline.motion(u)
        turn = self._R_start @ pin.exp3(x[3:])
        # The angular velocity in the sole frame is Jexp3(x) x'; the derivative of Jexp3 itself is left out.
        J = turn @ pin.Jexp3(x[3:])
        velocity, acceleration = rate * dx, rate * rate * ddx
        velocity[3:], acceleration[3:] = J @ velocity[3:], J @ acceleration[3:]
        return SoleMotion(Pose(turn, x[:3]), velocity, acceleration)


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


def _turns(R_start: Array, R_end: Array, parameters: SwingParameters) -> Array:
    """Control points of the rotation vector from the start, (knots + 3, 3): level in the air, aligned at landing."""
    count = parameters.knots
    shares = np.clip(np.arange(-1, count + 2) / count, 0.0, 1.0)
    yaw_start, yaw_end = np.arctan2(R_start[1, 0], R_start[0, 0]), np.arctan2(R_end[1, 0], R_end[0, 0])
    start_tilt = pin.log3(rotation_z(-yaw_start) @ R_start)
    end_tilt = pin.log3(rotation_z(-yaw_end) @ R_end)
    yaws = yaw_start + wrap_angle(yaw_end - yaw_start) * minimum_jerk(shares / parameters.aligned)
    leaving = 1.0 - minimum_jerk(shares / parameters.level)
    arriving = minimum_jerk((shares - parameters.level) / (parameters.aligned - parameters.level))
    tilts = leaving[:, None] * start_tilt + arriving[:, None] * end_tilt
    turns = np.stack([pin.log3(R_start.T @ rotation_z(a) @ pin.exp3(t)) for a, t in zip(yaws, tilts, strict=True)])
    turns[:3], turns[-3:] = turns[0], turns[-1]
    return turns


def _polyline(T_world_start: Pose, step: Footstep, parameters: SwingParameters) -> Array:
    """Points of the way from lift-off to landing, (K, 3) in the world."""
    start, end = T_world_start.p, step.T_world_sole.p
    if len(step.swing_waypoints_world):
        return np.vstack((start, step.swing_waypoints_world, end))
    apex = max(start[2], end[2]) + step.swing_height
    shoulder = parameters.shoulder * (end - start)
    before, behind = start + shoulder, end - shoulder
    before[2] = behind[2] = apex
    return np.vstack((start, before, behind, end))


def _positions(
    way: Array, T_world_start: Pose, step: Footstep, parameters: SwingParameters
) -> tuple[Array, tuple[float, float]]:
    """Control points of the position over the share of the swing, (knots + 3, 3), and when the foot travels."""
    count = parameters.knots
    knots = np.arange(-1, count + 2) / count
    parts = np.diff(way, axis=0)
    places = np.append(0.0, np.cumsum(np.linalg.norm(parts[:, :2], axis=1) + _UPRIGHT * np.abs(parts[:, 2])))
    length = max(places[-1], 1e-9)
    leave, arrive = _travel_window(way, places / length, parameters)
    travel = minimum_jerk((knots - leave) / (arrive - leave)) * length
    dense = np.arange(count * _DENSITY + 1) / (count * _DENSITY)
    travelled = UniformSpline(0.0, 1.0 / count, travel[:, None]).values(dense)[:, 0]
    sink = parameters.touchdown_speed * step.swing_duration / count
    heights = _heights(knots, dense, np.interp(travelled, places, way[:, 2]), parameters.ramp, 1.0 / count, sink)
    controls = np.column_stack((np.interp(travel, places, way[:, 0]), np.interp(travel, places, way[:, 1]), heights))
    middle = minimum_jerk((knots - leave) / (arrive - leave))
    for pose, weight, lowest in ((T_world_start, 1.0 - middle, 0.0), (step.T_world_sole, middle, -sink)):
        normal, along = pose.R[:, 2], parameters.normal
        rise = along * np.tanh(np.maximum(lowest, heights - pose.p[2]) / along)
        controls[:, :2] += (weight * rise)[:, None] * normal[:2] / normal[2]
    return controls, (leave, arrive)


def _travel_window(way: Array, places: Array, parameters: SwingParameters) -> tuple[float, float]:
    """Shares of the swing between which the foot travels: less where the way begins or ends upright."""
    apex = way[:, 2].max()
    near = parameters.shoulder / 8.0
    climbed, sunk = (np.interp(place, places, way[:, 2]) for place in (near, 1.0 - near))
    upright_start = (climbed - way[0, 2]) / max(apex - way[0, 2], 1e-6)
    upright_end = (sunk - way[-1, 2]) / max(apex - way[-1, 2], 1e-6)
    leave = parameters.leave + parameters.detour * float(np.clip(upright_start, 0.0, 1.0))
    return leave, parameters.arrive - parameters.detour * float(np.clip(upright_end, 0.0, 1.0))


def _heights(knots: Array, dense: Array, way: Array, ramp: float, spacing: float, sink: float) -> Array:
    """Control points of the height, (len(knots),), from the height of the way at dense shares of the swing.

    It arrives sinking by `sink` a knot.
    """
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
    heights[:3] = way[0]
    heights[-3:] = way[-1] + sink * np.array((1.0, 0.0, -1.0))
    return heights
