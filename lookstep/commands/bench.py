"""`lookstep bench`: figures of one part, beside ground truth, baselines and peers."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING

from lookstep.bench.footsteps import command as footsteps
from lookstep.bench.perception import command as perception
from lookstep.bench.tree import command as tree
from lookstep.bench.walking import command as walking
from lookstep.errors import UserError

if TYPE_CHECKING:
    from lookstep.bench.subject import Subject

NAME = "bench"
HELP = "measure one part beside ground truth, baselines and peers"
EXAMPLE = "lookstep bench perception --quick"

SUBJECTS: tuple[Subject, ...] = (perception, footsteps, walking, tree)


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the subjects and what each of them takes."""
    subparsers = parser.add_subparsers(title="subjects", metavar="SUBJECT", required=True)
    for subject in SUBJECTS:
        subparser = subparsers.add_parser(
            subject.NAME,
            help=subject.HELP,
            description=subject.HELP[0].upper() + subject.HELP[1:] + ".",
            epilog=f"example:\n  {subject.EXAMPLE}",
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        subparser.add_argument("--json", type=Path, metavar="FILE", help="write the figures for programs")
        subparser.add_argument("--table", type=Path, metavar="FILE", help="write the tables as Markdown")
        subparser.add_argument("--quick", action="store_true", help="the same figures from less, in under 45 s")
        subject.add_arguments(subparser)
        subparser.set_defaults(subject=subject)


def execute(options: argparse.Namespace) -> int:
    """Measure, print and write."""
    for option in ("json", "table"):
        file = getattr(options, option)
        if file is not None and not file.parent.is_dir():
            raise UserError(f"--{option} {file}: the folder {file.parent} does not exist")
    from rich.console import Console

    from lookstep.bench.markdown import markdown

    with _Bar() as bar:
        report = options.subject.measure(options, bar)
    tables = report.tables()
    console = Console()
    for table in tables:
        console.print(table)
    if options.json is not None:
        options.json.write_text(json.dumps(report.as_json(), indent=2, allow_nan=False) + "\n")
    if options.table is not None:
        options.table.write_text(markdown(tables))
    return 0


class _Bar:
    """A progress bar on standard error."""

    def __init__(self) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

        columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
        self._progress = Progress(*columns, console=Console(stderr=True), transient=True)
        self._task = self._progress.add_task("preparing", total=None)

    def __call__(self, doing: str, done: int, total: int) -> None:
        self._progress.update(self._task, description=doing, completed=done, total=total)

    def __enter__(self) -> _Bar:
        self._progress.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._progress.stop()
