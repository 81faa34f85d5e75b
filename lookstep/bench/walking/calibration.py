"""A fixed piece of work whose time says how fast the machine is while something else is measured.

It is what a control tick is made of: interpreted Python, small dense products, and a factorisation.
"""

from __future__ import annotations

import time

import numpy as np

_SIZE = 61
_PRODUCTS, _ADDITIONS = 4, 500


class CalibrationKernel:
    """The work, and the times that it has taken [s]."""

    def __init__(self) -> None:
        rng = np.random.default_rng(0)
        self._matrix = rng.standard_normal((_SIZE, _SIZE))
        self._regular = self._matrix @ self._matrix.T + _SIZE * np.eye(_SIZE)
        self._right = rng.standard_normal(_SIZE)
        self.times: list[float] = []

    def run(self) -> float:
        """Do it once and note the time; what was computed, so that nothing can be left out."""
        started = time.thread_time()
        total = 0.0
        for index in range(_ADDITIONS):
            total += 0.5 * index
        for _ in range(_PRODUCTS):
            total += float((self._matrix @ self._matrix)[0, 0])
        total += float(np.linalg.solve(self._regular, self._right)[0])
        self.times.append(time.thread_time() - started)
        return total
