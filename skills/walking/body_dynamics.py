"""Rigid-body terms of the robot in one state: what the whole-body controller's quadratic program is made of.

All come from pinocchio (Carpentier et al., 2019) in one pass. Velocities and Jacobians of soles and torso are in their
own frames; momentum and CoM are along the world's axes.
"""

from __future__ import annotations

import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports]

from skills.footsteps.footstep import Side
from skills.geometry.pose import Array, Pose
from skills.walking.robot_model import RobotModel


class BodyDynamics:
    """Dynamics of one robot in the state of the last `update`; not for use by two threads at once.

    Attributes:
        q, v: configuration (7 + n,) and velocity (6 + n,) in pinocchio's order.
        mass_matrix: joint-space inertia, (6 + n, 6 + n).
        bias: Coriolis, centrifugal, gravity and damping forces, (6 + n,).
        com, com_velocity: centre of mass in the world, (3,) [m, m/s].
        momentum: linear and angular momentum about the CoM, (6,).
        momentum_matrix: its derivative by the velocity, (6, 6 + n).
        momentum_drift: rate of the momentum at zero acceleration, (6,).
        R_world_pelvis: pelvis orientation, (3, 3).
        R_world_torso: torso orientation, (3, 3).
        torso_jacobian, torso_drift: angular velocity of the torso in its own frame by the velocity, (3, 6 + n), and its
            acceleration at zero acceleration, (3,).
        sole_jacobians, sole_drifts: spatial velocity of each sole in its own frame by the velocity, (6, 6 + n), linear
            first, and its acceleration at zero acceleration, (6,).
    """

    def __init__(self, model: RobotModel) -> None:
        self.model = model
        self._pin = model.pin_model
        self._data = self._pin.createData()
        self._zero = np.zeros(self._pin.nv)
        self._below_diagonal = np.tril_indices(self._pin.nv, -1)
        self._damping = np.array(self._pin.damping)
        self._torso = self._pin.getFrameId(model.torso_frame)
        self.sole_jacobians: dict[Side, Array] = {}
        self.sole_drifts: dict[Side, Array] = {}
        self._soles: dict[Side, Pose] = {}

    def update(self, q: Array, v: Array) -> None:
        """Compute all terms for a configuration and a velocity."""
        model, data = self._pin, self._data
        self.q, self.v = q, v
        pin.computeAllTerms(model, data, q, v)
        # A fresh array: pinocchio fills the upper triangle only, and the view would change with the next call.
        M = np.array(data.M)
        M[self._below_diagonal] = M.T[self._below_diagonal]
        self.mass_matrix = M
        self.bias = data.nle + self._damping * v
        self.com, self.com_velocity = np.array(data.com[0]), np.array(data.vcom[0])
        self.momentum_matrix = np.array(data.Ag)
        self.momentum = self.momentum_matrix @ v
        # Fills the accelerations of all joints at zero acceleration as well, which the drifts below are read from.
        drift = pin.computeCentroidalMomentumTimeVariation(model, data, q, v, self._zero)
        self.momentum_drift = np.array(drift.vector)
        self.R_world_pelvis = np.array(data.oMi[1].rotation)
        self.torso_jacobian = pin.getFrameJacobian(model, data, self._torso, pin.LOCAL)[3:]
        self.torso_drift = np.array(pin.getFrameAcceleration(model, data, self._torso, pin.LOCAL).angular)
        self.R_world_torso = np.array(pin.updateFramePlacement(model, data, self._torso).rotation)
        for side, frame in self.model.sole_frames.items():
            self.sole_jacobians[side] = pin.getFrameJacobian(model, data, frame, pin.LOCAL)
            self.sole_drifts[side] = np.array(pin.getFrameAcceleration(model, data, frame, pin.LOCAL).vector)
            placement = pin.updateFramePlacement(model, data, frame)
            self._soles[side] = Pose(placement.rotation, placement.translation)

    def sole(self, side: Side) -> Pose:
        """T_world_sole."""
        return self._soles[side]

    def sole_velocity(self, side: Side) -> Array:
        """Spatial velocity of a sole in its own frame, linear first, (6,) [m/s, rad/s]."""
        return self.sole_jacobians[side] @ self.v
