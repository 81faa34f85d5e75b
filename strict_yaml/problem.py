"""What is wrong with a YAML file and where: problems are collected and told all at once, in the order of the file."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from dataclasses import dataclass


@dataclass(frozen=True, slots=True, order=True)
class Location:
    """A place in a file; line and column count from 1, as editors do.

    Line 0 stands for what is no file, such as an option of the command line.
    """

    file: str
    line: int
    column: int

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}" if self.line else self.file


@dataclass(frozen=True, slots=True, order=True)
class Problem:
    """One thing wrong with a file.

    Attributes:
        location: where it is written.
        message: what is wrong, the value got and what is allowed.
        node_path: the node it belongs to, such as `objects[3].size`; may be empty.
    """

    location: Location
    message: str
    node_path: str = ""

    def __str__(self) -> str:
        subject = f"{self.node_path}: " if self.node_path else ""
        return f"{self.location}: {subject}{self.message}"


class YamlError(Exception):
    """A YAML file that cannot be used; prints one problem a line, in the order of the file."""

    def __init__(self, problems: Iterable[Problem]) -> None:
        self.problems = tuple(sorted(problems))
        super().__init__("\n".join(str(problem) for problem in self.problems))


def nearest(name: str, allowed: Iterable[str]) -> str:
    """The tail of an error message: `; did you mean "X"?` for the most similar allowed name, or nothing."""
    matches = difflib.get_close_matches(name, sorted(allowed), n=1)
    return f'; did you mean "{matches[0]}"?' if matches else ""
