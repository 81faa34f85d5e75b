"""When ticks are due: at multiples of the period on the robot's clock, counted from the first tick."""

from __future__ import annotations

import math

# Robot times are multiples of the control period up to rounding; a tick in time must not count as one too early.
_TIME_TOLERANCE = 1e-9


class ClockError(RuntimeError):
    """The robot's clock ran backwards."""


class Timetable:
    """Due times of ticks.

    Attributes:
        period: robot time between two ticks [s].
        lateness: robot time by which the last tick came after its due time [s].
    """

    def __init__(self, rate: float) -> None:
        self.period = 1.0 / rate
        self.lateness = 0.0
        self._first: float | None = None
        self._last = -math.inf
        self._index = 0

    def next_time(self, now: float) -> float:
        """Robot time at which the next tick is due; now, before the first [s]."""
        return now if self._first is None else self._first + self._index * self.period

    def tick_at(self, time: float) -> None:
        """Note a tick at this robot time; ticks that were missed before it are not made up for.

        Raises:
            ClockError: where the last tick was later.
        """
        if time < self._last:
            last, self._last = self._last, time
            raise ClockError(f"robot time went back from {last:.6f} s to {time:.6f} s")
        self.lateness = time - self.next_time(time)
        self._last = time
        if self._first is None:
            self._first = time
        self._index = math.floor((time - self._first + _TIME_TOLERANCE) / self.period) + 1
