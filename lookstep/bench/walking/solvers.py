"""Solvers side by side on the programs of a walk: time, and how far each is from the exact solution.

Programs are logged in runs of consecutive ticks, so that a warm start has what it has in a walk. How two feet share the
weight is only weakly determined, so torques of equally good solutions differ; what is compared is the accelerations as
the objective weighs them, and the net force of the ground.
"""

from __future__ import annotations

import importlib
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from types import ModuleType
from typing import Any
from unittest import mock

import numpy as np

from lookstep.bench.timing import Timing
from lookstep.bench.walking.known_walks import KnownWalk
from lookstep.configuration import Configuration
from lookstep.world import build_world
from skills.geometry.pose import Array
from skills.walking.quadratic_program import OsqpSolver, QpSolution
from skills.walking.whole_body_parameters import WholeBodyParameters

_RUN, _RUNS_APART = 0.2, 1.0  # a run of consecutive programs lasts so long, and begins this often, in robot time [s]
_REST = 1.0  # The first programs, of a robot that stands, are left out [s].
_INFINITE = 1e30
_BASE = 6  # rows of the pelvis


@dataclass(frozen=True, slots=True, eq=False)
class Program:
    """One program as a solver takes it."""

    P: Array
    q: Array
    A: Array
    lower: Array
    upper: Array


@dataclass(frozen=True, slots=True)
class SolverFigures:
    """How one solver did.

    Attributes:
        name: of the solver.
        timing: of its solutions.
        task_error: median and 99th percentile of the distance from the exact accelerations, weighted as the objective
            weighs them, as a CoM acceleration [m/s^2].
        force_error: of the net force of the ground [N].
        failed: number of programs without a solution.
    """

    name: str
    timing: Timing
    task_error: tuple[float, float]
    force_error: tuple[float, float]
    failed: int

    def as_json(self) -> dict[str, Any]:
        """The figures under the names that programs read."""
        return {
            "ms": {"median": self.timing.median_ms, "p99": self.timing.p99_ms},
            "task_error": {"median": self.task_error[0], "p99": self.task_error[1]},
            "force_error_n": {"median": self.force_error[0], "p99": self.force_error[1]},
            "failed": self.failed,
        }


def log_programs(walk: KnownWalk, configuration: Configuration, most: int) -> list[Program]:
    """Walk once and keep the programs of short runs of consecutive ticks."""
    programs: list[Program] = []
    world = build_world(walk.course, configuration, "physics")
    world.advance(_REST)
    world.send_footsteps(walk.steps)
    while world.time < walk.duration and len(programs) < most:
        with _logging(programs):
            world.advance(_RUN)
        world.advance(_RUNS_APART - _RUN)
    size = max(len(program.q) for program in programs)
    # Step adjustment has small programs of its own.
    return [program for program in programs if len(program.q) == size][:most]


def compare_solvers(programs: Sequence[Program], parameters: WholeBodyParameters) -> list[SolverFigures]:
    """Let every installed solver solve all programs; DAQP's solutions count as exact."""
    joints = programs[0].A.shape[0] - programs[0].P.shape[0]
    motions = _BASE + joints
    solvers: Mapping[str, Callable[[Program], Array] | None] = {
        "DAQP": _daqp(),
        "OSQP": _osqp(programs, parameters),
        "ProxQP": _proxqp(programs),
        "PIQP": _piqp(),
        "quadprog": _quadprog(),
    }
    exact: list[Array] = []
    figures = []
    for name, solve in solvers.items():
        if solve is None:
            continue
        times, found = [], []
        for program in programs:
            started = time.thread_time()
            x = solve(program)
            times.append(time.thread_time() - started)
            found.append(x)
        exact = exact or found
        figures.append(_figures(name, times, found, exact, programs, motions, parameters.com_weight))
    return figures


def _figures(
    name: str,
    times: list[float],
    found: list[Array],
    exact: list[Array],
    programs: Sequence[Program],
    motions: int,
    com_weight: float,
) -> SolverFigures:
    tasks, forces = [], []
    for x, x_exact, program in zip(found, exact, programs, strict=True):
        if not np.all(np.isfinite(x)):
            continue
        off = x - x_exact
        a = off[:motions]
        # The objective has 1/2 P, and P twice the weights.
        tasks.append(np.sqrt(max(0.0, float(a @ program.P[:motions, :motions] @ a) / (2.0 * com_weight))))
        # What the rays push the pelvis with, linear rows; the columns hold -J' W in units of 100 N already.
        forces.append(float(np.linalg.norm(program.A[:3, motions:] @ off[motions:])))
    failed = len(programs) - len(tasks)
    return SolverFigures(name, Timing.of(times), _spread(tasks), _spread(forces), failed)


