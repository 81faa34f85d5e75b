"""What a module must offer to be a subject of `lookstep bench`."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import Any, Protocol

from rich.table import Table


class Report(Protocol):
    """What a benchmark has found out."""

    def as_json(self) -> dict[str, Any]:
        """The figures under the names that programs read; not a number is None."""
        ...

    def tables(self) -> Sequence[Table]:
        """The figures for people; cells are plain text."""
        ...


class Progress(Protocol):
    """Is told how far a benchmark has come."""

    def __call__(self, doing: str, done: int, total: int) -> None:
        """Now at `done` of `total` of what it is doing."""
        ...


class Subject(Protocol):
    """A module that measures one part."""

    @property
    def NAME(self) -> str:
        """How it is called: `lookstep bench NAME`."""
        ...

    @property
    def HELP(self) -> str:
        """One line, in small letters."""
        ...

    @property
    def EXAMPLE(self) -> str:
        """One command line that works."""
        ...

    def add_arguments(self, parser: argparse.ArgumentParser, /) -> None:
        """Declare what this subject takes besides --json, --table and --quick."""
        ...

    def measure(self, options: argparse.Namespace, progress: Progress, /) -> Report:
        """Measure; `options.quick` asks for the same figures in under 45 s on two cores."""
        ...
