"""Ticks both trees in turn and compares; time of the thread, so that other programs on the machine do not count."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from rich.table import Table

from behaviors import Trace
from lookstep.bench.machine import machine
from lookstep.bench.subject import Progress
from lookstep.bench.tree.subjects import NODES, our_tree, plain_tree
from lookstep.summary import installed_versions

_TICKS = 200


@dataclass(frozen=True, slots=True)
class TreeReport:
    """Times of single ticks [us].

    Attributes:
        ours: with ports, trace and deadlines.
        written: the same with the trace written to a file.
        plain: of plain py_trees.
        ratios: of our median to the plain one, by round.
    """

    ours: Sequence[float]
    written: Sequence[float]
    plain: Sequence[float]
    ratios: Sequence[float]

    def as_json(self) -> dict[str, Any]:
        """The figures under the names that programs read."""
        figures: dict[str, Any] = {"nodes": NODES, "ticks": len(self.ours)}
        for name, times in (("tick_us", self.ours), ("written_tick_us", self.written), ("plain_tick_us", self.plain)):
            figures[f"{name}_median"] = round(float(np.median(times)), 1)
            figures[f"{name}_p99"] = round(float(np.percentile(times, 99)), 1)
        figures["ratio"] = round(float(np.median(self.ratios)), 3)
        return {**figures, "machine": machine(), "versions": installed_versions()}

    def tables(self) -> Sequence[Table]:
        """The figures for people."""
        figures = self.as_json()
        table = Table(title=f"One tick of {NODES} nodes", caption=f"ratio of medians, by round: {figures['ratio']:.2f}")
        for column in ("tree", "median [us]", "p99 [us]"):
            table.add_column(column, justify="left" if column == "tree" else "right")
        for name, key in (
            ("lookstep: ports, trace, deadlines", "tick_us"),
            ("the same, trace written to a file", "written_tick_us"),
            ("plain py_trees", "plain_tick_us"),
        ):
            table.add_row(name, f"{figures[f'{key}_median']:.0f}", f"{figures[f'{key}_p99']:.0f}")
        return [table]


def bench_tree(progress: Progress, *, rounds: int) -> TreeReport:
    """Tick the trees in turn, `rounds` times 200 ticks each."""
    tree, robot = our_tree()
    with tempfile.TemporaryDirectory() as folder:
        writing, other_robot = our_tree(Trace(Path(folder) / "trace.jsonl"))
        plain = plain_tree()
        plain.tick_once()
        assert len(tree.nodes) == NODES == sum(1 for _ in plain.iterate())

        def tick_ours() -> None:
            robot.time = tree.next_tick_time
            tree.tick()

        def tick_writing() -> None:
            other_robot.time = writing.next_tick_time
            writing.tick()

        times: dict[str, list[float]] = {"ours": [], "written": [], "plain": []}
        ratios = []
        for index in range(rounds + 1):
            progress("ticking", index, rounds + 1)
            round_times = {
                "ours": _times(tick_ours),
                "written": _times(tick_writing),
                "plain": _times(plain.tick_once),
            }
            if index == 0:
                continue  # Warms up.
            for name, found in round_times.items():
                times[name] += found
            ratios.append(float(np.median(round_times["ours"]) / np.median(round_times["plain"])))
        assert not tree.faults and not writing.faults
        tree.shutdown()
        writing.shutdown()
    return TreeReport(times["ours"], times["written"], times["plain"], ratios)


def _times(tick: Callable[[], None]) -> list[float]:
    times = []
    for _ in range(_TICKS):
        started = time.thread_time_ns()
        tick()
        times.append((time.thread_time_ns() - started) / 1e3)
    return times