def _spread(errors: list[float]) -> tuple[float, float]:
    if not errors:
        return float("nan"), float("nan")
    median, p99 = np.percentile(errors, (50, 99))
    return float(f"{median:.3g}"), float(f"{p99:.3g}")


@contextmanager
def _logging(programs: list[Program]) -> Iterator[None]:
    original = OsqpSolver.solve

    def solve(self: OsqpSolver, P: Array, q: Array, A: Array, lower: Array, upper: Array) -> QpSolution:
        programs.append(Program(P.copy(), q.copy(), A.copy(), lower.copy(), upper.copy()))
        return original(self, P, q, A, lower, upper)

    with mock.patch.object(OsqpSolver, "solve", solve):
        yield


def _osqp(programs: Sequence[Program], p: WholeBodyParameters) -> Callable[[Program], Array]:
    """As the controller uses it."""
    P_pattern = np.any([program.P != 0.0 for program in programs], axis=0)
    A_pattern = np.any([program.A != 0.0 for program in programs], axis=0)
    solver = OsqpSolver(P_pattern, A_pattern, p.qp_tolerance, p.qp_iterations, p.qp_check)
    return lambda it: solver.solve(it.P, it.q, it.A, it.lower, it.upper).x


def _daqp() -> Callable[[Program], Array] | None:
    daqp = _module("daqp")
    if daqp is None:
        return None

    def solve(it: Program) -> Array:
        # Equalities are told by their sense, 5; all others are 0.
        sense = np.where(it.lower == it.upper, 5, 0).astype(np.int32)
        lower, upper = np.maximum(it.lower, -_INFINITE), np.minimum(it.upper, _INFINITE)
        x, _, flag, _ = daqp.solve(it.P, it.q, it.A, upper, lower, sense)
        return np.asarray(x) if flag > 0 else np.full(len(it.q), np.nan)

    return solve


def _proxqp(programs: Sequence[Program]) -> Callable[[Program], Array] | None:
    module = _module("proxsuite")
    if module is None:
        return None
    size, rows = len(programs[0].q), len(programs[0].lower)
    qp = module.proxqp.dense.QP(size, _BASE, rows - _BASE)
    qp.settings.eps_abs = 1e-5
    qp.settings.initial_guess = module.proxqp.InitialGuess.WARM_START_WITH_PREVIOUS_RESULT
    begun = False

    def solve(it: Program) -> Array:
        nonlocal begun
        lower, upper = np.maximum(it.lower[_BASE:], -_INFINITE), np.minimum(it.upper[_BASE:], _INFINITE)
        arguments = (it.P, it.q, it.A[:_BASE], it.lower[:_BASE], it.A[_BASE:], lower, upper)
        (qp.update if begun else qp.init)(*arguments)
        begun = True
        qp.solve()
        return np.array(qp.results.x)

    return solve


def _piqp() -> Callable[[Program], Array] | None:
    piqp = _module("piqp")
    if piqp is None:
        return None

    def solve(it: Program) -> Array:
        solver = piqp.DenseSolver()
        solver.setup(it.P, it.q, it.A[:_BASE], it.lower[:_BASE], it.A[_BASE:], it.lower[_BASE:], it.upper[_BASE:])
        return np.array(solver.result.x) if solver.solve() == piqp.PIQP_SOLVED else np.full(len(it.q), np.nan)

    return solve


def _quadprog() -> Callable[[Program], Array] | None:
    quadprog = _module("quadprog")
    if quadprog is None:
        return None

    def solve(it: Program) -> Array:
        A, lower, upper = it.A[_BASE:], it.lower[_BASE:], it.upper[_BASE:]
        low, high = np.isfinite(lower), np.isfinite(upper)
        C = np.vstack((it.A[:_BASE], A[low], -A[high]))
        bounds = np.concatenate((it.lower[:_BASE], lower[low], -upper[high]))
        try:
            return np.array(quadprog.solve_qp(it.P, -it.q, C.T, bounds, meq=_BASE)[0])
        except ValueError:  # no solution, in its words
            return np.full(len(it.q), np.nan)

    return solve


def _module(name: str) -> ModuleType | None:
    try:
        return importlib.import_module(name)
    except ImportError:
        return None
