"""What makes the ground seem to move: drift of the robot's estimate, a camera that is mounted askew, a wrong scale.

Drift goes on with time, v dt; a mount that is off by small angles e shifts the ground by e x d when the camera moves by
d; depth that is measured too long by a share k shifts it by k d. Linear least squares over the shifts of many frames,
recursive, with forgetting and with a prior that all are small, tells them apart, because a walking robot sways.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skills.geometry.pose import Array, readonly

# How large drift [m/s], mount error [rad] and scale error are expected to be, and how exact a frame is [m].
_EXPECTED = np.repeat((0.01, 0.035, 0.01), (3, 3, 1))
_EXACT = np.array((1e-3, 1e-3, 2e-4))
_PRIOR = np.diag(_EXPECTED**-2.0)


@dataclass(frozen=True, slots=True, eq=False)
class ApparentMotion:
    """An estimate of drift, mount and scale.

    Attributes:
        information, vector: normal equations beyond the prior, (7, 7) and (7,).
        estimate: drift in the world [m/s], mount error in the camera's frame [rad], share of scale, (7,).
    """

    information: Array
    vector: Array
    estimate: Array

    def __post_init__(self) -> None:
        for name in ("information", "vector", "estimate"):
            object.__setattr__(self, name, readonly(getattr(self, name)))

    @classmethod
    def unknown(cls) -> ApparentMotion:
        """Nothing has been seen yet."""
        return cls(np.zeros((7, 7)), np.zeros(7), np.zeros(7))

    def learned(self, causes: Array, shift_world: Array, trust: float, kept: float) -> ApparentMotion:
        """After one more frame: what was known counts only for a share `kept`, the frame for a share `trust`."""
        weighted = trust * causes.T / _EXACT**2
        information = kept * self.information + weighted @ causes
        vector = kept * self.vector + weighted @ shift_world
        return ApparentMotion(
            information, vector, np.asarray(np.linalg.solve(information + _PRIOR, vector), np.float64)
        )

    def of_camera(self, causes: Array, angle_min: float, scale_min: float) -> Array:
        """The shift that the camera is to blame for, (3,) [m]; none while its errors are too small to be sure of."""
        mount, scale = self.estimate[3:6], self.estimate[6]
        if np.linalg.norm(mount) < angle_min and abs(scale) < scale_min:
            return np.zeros(3)
        return causes[:, 3:] @ self.estimate[3:]


def causes_of(dt: float, moved_world: Array, R_world_camera: Array) -> Array:
    """How a shift of the ground in the world follows from drift, mount and scale, (3, 7)."""
    x, y, z = moved_world
    cross = np.array([(0.0, z, -y), (-z, 0.0, x), (y, -x, 0.0)])  # cross @ e = e x moved
    return np.column_stack((dt * np.eye(3), cross @ R_world_camera, moved_world))
