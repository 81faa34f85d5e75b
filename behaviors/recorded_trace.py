"""Reads the file of a trace back: the tree, and its state after every tick."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from behaviors.trace_file import FORMAT


class TraceError(ValueError):
    """A file that is no trace, or one of another version."""


@dataclass(frozen=True, slots=True)
class RecordedNode:
    """A node as the first line describes it.

    Attributes:
        path, kind: its path, and what the tree file calls it.
        parameters: values by name, as JSON, when the run began.
        inputs, outputs: keys by port.
    """

    path: str
    kind: str
    parameters: Mapping[str, Any]
    inputs: Mapping[str, str]
    outputs: Mapping[str, str]


@dataclass(frozen=True, slots=True)
class RecordedTick:
    """The state after one tick.

    Attributes:
        tick, time: count from 0, and robot time [s].
        hash: of the run up to here.
        robot: hash of the robot's state and status.
        status, reason, ticked: by node path; whether this tick visited the node.
        ports: hash of every value by key; None where there is none.
        values: as JSON, by key, of the values that are written out.
        line: what happened in this tick: `commands`, `corrections`, `events`, `operator`, `inputs`, `parameters`,
            `delivered`, and the `ports` and `values` that changed.
        taken_over: path and texts of the tree that took over before this tick; None where none did.
    """

    tick: int
    time: float
    hash: str
    robot: str
    status: Mapping[str, str]
    reason: Mapping[str, str]
    ticked: Mapping[str, bool]
    ports: Mapping[str, str | None]
    values: Mapping[str, Any]
    line: Mapping[str, Any]
    taken_over: tuple[str, Mapping[str, str]] | None = None

    def happened(self, what: str) -> list[dict[str, Any]]:
        """The commands, events or changes of this tick; empty where there were none."""
        return self.line.get(what, [])


class RecordedTrace:
    """A trace that was written to a file.

    Attributes:
        path: the file.
        tree: name of the tree.
        rate: ticks a second of robot time [Hz].
        nodes: by path, parents before children; of all trees where another took over.
        keys: types of the keys, by name; likewise.

    Raises:
        TraceError: where the file is missing, or no trace of this version.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            lines = path.read_text(encoding="utf-8").splitlines()
        except (OSError, UnicodeDecodeError) as error:
            raise TraceError(f"{path}: cannot read the trace: {error}") from error
        if not lines:
            raise TraceError(f"{path}: the trace is empty")
        head = self._parse(lines[0], 1)
        if head.get("format") != FORMAT:
            raise TraceError(f"{path}:1: got format {head.get('format')!r}, this version reads {FORMAT}")
        self.tree: str = head["tree"]
        self.rate: float = head["rate"]
        self.keys: dict[str, str] = {}
        self.nodes: dict[str, RecordedNode] = {}
        self._take(head)
        # The last line may be half written where the run was killed.
        whole = lines[1:] if lines[-1].endswith("}") else lines[1:-1]
        self._lines = [self._parse(line, number) for number, line in enumerate(whole, 2)]
        for line in self._lines:
            if "format" in line:
                self._take(line)

    def __len__(self) -> int:
        return sum("format" not in line for line in self._lines)

    def _take(self, head: dict[str, Any]) -> None:
        for node in head["nodes"]:
            read = RecordedNode(node["path"], node["kind"], node["parameters"], node["in"], node["out"])
            self.nodes[read.path] = read
        self.keys.update(head["keys"])

    def ticks(self) -> Iterator[RecordedTick]:
        """The state after each tick, in order."""
        parts = ("status", "reason", "ticked", "ports", "values")
        kept: dict[str, dict[str, Any]] = {part: {} for part in parts}
        taken_over = None
        for line in self._lines:
            if "format" in line:
                kept = {part: {} for part in parts}
                taken_over = (line["file"], line["sources"])
                continue
            for key in line.get("ports", {}):
                kept["values"].pop(key, None)
            for part, values in kept.items():
                values.update(line.get(part, {}))
            copies = {part: dict(values) for part, values in kept.items()}
            head = (line["tick"], line["time"], line["hash"], line["robot"])
            yield RecordedTick(*head, **copies, line=line, taken_over=taken_over)
            taken_over = None

    def at(self, time: float) -> RecordedTick:
        """The last tick that is not later than a robot time [s].

        Raises:
            TraceError: where the trace does not go so far.
        """
        found = None
        for tick in self.ticks():
            if tick.time > time + 1e-9:
                break
            found = tick
        last = max((line["time"] for line in self._lines if "time" in line), default=0.0)
        if found is None or time > last + 1.0 / self.rate:
            raise TraceError(f"{self.path}: got time {time:g} s, the trace goes from 0 to {last:g} s")
        return found

    def _parse(self, text: str, number: int) -> dict[str, Any]:
        try:
            line = json.loads(text)
        except ValueError as error:
            raise TraceError(f"{self.path}:{number}: not a line of a trace: {error}") from error
        if not isinstance(line, dict):
            raise TraceError(f"{self.path}:{number}: not a line of a trace")
        return line
