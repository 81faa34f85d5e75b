"""One walk of an evaluation, and its row in a file of rows: JSON, one line a walk.

A file that has a row of the same specification has that walk already; it is not made again.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from lookstep.errors import UserError
from lookstep.options import RunOptions
from lookstep.summary import Outcome, Summary
from lookstep.walk import INTERRUPTED, walk
from strict_yaml import YamlError, shipped_folder

# What of a walk's options has a say in how it goes.
_DECIDING = ("tree", "course", "seed", "world", "executor", "goal", "time_limit", "robot", "preset", "assignments")
_PACKAGES = ("lookstep", "behaviors", "sim_envs", "skills", "strict_yaml")


@dataclass(frozen=True, slots=True, kw_only=True)
class RunRow:
    """How one walk went.

    Attributes:
        options: what ran.
        code: hash of the code, trees and configuration with which it ran.
        summary: its figures; None where it broke off.
        error: the exception with which it broke off; empty where it did not.
    """

    options: RunOptions
    code: str
    summary: Summary | None
    error: str = ""

    @property
    def key(self) -> str:
        """The same for two rows of one specification."""
        return specification(self.options)

    @property
    def outcome(self) -> Outcome:
        """How it ended."""
        return Outcome.ERROR if self.summary is None else self.summary.outcome

    @property
    def reason(self) -> str:
        """Why it ended so."""
        return self.error if self.summary is None else self.summary.reason

    def to_json(self) -> str:
        """One line."""
        row = {
            "specification": json.loads(self.key),
            "code": self.code,
            "error": self.error,
            "summary": None if self.summary is None else json.loads(self.summary.to_json()),
        }
        return json.dumps(row, allow_nan=False)

    @classmethod
    def from_json(cls, line: str) -> RunRow:
        """Read what `to_json` wrote.

        Raises:
            ValueError: where it is not a row of this version.
        """
        row = json.loads(line)
        try:
            summary = None if row["summary"] is None else Summary.from_json(json.dumps(row["summary"]))
            return cls(options=_options(row["specification"]), code=row["code"], summary=summary, error=row["error"])
        except (KeyError, TypeError) as error:
            raise ValueError(f"not a row of this version of lookstep: {error}") from error


def run(options: RunOptions) -> RunRow:
    """Walk once; what breaks a walk off is told in its row, so that the others go on.

    Raises:
        YamlError, UserError: where the input is not usable.
        KeyboardInterrupt: where somebody has ended the walk, which says nothing of it.
    """
    try:
        summary = walk(options)
    except (YamlError, UserError):
        raise
    except Exception as error:
        return RunRow(options=options, code=code_hash(), summary=None, error=f"{type(error).__name__}: {error}")
    if summary.reason == INTERRUPTED:
        raise KeyboardInterrupt
    return RunRow(options=options, code=code_hash(), summary=summary)


def specification(options: RunOptions) -> str:
    """All of a walk's options that have a say in how it goes, as JSON."""
    return json.dumps({name: getattr(options, name) for name in _DECIDING})


def read_rows(path: Path) -> list[RunRow]:
    """The rows of a file; none where there is no file. A last line that was not finished does not count.

    Raises:
        UserError: where a line is no row.
    """
    return list(_rows(path)) if path.exists() else []


class RowFile:
    """A file that rows are added to; what was not finished at its end is cut off."""

    def __init__(self, path: Path) -> None:
        self._file = path.open("a+b")
        self._file.seek(0)
        whole = self._file.read().rfind(b"\n") + 1
        self._file.truncate(whole)

    def add(self, row: RunRow) -> None:
        """Write a row and see that it is in the file."""
        self._file.write(row.to_json().encode() + b"\n")
        self._file.flush()

    def close(self) -> None:
        """Close the file."""
        self._file.close()


@cache
def code_hash() -> str:
    """Hash of all sources, trees and configuration."""
    digest = hashlib.blake2b(digest_size=8)
    root = Path(__file__).resolve().parents[2]
    folders = [(root / name, "*.py") for name in _PACKAGES]
    folders += [(shipped_folder(name), "*.yaml") for name in ("trees", "config")]
    for folder, pattern in folders:
        for source in sorted(folder.rglob(pattern)):
            digest.update(str(source.relative_to(folder)).encode())
            digest.update(source.read_bytes())
    return digest.hexdigest()


def _rows(path: Path) -> Iterator[RunRow]:
    with path.open(encoding="utf-8") as file:
        for number, line in enumerate(file, 1):
            if not line.endswith("\n"):
                return
            try:
                yield RunRow.from_json(line)
            except ValueError as error:
                raise UserError(f"{path}:{number}: {error}") from error


def _options(table: dict[str, Any]) -> RunOptions:
    fields: dict[str, Any] = {key: tuple(value) if isinstance(value, list) else value for key, value in table.items()}
    return RunOptions(**fields)
