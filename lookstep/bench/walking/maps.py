"""Maps of what the walking controller can do: pushes by force and direction, speeds by step length and timing."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from rich.table import Table

from lookstep.bench.walking.cases import push_trial
from lookstep.bench.walking.known_walks import Cadence, flat_walk
from lookstep.bench.walking.trial import Trial, TrialResult

_FORCES = (200, 400, 600, 800)
_DIRECTIONS, _PHASES = 8, 4
_LENGTHS = (0.3, 0.4, 0.5, 0.6)
_TIMINGS = ((1.2, 0.8), (0.8, 0.3), (0.6, 0.2), (0.5, 0.15), (0.45, 0.05))
_SPEED_STEPS = 14


@dataclass(frozen=True, slots=True)
class WalkingMap:
    """Successes by two quantities.

    Attributes:
        name: for programs.
        title: for people.
        rows, columns: what the cells differ in, as read.
        cells: (succeeded, tried) by row and column.
    """

    name: str
    title: str
    rows: Sequence[str]
    columns: Sequence[str]
    cells: Mapping[tuple[str, str], tuple[int, int]]

    def as_json(self) -> dict[str, Any]:
        """Cells by row and column."""
        return {
            row: {column: dict(zip(("ok", "of"), self.cells[row, column], strict=True)) for column in self.columns}
            for row in self.rows
        }

    def table(self) -> Table:
        """One row a row."""
        table = Table(title=self.title, title_justify="left")
        table.add_column("")
        for column in self.columns:
            table.add_column(column, justify="right")
        for row in self.rows:
            table.add_row(row, *("{}/{}".format(*self.cells[row, column]) for column in self.columns))
        return table


def push_map_trials() -> list[Trial]:
    """Every force, direction and phase on level ground."""
    return [
        push_trial(f"push_map/{force} N/{_direction(direction)}", force, direction, phase)
        for force in _FORCES
        for direction in range(_DIRECTIONS)
        for phase in range(_PHASES)
    ]


def speed_map_trials(seeds: int) -> list[Trial]:
    """Every step length and timing on level ground, over several seeds of friction and first foot."""
    trials = []
    for length in _LENGTHS:
        for swing, transfer in _TIMINGS:
            for seed in range(seeds):
                rng = np.random.default_rng(seed)
                walk = flat_walk(_SPEED_STEPS, Cadence(length, swing, transfer), rng)
                name = f"speed_map/{length:g} m/{swing:g} + {transfer:g} s"
                trials.append(Trial(name, seed, walk, physics={"friction": rng.uniform(0.5, 1.0)}))
    return trials


def maps_of(results: Sequence[TrialResult]) -> list[WalkingMap]:
    """The maps that results belong to; those of cases are left out."""
    titles = {
        "push_map": "Pushes of 0.1 s while walking at 0.8/0.3 s: directions from forward to the left, 4 phases each",
        "speed_map": "Step length by swing + transfer, on level ground",
    }
    return [_map_of(name, title, results) for name, title in titles.items() if _of_map(name, results)]


def _of_map(name: str, results: Sequence[TrialResult]) -> list[TrialResult]:
    return [result for result in results if result.case.startswith(f"{name}/")]


def _map_of(name: str, title: str, results: Sequence[TrialResult]) -> WalkingMap:
    cells: dict[tuple[str, str], tuple[int, int]] = {}
    # Results come as they are ready; rows and columns in order of their numbers.
    for result in sorted(_of_map(name, results), key=lambda result: (_number(result.case, 1), _number(result.case, 2))):
        _, row, column = result.case.split("/")
        ok, tried = cells.get((row, column), (0, 0))
        cells[row, column] = ok + result.ok, tried + 1
    rows, columns = (list(dict.fromkeys(key[i] for key in cells)) for i in range(2))
    return WalkingMap(name, title, rows, columns, cells)


def _direction(direction: int) -> str:
    return f"{360 * direction // _DIRECTIONS} deg"


def _number(case: str, place: int) -> float:
    return float(case.split("/")[place].split()[0])
