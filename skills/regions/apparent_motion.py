"""What makes the ground seem to move: drift of the robot's estimate, a camera that is mounted askew, a wrong scale.

Drift goes on with time, v dt; a mount that is off by small angles e shifts the ground by e x d when the camera moves by
d; depth that is measured too long by a share k shifts it by k d. Linear least squares over the shifts of many frames,
recursive, with forgetting and with a prior that all are small, tells them apart, because a walking robot sways.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skills.geometry.pose import Array, readonly
from skills.regions.camera_error import CameraError
from skills.regions.registration_parameters import RegistrationParameters


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

    @property
    def camera(self) -> CameraError:
        """The camera's part of it."""
        return CameraError(self.estimate[3:6], float(self.estimate[6]))

    def doubt(self, parameters: RegistrationParameters) -> Array:
        """Standard deviations of what is told of the camera, (4,) [rad, rad, rad, 1]."""
        return np.sqrt(np.diag(np.linalg.inv(self.information + _prior(parameters)))[3:])

    def learned(
        self, causes: Array, shift_world: Array, trust: float, kept: float, parameters: RegistrationParameters
    ) -> ApparentMotion:
        """After one more frame.

        Args:
            causes: see `causes_of`.
            shift_world: of the frame, (3,) [m].
            trust: share for which the frame counts.
            kept: share for which what was known before counts.
            parameters: what is expected, and how exact a frame is.
        """
        exact = np.array((parameters.exact_level, parameters.exact_level, parameters.exact_height))
        weighted = trust * causes.T / exact**2
        information = kept * self.information + weighted @ causes
        vector = kept * self.vector + weighted @ shift_world
        estimate = np.linalg.solve(information + _prior(parameters), vector)
        return ApparentMotion(information, vector, np.asarray(estimate, np.float64))


def _prior(parameters: RegistrationParameters) -> Array:
    """Information that all are about as small as is expected, (7, 7)."""
    expected = (parameters.expected_drift, parameters.expected_mount, parameters.expected_scale)
    return np.diag(np.repeat(expected, (3, 3, 1)) ** -2.0)


def shift_by(error: CameraError, causes: Array, parameters: RegistrationParameters) -> Array:
    """The shift of a frame that its camera is to blame for, (3,) [m]; none where the error is too small to be sure."""
    if np.linalg.norm(error.mount_camera) < parameters.mount_min and abs(error.scale) < parameters.scale_min:
        return np.zeros(3)
    return causes[:, 3:] @ error.vector


def causes_of(dt: float, moved_world: Array, R_world_camera: Array) -> Array:
    """How a shift of the ground in the world follows from drift, mount and scale, (3, 7)."""
    x, y, z = moved_world
    cross = np.array([(0.0, z, -y), (-z, 0.0, x), (y, -x, 0.0)])  # cross @ e = e x moved
    return np.column_stack((dt * np.eye(3), cross @ R_world_camera, moved_world))
