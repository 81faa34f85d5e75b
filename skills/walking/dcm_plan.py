"""A plan of the divergent component of motion (DCM) over a centre of pressure (CoP) that moves in straight pieces.

The DCM is xi = c + c_dot / omega; it obeys xi_dot = omega (xi - p) with the CoP p, and the CoM follows it by c_dot =
omega (xi - c). Planning backward from a DCM that ends at rest makes the plan bounded (Englsberger et al., 2015); over
a linear piece of CoP both directions have a closed form.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from skills.geometry.pose import Array


class DcmPlan:
    """DCM and CoP over consecutive pieces; it rests at the last CoP afterwards.

    Args:
        omega: sqrt(gravity / CoM height) [1/s].
        durations: of the pieces, (N,) [s].
        cops: CoP at the start of the first piece and at the end of each, (N + 1, 2) [m].
    """

    def __init__(self, omega: float, durations: Sequence[float], cops: Sequence[Array]) -> None:
        self._omega = omega
        self._ends = np.cumsum(durations)
        self._durations = np.asarray(durations, dtype=np.float64)
        self._cops = np.asarray(cops, dtype=np.float64)
        self._dcms = np.empty_like(self._cops)
        self._dcms[-1] = self._cops[-1]
        for k in range(len(self._durations) - 1, -1, -1):
            decay, share = _weights(omega, self._durations[k])
            self._dcms[k] = (
                self._dcms[k + 1] * decay + self._cops[k + 1] * (share - decay) + self._cops[k] * (1.0 - share)
            )

    @property
    def duration(self) -> float:
        """Time until the DCM rests [s]."""
        return float(self._ends[-1])

    def reference(self, t: float) -> tuple[Array, Array]:
        """DCM and CoP at a time since the plan's start, each (2,) [m]."""
        k = int(np.searchsorted(self._ends, t, side="right"))
        if k == len(self._ends):
            return self._cops[-1], self._cops[-1]
        left = self._ends[k] - t
        slope = (self._cops[k + 1] - self._cops[k]) / self._durations[k]
        cop = self._cops[k + 1] - slope * left
        lead = slope / self._omega
        # From the piece's end, where the exponential decays: no growth over long pieces.
        dcm = (self._dcms[k + 1] - self._cops[k + 1] - lead) * np.exp(-self._omega * left) + cop + lead
        return dcm, cop

    def com(self, times: Array, com: Array) -> Array:
        """CoM at increasing times since the plan's start where it starts at `com` (2,), (M, 2) [m]."""
        omega, out = self._omega, np.empty((len(times), 2))
        start = 0.0
        for k, end in enumerate(self._ends):
            slope = (self._cops[k + 1] - self._cops[k]) / self._durations[k]
            growing = 0.5 * (self._dcms[k] - self._cops[k] - slope / omega)
            decaying = com - self._cops[k] - growing
            chosen = (times >= start) & (times < end)
            t = np.append(times[chosen] - start, self._durations[k])[:, None]
            line = self._cops[k] + slope * t
            values = line + growing * np.exp(omega * t) + decaying * np.exp(-omega * t)
            out[chosen], com, start = values[:-1], values[-1], end
        late = times >= start
        rest = self._cops[-1]
        out[late] = rest + (com - rest) * np.exp(-omega * (times[late, None] - start))
        return out


def plan_from_present(
    omega: float,
    dcm: Array,
    cop: Array,
    durations: Sequence[float],
    cop_ends: Sequence[Array],
    into_support: Callable[[Array], Array],
    shortest: float,
) -> DcmPlan:
    """A plan that starts at the present DCM and CoP as far as the support polygon allows.

    The CoP goes through one point halfway in the first phase that is chosen so that the planned DCM starts at the
    present one. Where the point would lie outside the support polygon the plan starts off the present DCM, and the
    distance is left to feedback.

    Args:
        omega: sqrt(gravity / CoM height) [1/s].
        dcm: present DCM, (2,) [m].
        cop: present CoP, (2,) [m].
        durations: of the phases, the rest of the present one first [s].
        cop_ends: CoP at the end of each phase, (2,) [m].
        into_support: nearest point of the present support polygon.
        shortest: a present phase with less time left keeps a straight CoP line [s].
    """
    if durations[0] < shortest:
        return DcmPlan(omega, durations, [cop, *cop_ends])
    later = DcmPlan(omega, durations[1:], cop_ends).reference(0.0)[0] if len(durations) > 1 else cop_ends[0]
    half = 0.5 * durations[0]
    decay, share = _weights(omega, half)
    rest = later * decay**2 + cop_ends[0] * (share - decay) * decay + cop * (1.0 - share)
    middle = into_support((dcm - rest) / (share * (1.0 - decay)))
    return DcmPlan(omega, [half, half, *durations[1:]], [cop, middle, *cop_ends])


def _weights(omega: float, duration: float) -> tuple[float, float]:
    """Decay of the DCM backward over a piece, and the mean of that decay over it."""
    decay = float(np.exp(-omega * duration))
    return decay, (1.0 - decay) / (omega * duration)
