"""The comments of YAML text, and which of the things written there each is about."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass

from ruamel.yaml import YAML
from ruamel.yaml.events import ScalarEvent

from behaviors.interchange.written import Comments


@dataclass(frozen=True, slots=True)
class _Comment:
    line: int
    text: str
    stands_alone: bool


class CommentTable:
    """Comments by the line of the thing that they are about.

    A comment on a line of its own is about the next thing; one behind something is about that.

    Args:
        text: of the file, which is sound YAML.
        lines: on which things are written, from 1.
    """

    def __init__(self, text: str, lines: Iterable[int]) -> None:
        anchors = sorted(set(lines))
        self._above: dict[int, list[str]] = {}
        self._behind: dict[int, str] = {}
        self.end: tuple[str, ...] = ()
        for comment in _comments(text):
            later = [line for line in anchors if line > comment.line]
            earlier = [line for line in anchors if line <= comment.line]
            if not comment.stands_alone and earlier and earlier[-1] not in self._behind:
                self._behind[earlier[-1]] = comment.text
            elif later:
                self._above.setdefault(later[0], []).append(comment.text)
            else:
                self.end = (*self.end, comment.text)

    def take(self, line: int) -> Comments:
        """Those about what is written on a line; once, for the first thing on it."""
        return Comments(tuple(self._above.pop(line, ())), self._behind.pop(line, ""))


def _comments(text: str) -> list[_Comment]:
    """All comments, without those that are part of a quoted or block text."""
    spans = [
        (event.start_mark.index, event.end_mark.index)
        for event in YAML(typ="safe", pure=True).parse(text)
        if isinstance(event, ScalarEvent) and event.style is not None
    ]
    found, start = [], 0
    for number, line in enumerate(text.splitlines(keepends=True), 1):
        for match in re.finditer(r"(?:^|(?<=\s))#", line):
            index = start + match.start()
            if not any(low <= index < high for low, high in spans):
                content = line[match.start() :].rstrip()
                found.append(_Comment(number, content, not line[: match.start()].strip()))
                break
        start += len(line)
    return found
