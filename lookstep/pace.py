"""How fast robot time may run beside wall time: held back to a speed, halted, and let on tick by tick."""

from __future__ import annotations

import time as wall
from dataclasses import dataclass
from threading import Condition

_MOST_LAG = 0.5  # Who falls further behind does not hurry to catch up [s].


@dataclass(frozen=True, slots=True)
class PaceState:
    """How a simulation is paced.

    Attributes:
        speed: robot time per wall time; as fast as possible where None.
        halted: whether robot time stands still.
    """

    speed: float | None
    halted: bool


class Pace:
    """Holds robot time back; the loop waits, and any thread may change how long.

    Args:
        speed: robot time per wall time; as fast as possible where None.
    """

    def __init__(self, speed: float | None) -> None:
        self._changed = Condition()
        self._speed = speed
        self._halted = False
        self._steps = 0
        self._started = wall.perf_counter()
        self._origin: tuple[float, float] | None = (0.0, self._started)

    @property
    def elapsed(self) -> float:
        """Wall time since the start [s]."""
        return wall.perf_counter() - self._started

    @property
    def state(self) -> PaceState:
        """How it stands."""
        with self._changed:
            return PaceState(self._speed, self._halted)

    def set_speed(self, speed: float | None) -> None:
        """Run at another speed from now on.

        Raises:
            ValueError: where it is not positive.
        """
        if speed is not None and not 0.0 < speed < float("inf"):
            raise ValueError(f"got a speed of {speed!r}, needs a positive number")
        with self._changed:
            self._speed, self._origin = speed, None

    def halt(self) -> None:
        """Let robot time stand still from the next tick on."""
        with self._changed:
            self._halted, self._steps = True, 0

    def go(self) -> None:
        """Let it run again."""
        with self._changed:
            self._halted, self._origin = False, None
            self._changed.notify_all()

    def step(self) -> None:
        """Let one tick pass while it is halted."""
        with self._changed:
            if self._halted:
                self._steps += 1
                self._changed.notify_all()

    def wait_to_go(self) -> None:
        """Before a tick: wait while robot time stands still."""
        with self._changed:
            self._changed.wait_for(lambda: not self._halted or self._steps > 0)
            self._steps = max(0, self._steps - 1)

    def wait_until(self, time: float) -> None:
        """Sleep until the wall has caught up with a robot time [s]."""
        with self._changed:
            speed, now = self._speed, wall.perf_counter()
            if speed is None:
                return
            if self._origin is None or now - self._origin[1] > (time - self._origin[0]) / speed + _MOST_LAG:
                self._origin = (time, now)
            due = self._origin[1] + (time - self._origin[0]) / speed
        wall.sleep(max(0.0, due - now))
