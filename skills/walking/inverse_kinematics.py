"""Whole-body inverse kinematics: the configuration that has the CoM and both soles where they should be.

Pelvis and legs have as many freedoms as CoM, pelvis orientation and two soles have coordinates; arms and back keep
their posture. Newton steps on the tangent space, damped by their own error (Sugihara, 2011), converge in two or three
iterations from the configuration before. Where a leg cannot reach, joints stay at their limits and the weights decide:
soles first, then the CoM in the plane, last its height and the pelvis orientation.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports]

from skills.footsteps.footstep import Side, Stance
from skills.geometry.pose import Array
from skills.walking.robot_model import RobotModel

# Rows: CoM x, y, z; pelvis orientation 3; then position 3 and orientation 3 of the left and of the right sole.
_WEIGHTS = np.array([0.3, 0.3, 0.02] + [0.02] * 3 + ([1.0] * 3 + [0.3] * 3) * 2)
_DAMPING = 0.01
_LEAST_DAMPING = 1e-10
_LONGEST_STEP = 0.3
_LEAST_KNEE_BEND = 0.05


@dataclass(frozen=True, slots=True, eq=False)
class IkSolution:
    """What inverse kinematics found.

    Attributes:
        q: configuration, joints within their limits.
        left_error, right_error: distance of the soles from their targets [m].
        com_error: distance of the CoM from its target in the plane [m].
        height_error: CoM height above its target [m].
        iterations: Newton steps made.
    """

    q: Array
    left_error: float
    right_error: float
    com_error: float
    height_error: float
    iterations: int


class InverseKinematics:
    """Solves for pelvis and legs of one robot; not for use by two threads at once."""

    def __init__(self, model: RobotModel) -> None:
        self._model = model
        self._pin = model.pin_model
        self._data = self._pin.createData()
        legs = [joint for side in Side for joint in model.legs[side].joints]
        self._columns = np.array([*range(6), *(6 + joint for joint in legs)])
        self._places = np.array([7 + joint for joint in legs])
        self._lower = model.lower_limits[legs].copy()
        for index, side in enumerate(Side):
            # A knee bent backwards reaches the same ankle and would have to pass the straight leg to come back.
            knee = 6 * index + 3
            self._lower[knee] = max(self._lower[knee], model.legs[side].knee_offset + _LEAST_KNEE_BEND)
        self._upper = model.upper_limits[legs]

    def solve(
        self, q: Array, com_world: Array, R_world_pelvis: Array, stance: Stance, iterations: int, tolerance: float
    ) -> IkSolution:
        """Find a configuration near `q`.

        Args:
            q: where to start, (7 + n,); its arms and back are kept.
            com_world: CoM, (3,) [m].
            R_world_pelvis: pelvis orientation, (3, 3).
            stance: both soles.
            iterations: Newton steps at most.
            tolerance: weighted error at which to stop [m].
        """
        error = self._error(q, com_world, R_world_pelvis, stance)
        made = 0
        while made < iterations and error @ error > tolerance**2:
            q = self._step(q, error)
            error = self._error(q, com_world, R_world_pelvis, stance)
            made += 1
        unweighted = error / _WEIGHTS
        return IkSolution(
            q=q,
            left_error=float(np.linalg.norm(unweighted[6:9])),
            right_error=float(np.linalg.norm(unweighted[12:15])),
            com_error=float(np.linalg.norm(unweighted[:2])),
            height_error=-float(unweighted[2]),
            iterations=made,
        )

    def _error(self, q: Array, com_world: Array, R_world_pelvis: Array, stance: Stance) -> Array:
        """Weighted targets minus present, (18,); leaves kinematics and Jacobians of `q` in the data."""
        data = self._data
        self._com_jacobian = pin.jacobianCenterOfMass(self._pin, data, q)
        self._R_world_pelvis = np.array(data.oMi[1].rotation)
        error = np.empty(18)
        error[0:3] = com_world - data.com[0]
        error[3:6] = pin.log3(R_world_pelvis @ self._R_world_pelvis.T)
        for row, side in ((6, Side.LEFT), (12, Side.RIGHT)):
            target = stance.sole(side)
            sole = pin.updateFramePlacement(self._pin, data, self._model.sole_frames[side])
            error[row : row + 3] = target.p - sole.translation
            error[row + 3 : row + 6] = pin.log3(target.R @ sole.rotation.T)
        return error * _WEIGHTS

    def _step(self, q: Array, error: Array) -> Array:
        """One Newton step from the configuration that the data was computed at, joints kept within limits."""
        jacobian = self._jacobian()
        gram, gradient = jacobian.T @ jacobian, jacobian.T @ error
        gram.flat[:: len(gram) + 1] += _DAMPING * float(error @ error) + _LEAST_DAMPING
        angles = q[self._places]
        step = np.linalg.solve(gram, gradient)
        free = np.ones(18, dtype=bool)
        for _ in range(len(angles)):
            wanted = angles + step[6:]
            blocked = (wanted < self._lower) | (wanted > self._upper)
            if not np.any(blocked & free[6:]):
                break
            # Joints that ran into a limit stop there, and the others make up for it.
            free[6:] &= ~blocked
            held = np.where(free, 0.0, np.append(np.zeros(6), np.clip(wanted, self._lower, self._upper) - angles))
            step = held
            step[free] = np.linalg.solve(gram[np.ix_(free, free)], (gradient - gram @ held)[free])
        longest = float(np.max(np.abs(step)))
        if longest > _LONGEST_STEP:
            step *= _LONGEST_STEP / longest
        tangent = np.zeros(self._pin.nv)
        tangent[self._columns] = step
        q = pin.integrate(self._pin, q, tangent)
        q[self._places] = np.clip(q[self._places], self._lower, self._upper)
        return q

    def _jacobian(self) -> Array:
        jacobian = np.zeros((18, 18))
        jacobian[0:3] = self._com_jacobian[:, self._columns]
        jacobian[3:6, 3:6] = self._R_world_pelvis
        for row, side in ((6, Side.LEFT), (12, Side.RIGHT)):
            frame = self._model.sole_frames[side]
            full = pin.getFrameJacobian(self._pin, self._data, frame, pin.LOCAL_WORLD_ALIGNED)
            jacobian[row : row + 6] = full[:, self._columns]
        jacobian *= _WEIGHTS[:, None]
        return jacobian
