"""The control-rate log: what balance wanted, what the program answered, and what the feet felt, one line a tick.

A line holds what the tick has computed anyway; points that follow from it are worked out by whoever reads them. The
commanded CoP beside the measured one tells early that contact is not what the controller takes it for (Koolen et al.,
"Design of a momentum-based control framework and application to the humanoid robot Atlas", 2016, section 7).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from skills.footsteps.footstep import Side, Stance
from skills.geometry.pose import Array, Pose
from skills.walking.quadratic_program import QpStatus
from skills.walking.walking_state import WalkingPhase

_LEAST_FORCE = 50.0  # Below it a CoP says nothing [N].


@dataclass(frozen=True, slots=True, eq=False)
class ControlSample:
    """One line of the control-rate log.

    Attributes:
        time: robot time [s].
        phase: walking phase.
        com_world, dcm_world, dcm_reference_world: (3,) [m].
        cmp_world: centroidal moment pivot that balance asks for, at the height of the feet, (3,) [m].
        dcm_error: distance of the DCM from its reference in the plane [m].
        angular_momentum_world: about the CoM, (3,) [N m s].
        stance: both soles as they are, also of a foot in the air.
        wrenches_sole: of the ground on each sole as commanded, force first, (6,) in its frame [N, N m].
        measured_wrenches_sole: the same as measured; empty where nothing measures them.
        torque_shares: commanded torques by their limits, (n,).
        support_world: where the CoP may be from above, (N, 2) convex [m].
        qp_status: how the quadratic program ended.
        qp_iterations: of its solver.
        qp_time: that the solver took by its own clock [s].
    """

    time: float
    phase: WalkingPhase
    com_world: Array
    dcm_world: Array
    dcm_reference_world: Array
    cmp_world: Array
    dcm_error: float
    angular_momentum_world: Array
    stance: Stance
    wrenches_sole: Mapping[Side, Array]
    measured_wrenches_sole: Mapping[Side, Array]
    torque_shares: Array
    support_world: Array
    qp_status: QpStatus
    qp_iterations: int
    qp_time: float

    @property
    def cop_world(self) -> Array:
        """Commanded centre of pressure, (3,); not a number without force [m]."""
        return self._cop(self.wrenches_sole)

    @property
    def cop_measured_world(self) -> Array:
        """Measured centre of pressure, (3,); not a number without force or where nothing measures it [m]."""
        return self._cop(self.measured_wrenches_sole)

    @property
    def cop_error(self) -> float:
        """Distance of the measured from the commanded CoP: of no size while contact is what it is taken for [m]."""
        return float(np.linalg.norm(self.cop_measured_world - self.cop_world))

    def load(self, side: Side) -> float:
        """Measured normal force under a sole; not a number where nothing measures it [N]."""
        wrench = self.measured_wrenches_sole.get(side)
        return float("nan") if wrench is None else float(wrench[2])

    def stands_on(self, side: Side) -> bool:
        """Whether the program lets the ground push a sole."""
        return bool(self.wrenches_sole[side][2] > 0.0)

    def moved(self, T: Pose) -> ControlSample:
        """The same sample seen from another frame, level as this one."""
        names = ("com_world", "dcm_world", "dcm_reference_world", "cmp_world")
        points = {name: T @ getattr(self, name) for name in names}
        support = (T @ np.column_stack((self.support_world, np.zeros(len(self.support_world)))))[:, :2]
        momentum = T.R @ self.angular_momentum_world
        stance = self.stance.moved(T)
        return replace(self, **points, support_world=support, angular_momentum_world=momentum, stance=stance)

    def _cop(self, wrenches_sole: Mapping[Side, Array]) -> Array:
        """The centre of pressure of both soles, each in its plane, weighted by their normal forces, (3,)."""
        total, moment = 0.0, np.zeros(3)
        for side, wrench in wrenches_sole.items():
            force = float(wrench[2])
            if force > _LEAST_FORCE:
                total += force
                sole = self.stance.sole(side)
                moment += force * sole.p - wrench[4] * sole.R[:, 0] + wrench[3] * sole.R[:, 1]
        return moment / total if total > 0.0 else np.full(3, np.nan)
