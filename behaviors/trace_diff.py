"""Compares two traces: the first tick in which they differ, in what, and what was decided differently after it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from behaviors.recorded_trace import RecordedTick, RecordedTrace

_MOST_PARTS = 3


@dataclass(frozen=True, slots=True)
class Difference:
    """One thing that two ticks do not share.

    Attributes:
        what: "status", "port", "command", "operator", "parameters", "input" or "robot".
        subject: the node, key or name that differs.
        first, second: what it is in either trace.
    """

    what: str
    subject: str
    first: str
    second: str

    def __str__(self) -> str:
        return f"{self.what} {self.subject}: {self.first} | {self.second}"


@dataclass(frozen=True, slots=True)
class DivergentTick:
    """A tick in which two traces differ."""

    tick: int
    time: float
    differences: tuple[Difference, ...]


@dataclass(frozen=True, slots=True)
class TraceDiff:
    """How two traces differ.

    Attributes:
        tree: differences of the trees: nodes that only one has, parameters, wires.
        ticks: how many ticks were compared.
        divergent: how many of them differ.
        first: the first of those; None where there is none.
        first_command: the first in which the robot was told something else: from then on one robot is elsewhere.
        nodes: in how many ticks the status of a node differs, most first.
        lengths: ticks of either trace.
        identical: whether the hashes of both traces are equal up to their ends.
    """

    tree: tuple[Difference, ...]
    ticks: int
    divergent: int
    first: DivergentTick | None
    first_command: DivergentTick | None
    nodes: tuple[tuple[str, int], ...]
    lengths: tuple[int, int]
    identical: bool


def diff_traces(first: RecordedTrace, second: RecordedTrace) -> TraceDiff:
    """Compare two traces tick by tick, as far as the shorter goes; nodes and keys that only one has are left out."""
    common = Common(
        tuple(path for path in first.nodes if path in second.nodes),
        tuple(key for key in first.keys if key in second.keys),
    )
    earliest: DivergentTick | None = None
    told: DivergentTick | None = None
    nodes: Counter[str] = Counter()
    ticks = divergent = 0
    same_hash = len(first) == len(second)
    for one, other in zip(first.ticks(), second.ticks(), strict=False):
        ticks += 1
        same_hash = same_hash and one.hash == other.hash
        differences = tuple(compare_ticks(one, other, common))
        if not differences:
            continue
        divergent += 1
        here = DivergentTick(one.tick, one.time, differences)
        earliest = earliest or here
        if told is None and any(difference.what == "command" for difference in differences):
            told = here
        nodes.update(difference.subject for difference in differences if difference.what == "status")
    return TraceDiff(
        tree=tuple(_compare_trees(first, second)),
        ticks=ticks,
        divergent=divergent,
        first=earliest,
        first_command=told,
        nodes=tuple(nodes.most_common()),
        lengths=(len(first), len(second)),
        identical=same_hash,
    )


@dataclass(frozen=True, slots=True)
class Common:
    """What two traces have in common.

    Attributes:
        paths: of nodes.
        keys: of the blackboard.
    """

    paths: tuple[str, ...]
    keys: tuple[str, ...]


def compare_ticks(one: RecordedTick, other: RecordedTick, common: Common) -> Iterator[Difference]:
    """What differs between the states after two ticks."""
    if abs(one.time - other.time) > 1e-9:
        yield Difference("robot", "time", f"{one.time:g} s", f"{other.time:g} s")
    for key in common.keys:
        if one.ports.get(key) != other.ports.get(key):
            yield Difference("port", key, *_describe(one, other, key))
    for path in common.paths:
        before, after = one.status.get(path, "INVALID"), other.status.get(path, "INVALID")
        if before != after:
            reasons = (one.reason.get(path, ""), other.reason.get(path, ""))
            yield Difference("status", path, _with_reason(before, reasons[0]), _with_reason(after, reasons[1]))
    happened = {"commands": "command", "operator": "operator", "parameters": "parameters", "inputs": "input"}
    for what, name in happened.items():
        told = tuple([_without_node(entry) for entry in tick.happened(what)] for tick in (one, other))
        if told[0] != told[1]:
            yield Difference(name, "to the robot" if name == "command" else "event", *map(_tell, told))
    if one.robot != other.robot:
        yield Difference("robot", "state", "one state", "another")


def _without_node(entry: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in entry.items() if key != "node"}


def _tell(entries: list[dict[str, Any]]) -> str:
    words = []
    for entry in entries:
        steps = f" of {entry['steps']} steps" if entry.get("steps") else ""
        words.append(
            str(entry.get("name") or f"{entry.get('target')}.{entry.get('key')} = {entry.get('value')}") + steps
        )
    return ", ".join(words) or "nothing"


def _with_reason(status: str, reason: str) -> str:
    return f"{status} ({reason})" if reason else status


def _describe(one: RecordedTick, other: RecordedTick, key: str) -> tuple[str, str]:
    """What is on a key in either tick; where both values are written out, the parts of them that differ."""
    first, second = one.values.get(key), other.values.get(key)
    if first is not None and second is not None:
        parts = list(_parts(first, second, ""))[:_MOST_PARTS]
        if parts:
            return tuple("; ".join(f"{name} {pair[side]}" for name, pair in parts) for side in (0, 1))  # type: ignore[return-value]
    return tuple("nothing" if tick.ports.get(key) is None else "a value" for tick in (one, other))  # type: ignore[return-value]


def _parts(first: Any, second: Any, name: str) -> Iterator[tuple[str, tuple[str, str]]]:
    """The parts in which the JSON of two values differs."""
    if first == second:
        return
    if isinstance(first, dict) and isinstance(second, dict) and first.keys() == second.keys():
        if "$array" in first:
            yield name or "array", ("differs", "differs")
            return
        for key in first:
            inner = first[key]
            below = name if key.startswith("$") or key == "fields" else f"{name}.{key}".lstrip(".")
            if not (isinstance(inner, str) and key.startswith("$")):
                yield from _parts(inner, second[key], below)
    elif isinstance(first, list) and isinstance(second, list) and len(first) == len(second):
        for index, pair in enumerate(zip(first, second, strict=True)):
            yield from _parts(*pair, f"{name}[{index}]")
    else:
        yield name or "value", (_short(first), _short(second))


def _short(data: Any) -> str:
    if isinstance(data, list):
        return f"{len(data)} elements"
    if isinstance(data, dict):
        return str(data.get("name") or "another")
    return str(data)[:40]


def _compare_trees(first: RecordedTrace, second: RecordedTrace) -> Iterator[Difference]:
    for path in [*first.nodes, *(path for path in second.nodes if path not in first.nodes)]:
        one, other = first.nodes.get(path), second.nodes.get(path)
        if one is None or other is None:
            yield Difference("node", path, one.kind if one else "is not there", other.kind if other else "is not there")
            continue
        if one.kind != other.kind:
            yield Difference("kind", path, one.kind, other.kind)
            continue
        for key, value in one.parameters.items():
            if value != other.parameters.get(key):
                yield Difference("parameter", f"{path}.{key}", str(value), str(other.parameters.get(key)))
        for direction, wires in (("in", (one.inputs, other.inputs)), ("out", (one.outputs, other.outputs))):
            if wires[0] != wires[1]:
                yield Difference(direction, path, str(dict(wires[0])), str(dict(wires[1])))
