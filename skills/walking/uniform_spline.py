"""Uniform cubic B-splines: curves with continuous acceleration inside the hull of their control points.

Every value is a weighted mean of four neighbouring control points (de Boor, 1978), so a curve whose control points are
each an extreme of a bound over the two knots around them keeps that bound everywhere.
"""

from __future__ import annotations

import numpy as np

from skills.geometry.pose import Array

_VALUE = np.array([[1.0, 4.0, 1.0, 0.0], [-3.0, 0.0, 3.0, 0.0], [3.0, -6.0, 3.0, 0.0], [-1.0, 3.0, -3.0, 1.0]]) / 6.0


class UniformSpline:
    """A cubic B-spline over equal intervals; constant in time outside them.

    Args:
        start: where the first interval starts.
        spacing: length of an interval.
        controls: control points from one knot before the start to one behind the end, (intervals + 3, D).
    """

    def __init__(self, start: float, spacing: float, controls: Array) -> None:
        self._start, self._spacing = start, spacing
        self._intervals = len(controls) - 3
        # Row i: coefficients of the powers of the place within interval i.
        windows = np.stack([controls[k : k + self._intervals] for k in range(4)], axis=1)
        self._coefficients = np.einsum("pk,ikd->ipd", _VALUE, windows)

    def value(self, t: float) -> Array:
        """The curve at one place, (D,)."""
        i, x = self._locate(t)
        return np.array((1.0, x, x * x, x * x * x)) @ self._coefficients[i]

    def values(self, times: Array) -> Array:
        """The curve at many places, (M, D)."""
        x = np.clip((np.asarray(times) - self._start) / self._spacing, 0.0, self._intervals)
        i = np.minimum(x.astype(np.int64), self._intervals - 1)
        x = x - i
        powers = np.stack((np.ones_like(x), x, x * x, x * x * x), axis=1)
        return np.einsum("mp,mpd->md", powers, self._coefficients[i])

    def motion(self, t: float) -> tuple[Array, Array, Array]:
        """Value, first and second derivative at one place, each (D,)."""
        i, x = self._locate(t)
        c, h = self._coefficients[i], self._spacing
        value = c[0] + x * (c[1] + x * (c[2] + x * c[3]))
        return value, (c[1] + x * (2.0 * c[2] + x * 3.0 * c[3])) / h, (2.0 * c[2] + 6.0 * x * c[3]) / (h * h)

    def _locate(self, t: float) -> tuple[int, float]:
        x = min(max((t - self._start) / self._spacing, 0.0), float(self._intervals))
        i = min(int(x), self._intervals - 1)
        return i, x - i


def minimum_jerk(x: Array) -> Array:
    """The quintic from 0 to 1 over [0, 1] with zero velocity and acceleration at both ends (Flash and Hogan, 1985)."""
    x = np.clip(x, 0.0, 1.0)
    return x * x * x * (10.0 + x * (6.0 * x - 15.0))


def minimum_jerk_at(x: float) -> float:
    """`minimum_jerk` at one place."""
    x = min(max(x, 0.0), 1.0)
    return x * x * x * (10.0 + x * (6.0 * x - 15.0))


def controls_of_motion(value: Array, velocity: Array, acceleration: Array, spacing: float) -> Array:
    """The three control points with which a spline starts in a given motion, (3, D)."""
    middle = value - acceleration * spacing**2 / 6.0
    bend = 0.5 * acceleration * spacing**2
    return np.stack((middle + bend - velocity * spacing, middle, middle + bend + velocity * spacing))
