"""Makes the walks of a suite that a file of rows does not have yet, in processes of their own."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import closing, nullcontext
from pathlib import Path

from lookstep.bench.subject import Progress
from lookstep.evaluation.report import EvaluationReport, Group
from lookstep.evaluation.run_row import RowFile, RunRow, read_rows, run, specification
from lookstep.evaluation.suite import Case, Suite
from lookstep.options import RunOptions
from lookstep.process_pool import run_in_processes
from lookstep.walk import check_options

SeedsOf = Callable[[Case], Sequence[int]]


def evaluate(
    suite: Suite, seeds_of: SeedsOf, progress: Progress, *, workers: int, jsonl: Path | None = None
) -> EvaluationReport:
    """Walk every case of a suite over its seeds, in each of its worlds.

    Args:
        suite: the cases.
        seeds_of: the seeds of a case.
        progress: is told how far it is.
        workers: processes that walk at the same time.
        jsonl: file of rows: walks that it has are not made again, others are added; None for no file.

    Raises:
        YamlError, UserError: where the input is not usable; no walk has been made then.
    """
    plan = [(case, world, list(seeds_of(case))) for case in suite.cases for world in suite.worlds]
    for case, world, seeds in plan:
        check_options(case.options(seeds[0], world))
    rows = {row.key: row for row in read_rows(jsonl)} if jsonl is not None else {}
    wanted = [case.options(seed, world) for case, world, seeds in plan for seed in seeds]
    missing = list({specification(options): options for options in wanted}.values())
    missing = [options for options in missing if specification(options) not in rows]
    done = len(wanted) - len(missing)
    with nullcontext() if jsonl is None else closing(RowFile(jsonl)) as file:
        for row in run_in_processes(run, missing, workers):
            rows[row.key] = row
            done += 1
            if file is not None:
                file.add(row)
            progress(_told(row), done, len(wanted))
    groups = [
        Group(case, world, tuple(rows[specification(case.options(seed, world))] for seed in seeds))
        for case, world, seeds in plan
    ]
    return EvaluationReport(suite.about, tuple(groups), workers)


def _told(row: RunRow) -> str:
    options: RunOptions = row.options
    return f"{options.course} seed {options.seed} {options.world}: {row.outcome.value}"
