"""What one tick of the walking controller takes, part by part, over a walk on blocks in physics.

The parts are measured from outside: for the time of the measurement their methods are replaced by ones that look at the
clock. A fixed calibration kernel runs in between, so that times of two machines, or of two hours, can be compared.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from typing import Any
from unittest import mock

import numpy as np
import osqp

from lookstep.bench.timing import Timing
from lookstep.bench.walking.calibration import CalibrationKernel
from lookstep.bench.walking.known_walks import KnownWalk
from lookstep.configuration import Configuration
from lookstep.world import build_world
from skills.walking import Walker
from skills.walking.balance import Balance
from skills.walking.body_dynamics import BodyDynamics
from skills.walking.quadratic_program import OsqpSolver
from skills.walking.whole_body_controller import WholeBodyController

_PERIOD = 0.1  # The calibration kernel runs this often, in robot time [s].
_WARM_UP = 0.5  # not measured [s]

# Class and method of each part; some hold others.
_METHODS: dict[str, tuple[type, str]] = {
    "tick": (Walker, "control"),
    "dynamics": (BodyDynamics, "update"),
    "balance": (Balance, "control"),
    "whole_body": (WholeBodyController, "solve"),
    "solver": (OsqpSolver, "solve"),
    "factorise": (osqp.OSQP, "update"),
    "iterate": (osqp.OSQP, "solve"),
}


@dataclass(frozen=True, slots=True)
class TickTimes:
    """Times of ticks.

    Attributes:
        ticks: how many were measured.
        tick: of whole ticks.
        parts: of each part by its name; they add up to a tick.
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
    kernel = CalibrationKernel()
    times: dict[str, list[float]] = {name: [] for name in _METHODS}
    while len(times["tick"]) < ticks:
        walk = next(walks)
        world = build_world(walk.course, configuration, "physics")
        world.advance(_WARM_UP)
        world.send_footsteps(walk.steps)
        with _measured(times):
            while world.time < walk.duration and len(times["tick"]) < ticks:
                world.advance(_PERIOD)
                kernel.run()
    return TickTimes(len(times["tick"]), Timing.of(times["tick"]), _parts(times), Timing.of(kernel.times))


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


def _parts(times: dict[str, list[float]]) -> dict[str, Timing]:
    """Own time of each part: what it holds of other parts is taken out."""
    at = {name: np.array(values) for name, values in times.items()}
    outside = at["tick"] - at["dynamics"] - at["balance"] - at["whole_body"]
    parts = {
        "dynamics": at["dynamics"],
        "balance": at["balance"],
        "program": at["whole_body"] - at["factorise"] - at["iterate"],
        "factorise": at["factorise"],
        "iterate": at["iterate"],
        "gait_and_tasks": outside,
    }
    return {name: Timing.of(list(values)) for name, values in parts.items()}


@contextmanager
def _measured(times: dict[str, list[float]]) -> Iterator[None]:
    """Let the methods note their times."""
    with ExitStack() as stack:
        for name, (owner, method) in _METHODS.items():
            wrapped = _noting(getattr(owner, method), times[name])
            stack.enter_context(mock.patch.object(owner, method, wrapped))
        yield


def _noting(function: Callable[..., Any], times: list[float]) -> Callable[..., Any]:
    def noted(*arguments: Any, **options: Any) -> Any:
        started = time.thread_time()
        result = function(*arguments, **options)
        times.append(time.thread_time() - started)
        return result

    return noted


def _as_json(timing: Timing) -> dict[str, float]:
    return {"median": timing.median_ms, "p99": timing.p99_ms}
