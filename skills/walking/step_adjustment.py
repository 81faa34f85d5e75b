"""Where and when to land instead, when the CoP alone can no longer save the balance.

The DCM that the stance foot cannot hold back is met by the next foothold: with the CoP kept at the point p of the sole
that does most, the DCM at landing is p + (xi - p) tau with tau = exp(omega T). Landing place u, tau and the offset b of
the DCM from the foothold are chosen by a small quadratic program (Khadiv et al., "Step timing adjustment: A step toward
generating robust gaits", 2016):

    minimize    |u - u_planned|^2 + w_tau (tau - tau_planned)^2 + w_b |b - b_planned|^2
    subject to  u + b = p + (xi - p) tau,
                u within reach of the standing leg, beside it, and on ground known to be good,
                tau within what the swinging foot can make
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp, hypot, log

import numpy as np

from skills.footsteps.footstep import Footstep
from skills.geometry.pose import Array, Pose
from skills.parameters import parameter, parameters
from skills.walking.quadratic_program import OsqpSolver, QpStatus
from skills.walking.support_polygon import SupportPolygon

_REGION_EDGES = 8
_TOLERANCE = 1e-6
_ITERATIONS = 400
_CHECK = 10


@parameters
class StepAdjustmentParameters:
    """How far a step may be changed to save the balance."""

    deadband: float = parameter(
        0.02, unit="m", meaning="error of the DCM at landing that steps do not answer", minimum=0.0, maximum=0.5
    )
    time_weight: float = parameter(0.01, unit="m^2", meaning="cost of another timing", minimum=0.0)
    offset_weight: float = parameter(
        100.0, unit="1", meaning="cost of landing with another offset of the DCM", minimum=0.0
    )
    forward: float = parameter(0.6, unit="m", meaning="longest step", minimum=0.1, maximum=1.5)
    backward: float = parameter(0.4, unit="m", meaning="longest step back", minimum=0.0, maximum=1.5)
    narrowest: float = parameter(
        0.18, unit="m", meaning="least distance sideways of the feet; guards against crossing", minimum=0.0, maximum=0.5
    )
    widest: float = parameter(0.6, unit="m", meaning="greatest distance sideways", minimum=0.1, maximum=1.5)
    fastest: float = parameter(1.6, unit="1", meaning="greatest pace of a swing", minimum=1.0, maximum=3.0)
    slowest: float = parameter(0.8, unit="1", meaning="least pace of a swing", minimum=0.2, maximum=1.0)
    shift_speed: float = parameter(1.5, unit="m/s", meaning="how fast a landing place may move", minimum=0.1)
    last_share: float = parameter(
        0.9, unit="1", meaning="share of a swing after which its landing stays", minimum=0.1, maximum=1.0
    )
    shortest_transfer: float = parameter(
        0.08, unit="s", meaning="double support that a DCM outside the feet still gets", minimum=0.0, maximum=1.0
    )


@dataclass(frozen=True, slots=True, eq=False)
class SwingState:
    """What a swing has to be judged by.

    Attributes:
        step: the step under way, as commanded.
        T_world_stance: the standing sole.
        support: where the CoP may be.
        dcm: as it is, (2,) in the world [m].
        dcm_at_landing: as planned for landing as commanded, (2,) in the world [m].
        remaining: time to landing at the commanded pace [s].
    """

    step: Footstep
    T_world_stance: Pose
    support: SupportPolygon
    dcm: Array
    dcm_at_landing: Array
    remaining: float


@dataclass(frozen=True, slots=True, eq=False)
class Landing:
    """Where and when a foot shall land.

    Attributes:
        shift: of the landing place from the commanded one, (2,) in the world [m].
        pace: of the swing from now on; 1 as commanded.
    """

    shift: Array
    pace: float


AS_COMMANDED = Landing(np.zeros(2), 1.0)


class StepAdjustment:
    """Chooses landings for one robot; not for use by two threads at once.

    Args:
        omega: sqrt(gravity / CoM height) [1/s].
        parameters: settings.
    """

    def __init__(self, omega: float, parameters: StepAdjustmentParameters) -> None:
        self._omega, self._parameters = omega, parameters
        # Unknowns: u (2), tau. Rows: forward, sideways, tau, and the edges of the good ground.
        A_pattern = np.ones((3 + _REGION_EDGES, 3), dtype=bool)
        A_pattern[:2, 2], A_pattern[2, :2], A_pattern[3:, 2] = False, False, False
        self._solver = OsqpSolver(np.ones((3, 3), dtype=bool), A_pattern, _TOLERANCE, _ITERATIONS, _CHECK)

    def landing(self, swing: SwingState) -> Landing:
        """The landing that meets the DCM best; as commanded where the CoP can do it alone."""
        p, omega = self._parameters, self._omega
        if swing.remaining <= 0.0 or not len(swing.step.landing_region_sole):
            return AS_COMMANDED
        planned = exp(omega * swing.remaining)
        cop = swing.support.nearest((swing.dcm_at_landing - planned * swing.dcm) / (1.0 - planned))
        error = cop + (swing.dcm - cop) * planned - swing.dcm_at_landing
        if hypot(error[0], error[1]) <= p.deadband:
            return AS_COMMANDED
        u, tau = self._solve(swing, cop, planned)
        shift = u - swing.step.T_world_sole.p[:2]
        return Landing(shift, swing.remaining / max(log(tau) / omega, 1e-3))

    def _solve(self, swing: SwingState, cop: Array, planned: float) -> tuple[Array, float]:
        """Landing place (2,) in the world [m] and tau."""
        p, u_planned = self._parameters, swing.step.T_world_sole.p[:2]
        b_planned = swing.dcm_at_landing - u_planned
        away = swing.dcm - cop
        # b = cop + away tau - u, so its cost is one of u and tau.
        rows = np.column_stack((-np.eye(2), away))
        P = p.offset_weight * rows.T @ rows
        P[0, 0] += 1.0
        P[1, 1] += 1.0
        P[2, 2] += p.time_weight
        q = p.offset_weight * rows.T @ (cop - b_planned)
        q[:2] -= u_planned
        q[2] -= p.time_weight * planned
        A, lower, upper = self._limits(swing)
        solution = self._solver.solve(P, q, A, lower, upper)
        if solution.status is QpStatus.FAILED:
            return u_planned, planned
        tau = float(np.clip(solution.x[2], lower[2], upper[2]))
        return solution.x[:2], tau

    def _limits(self, swing: SwingState) -> tuple[Array, Array, Array]:
        p, side, stance = self._parameters, swing.step.side, swing.T_world_stance
        forward = np.array((np.cos(stance.yaw), np.sin(stance.yaw)))
        outward = side.sign * np.array((-forward[1], forward[0]))
        A = np.zeros((3 + _REGION_EDGES, 3))
        lower, upper = np.full(len(A), -np.inf), np.full(len(A), np.inf)
        here = stance.p[:2]
        A[0, :2], A[1, :2], A[2, 2] = forward, outward, 1.0
        lower[:2] = forward @ here - p.backward, outward @ here + p.narrowest
        upper[:2] = forward @ here + p.forward, outward @ here + p.widest
        lower[2] = exp(self._omega * swing.remaining / p.fastest)
        upper[2] = exp(self._omega * swing.remaining / p.slowest)
        region = _landing_region(swing.step)
        edges = np.roll(region, -1, axis=0) - region
        for row, (corner, edge) in enumerate(zip(region[:_REGION_EDGES], edges[:_REGION_EDGES], strict=True), start=3):
            inward = np.array((-edge[1], edge[0])) / max(hypot(edge[0], edge[1]), 1e-9)
            A[row, :2], lower[row] = inward, inward @ corner
        return A, lower, upper


def _landing_region(step: Footstep) -> Array:
    """Places of the sole's centre on good ground from above, (N, 2) in the world [m]."""
    region = np.column_stack((step.landing_region_sole, np.zeros(len(step.landing_region_sole))))
    return (step.T_world_sole @ region)[:, :2]
