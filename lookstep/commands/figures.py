"""What commands that measure have in common: where their figures go, and a bar that shows how far they are."""

from __future__ import annotations

import argparse
import json
from pathlib import Path
from types import TracebackType

from lookstep.bench.subject import Report
from lookstep.errors import UserError


def add_figure_options(parser: argparse.ArgumentParser, quick: str) -> None:
    """Declare --json, --table and --quick, with what the last one does."""
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures for programs")
    parser.add_argument("--table", type=Path, metavar="FILE", help="write the tables as Markdown")
    parser.add_argument("--quick", action="store_true", help=quick)


def check_folders(options: argparse.Namespace, *names: str) -> None:
    """See that files can be written before anything is measured.

    Raises:
        UserError: where the folder of one does not exist.
    """
    for name in names:
        file = getattr(options, name)
        if file is not None and not file.parent.is_dir():
            raise UserError(f"--{name} {file}: the folder {file.parent} does not exist")


def publish(report: Report, options: argparse.Namespace) -> None:
    """Print the tables of a report, and write what --json and --table ask for."""
    from lookstep.bench.markdown import markdown
    from lookstep.commands.tables import wide_console

    tables = report.tables()
    console = wide_console()
    for table in tables:
        console.print(table)
    if options.json is not None:
        options.json.write_text(json.dumps(report.as_json(), indent=2, allow_nan=False) + "\n")
    if options.table is not None:
        options.table.write_text(markdown(tables))


class FigureBar:
    """A progress bar on standard error."""

    def __init__(self) -> None:
        from rich.console import Console
        from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

        columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
        self._progress = Progress(*columns, console=Console(stderr=True), transient=True)
        self._task = self._progress.add_task("preparing", total=None)

    def __call__(self, doing: str, done: int, total: int) -> None:
        """Now at so many of so many, and what it is doing."""
        self._progress.update(self._task, description=doing, completed=done, total=total)

    def __enter__(self) -> FigureBar:
        self._progress.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._progress.stop()
