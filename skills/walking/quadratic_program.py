"""A convex quadratic program of fixed sparsity, and OSQP as its solver.

    minimize  1/2 x' P x + q' x   subject to   lower <= A x <= upper

Every control tick has other numbers in the same places, so the sparsity is told once and values are sent after that
(Stellato et al., "OSQP: an operator splitting solver for quadratic programs", 2020). The step size adapts by iteration
count and never by time, so that a run can be repeated to the last bit.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Protocol

import numpy as np
import osqp
from numpy.typing import NDArray
from scipy import sparse

from skills.geometry.pose import Array, Mask


class QpStatus(Enum):
    """How a quadratic program ended."""

    SOLVED = "solved"
    INACCURATE = "inaccurate"
    FAILED = "failed"


@dataclass(frozen=True, slots=True, eq=False)
class QpSolution:
    """What a solver found.

    Attributes:
        x: the minimiser, (N,); the best iterate where inaccurate, of no meaning where failed.
        status: how it ended.
        iterations: made by the solver.
        time: that it took by the solver's own clock, which decides nothing [s].
    """

    x: Array
    status: QpStatus
    iterations: int
    time: float = 0.0


class QpSolver(Protocol):
    """Solves one quadratic program after another, all of one sparsity."""

    def solve(self, P: Array, q: Array, A: Array, lower: Array, upper: Array) -> QpSolution:
        """Solve a program given by dense P (N, N), q (N,), A (M, N) and bounds (M,)."""
        ...


# Of a program with the given patterns of P and A.
MakeSolver = Callable[[Mask, Mask], QpSolver]


class OsqpSolver:
    """OSQP with a warm start.

    Args:
        P_pattern, A_pattern: where P (N, N) and A (M, N) may have values, boolean.
        tolerance: absolute and relative.
        max_iterations: after which an inaccurate solution is returned.
        check_every: iterations between looks at the residuals.
    """

    def __init__(
        self, P_pattern: Mask, A_pattern: Mask, tolerance: float, max_iterations: int, check_every: int
    ) -> None:
        self._P_pattern, self._A_pattern = np.triu(P_pattern), A_pattern
        self._P_places, self._A_places = _places(self._P_pattern), _places(A_pattern)
        self._settings = {
            "eps_abs": tolerance,
            "eps_rel": tolerance,
            "max_iter": max_iterations,
            "check_termination": check_every,
            "adaptive_rho": 1,
            "adaptive_rho_interval": check_every,
            "warm_starting": True,
            "polishing": False,
            # Both residuals are checked; the gap besides costs iterations and brings no better torques.
            "check_dualgap": False,
            "verbose": False,
        }
        self._solver = self._fresh_solver()

    def solve(self, P: Array, q: Array, A: Array, lower: Array, upper: Array) -> QpSolution:
        """Solve one program, starting from the solution of the one before."""
        self._solver.update(Px=P.take(self._P_places), Ax=A.take(self._A_places), q=q, l=lower, u=upper)
        result = self._solver.solve(raise_error=False)
        x = np.array(result.x)
        status = _STATUS.get(result.info.status, QpStatus.FAILED)
        if not np.all(np.isfinite(x)):
            status = QpStatus.FAILED
        if status is QpStatus.FAILED:
            # Iterates and step size that are no numbers any more would spoil every program to come.
            self._solver = self._fresh_solver()
        return QpSolution(x, status, int(result.info.iter), float(result.info.run_time))

    def _fresh_solver(self) -> osqp.OSQP:
        m, n = self._A_pattern.shape
        P, A = _with_pattern(self._P_pattern), _with_pattern(self._A_pattern)
        solver = osqp.OSQP()
        solver.setup(P, np.zeros(n), A, np.full(m, -1.0), np.full(m, 1.0), **self._settings)
        return solver


# OSQP's own words for how it ended; all others mean that there is no usable solution.
_STATUS = {
    "solved": QpStatus.SOLVED,
    "solved inaccurate": QpStatus.INACCURATE,
    "maximum iterations reached": QpStatus.INACCURATE,
}


def _places(pattern: Mask) -> NDArray[np.intp]:
    """Where a matrix has its values, column by column as OSQP stores them, counted row by row as numpy does."""
    columns, rows = np.nonzero(pattern.T)
    return rows * pattern.shape[1] + columns


def _with_pattern(pattern: Mask) -> sparse.csc_matrix:
    """A sparse matrix of ones with explicit places for all of a pattern."""
    return sparse.csc_matrix(np.asarray(pattern, dtype=np.float64))
