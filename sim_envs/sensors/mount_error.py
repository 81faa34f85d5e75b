"""A sensor that sits a little askew: turned from where the robot believes it to be, about an axis drawn once."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from skills.geometry.pose import Array, Pose


def mount_rotation(angle: float, seed: Sequence[int]) -> Array:
    """Rotation from the true sensor to the believed one, R_believed_true (3, 3), by an angle [rad]."""
    axis = np.random.default_rng(tuple(seed)).standard_normal(3)
    vector = np.sin(0.5 * angle) * axis / np.linalg.norm(axis)
    return Pose.from_quaternion_wxyz((np.cos(0.5 * angle), *vector), np.zeros(3)).R
