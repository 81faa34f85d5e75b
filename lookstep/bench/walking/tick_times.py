"""What one tick of the walking controller takes, part by part, over a walk on blocks in physics.

The parts are measured from outside: for the time of the measurement their methods are replaced by ones that look at the
clock. A fixed calibration kernel runs in between, so that times of two machines, or of two hours, can be compared.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from itertools import count
from typing import Any
from unittest import mock

import osqp

from lookstep.bench.timing import Timing
from lookstep.bench.walking.calibration import CalibrationKernel
from lookstep.bench.walking.known_walks import KnownWalk
from lookstep.configuration import Configuration
from lookstep.world import build_world
from skills.walking import Walker
from skills.walking.balance import Balance
from skills.walking.body_dynamics import BodyDynamics
from skills.walking.step_adjustment import StepAdjustment
from skills.walking.whole_body_controller import WholeBodyController

_PERIOD = 0.1  # The calibration kernel runs this often, in robot time [s].
_DETAILED = 3  # Every third of these periods is measured part by part.
_WARM_UP = 0.5  # not measured [s]

# Class and method of each part. A part's time is without that of parts that it calls.
_TICK = "gait_and_tasks"
_METHODS: dict[str, tuple[type, str]] = {
    _TICK: (Walker, "control"),
    "dynamics": (BodyDynamics, "update"),
    "balance": (Balance, "control"),
    "step_adjustment": (StepAdjustment, "landing"),
    "program": (WholeBodyController, "solve"),
    "factorise": (osqp.OSQP, "update"),
    "iterate": (osqp.OSQP, "solve"),
}
_WITHOUT_PARTS = "step_adjustment"  # has a small program of its own


@dataclass(frozen=True, slots=True)
class TickTimes:
    """Times of ticks.

    Attributes:
        ticks: how many were measured.
        tick: of whole ticks.
        parts: own time of each part by its name, from other ticks than the whole ones.
        calibration: of the calibration kernel in the same run.
    """

    ticks: int
    tick: Timing
    parts: dict[str, Timing]
    calibration: Timing

    @property
    def ratio(self) -> float:
        """Median tick by the median of the calibration kernel."""
        return round(self.tick.median_ms / self.calibration.median_ms, 3)

    def as_json(self) -> dict[str, Any]:
        """The figures under the names that programs read."""
        return {
            "tick_ms": _as_json(self.tick),
            "tick_parts_ms": {name: _as_json(timing) for name, timing in self.parts.items()},
            "ticks": self.ticks,
            "calibration_ms": _as_json(self.calibration),
            "tick_by_calibration": self.ratio,
        }


@dataclass(frozen=True, slots=True)
class RealtimeFactor:
    """How much robot time a world makes in one second of the thread.

    Attributes:
        world: its kind.
        factor: of the whole world, sensors unread.
        rate: of control [Hz].
    """

    world: str
    factor: float
    rate: float


def measure_ticks(walks: Iterator[KnownWalk], configuration: Configuration, ticks: int) -> TickTimes:
    """Walk one walk after another until so many ticks are measured."""
    # Looking at the clock costs time as well: whole ticks are measured without looking at their parts.
    kernel, whole, detailed = CalibrationKernel(), _Watch((_TICK,)), _Watch(tuple(_METHODS))
    while len(whole.ticks) < ticks:
        walk = next(walks)
        world = build_world(walk.course, configuration, "physics")
        world.advance(_WARM_UP)
        world.send_footsteps(walk.steps)
        for index in count():
            if world.time > walk.duration or len(whole.ticks) >= ticks:
                break
            with (detailed if index % _DETAILED == 0 else whole).watching():
                world.advance(_PERIOD)
            kernel.run()
    tick = Timing.of([parts[_TICK] for parts in whole.ticks])
    parts = {name: Timing.of([parts[name] for parts in detailed.ticks]) for name in _METHODS}
    return TickTimes(len(whole.ticks), tick, parts, Timing.of(kernel.times))


def measure_realtime(walk: KnownWalk, configuration: Configuration, kind: str) -> RealtimeFactor:
    """Walk once and compare robot time with the time of the thread."""
    world = build_world(walk.course, configuration, kind)
    world.advance(_WARM_UP)
    world.send_footsteps(walk.steps)
    started, began = time.thread_time(), world.time
    world.advance(walk.duration)
    factor = (world.time - began) / (time.thread_time() - started)
    rate = configuration.physics.control_rate if kind == "physics" else configuration.kinematic.control_rate
    return RealtimeFactor(kind, round(factor, 2), rate)


class _Watch:
    """Notes how long each part of each tick takes, without the parts that it calls [s]."""

    def __init__(self, parts: tuple[str, ...]) -> None:
        self._parts = parts
        self.ticks: list[dict[str, float]] = []
        self._open: list[str] = []
        self._last = 0.0

    @contextmanager
    def watching(self) -> Iterator[None]:
        """Let the methods note their times."""
        with ExitStack() as stack:
            for name in self._parts:
                owner, method = _METHODS[name]
                stack.enter_context(mock.patch.object(owner, method, self._noting(name, getattr(owner, method))))
            yield

    def _noting(self, name: str, function: Callable[..., Any]) -> Callable[..., Any]:
        def noted(*arguments: Any, **options: Any) -> Any:
            if name == _TICK:
                self.ticks.append(dict.fromkeys(self._parts, 0.0))
            elif not self._open or self._open[-1] == _WITHOUT_PARTS:
                return function(*arguments, **options)
            self._switch()
            self._open.append(name)
            try:
                return function(*arguments, **options)
            finally:
                self._switch()
                self._open.pop()

        return noted

    def _switch(self) -> None:
        """Give the time since the last switch to the innermost part."""
        now = time.thread_time()
        if self._open:
            self.ticks[-1][self._open[-1]] += now - self._last
        self._last = now


def _as_json(timing: Timing) -> dict[str, float]:
    return {"median": timing.median_ms, "p99": timing.p99_ms}
