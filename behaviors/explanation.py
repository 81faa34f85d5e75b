"""Why a node was doing what it did: from the root down to the node, who had the say, and what it said."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

from behaviors.recorded_trace import RecordedNode, RecordedTick, RecordedTrace

_GOES_ON_WITH = {"sequence": "SUCCESS", "selector": "FAILURE"}


@dataclass(frozen=True, slots=True)
class Explanation:
    """Why a node was, or was not, ticked.

    Attributes:
        tick: that is explained.
        status: of the node; its reason stands in `because`.
        ticked: whether the tick visited it.
        because: one sentence a step, from what is nearest to the node.
        last_ticked: robot time at which it was visited last; None where it never was [s].
    """

    tick: RecordedTick
    status: str
    ticked: bool
    because: tuple[str, ...]
    last_ticked: float | None


def explain(trace: RecordedTrace, path: str, time: float) -> Explanation:
    """Explain a node at a robot time [s].

    Raises:
        LookupError: where the trace has no such node.
        TraceError: where it does not go so far.
    """
    if path not in trace.nodes:
        raise LookupError(path)
    tick = trace.at(time)
    last = None
    for earlier in trace.ticks():
        if earlier.tick > tick.tick:
            break
        if earlier.ticked.get(path):
            last = earlier.time
    ticked = tick.ticked.get(path, False)
    because = tuple(_own_words(tick, path) if ticked else _obstacles(trace, tick, path))
    return Explanation(tick, tick.status.get(path, "INVALID"), ticked, because, last)


def _own_words(tick: RecordedTick, path: str) -> Iterator[str]:
    yield f"it was ticked and is {tick.status[path]}" + _said(tick, path)


def _obstacles(trace: RecordedTrace, tick: RecordedTick, path: str) -> Iterator[str]:
    """The nearest node above that was ticked did not go on to the next below it, for its own reason."""
    above = _line(trace, path)
    for parent, child in pairwise(above):
        if not tick.ticked.get(child.path, False):
            if not tick.ticked.get(parent.path, False):
                yield f"{parent.path} was not ticked: the tree had ended, or its safe stop was never needed"
                return
            yield from _held_back(trace, tick, parent, child)
            if child.path != path:
                yield f"so nothing below {child.path} was ticked"
            return
    yield f"{path} was not ticked: the tree had ended, or its safe stop was never needed"


def _held_back(trace: RecordedTrace, tick: RecordedTick, parent: RecordedNode, child: RecordedNode) -> Iterator[str]:
    siblings = [
        node
        for node in trace.nodes.values()
        if node.path.rpartition("/")[0] == parent.path and node.path in tick.status
    ]
    index = siblings.index(child)
    kind = parent.kind.removeprefix("reactive_")
    if kind in _GOES_ON_WITH:
        yield from _before_in_turn(tick, parent, siblings, index, _GOES_ON_WITH[kind])
    elif kind == "parallel":
        yield f"{child.path} had ended as {tick.status[child.path]}{_said(tick, child.path)}, and rests until"
        yield f"{parent.path} ends, which is {tick.status[parent.path]}{_said(tick, parent.path)}"
    elif len(siblings) == 2:
        condition = siblings[0]
        yield f"{parent.path} ({parent.kind}) held it back{_said(tick, parent.path)}"
        yield f"its condition {condition.path} is {tick.status[condition.path]}{_said(tick, condition.path)}"
    else:
        yield f"{parent.path} ({parent.kind}) did not tick it{_said(tick, parent.path)}"


def _before_in_turn(
    tick: RecordedTick, parent: RecordedNode, siblings: list[RecordedNode], index: int, goes_on_with: str
) -> Iterator[str]:
    """In a sequence or selector, some other child had the say."""
    for node in siblings[:index]:
        status = tick.status[node.path]
        if tick.ticked.get(node.path, False) and status != goes_on_with:
            said = _said(tick, node.path)
            yield f"{node.path} comes before it in {parent.path} ({parent.kind}) and is {status}{said}"
            return
    for node in siblings[index + 1 :]:
        if tick.ticked.get(node.path, False):
            status = tick.status[siblings[index].path]
            yield f"it had ended as {status} already, and {parent.path} ({parent.kind}) has gone on to {node.path}"
            yield f"which is {tick.status[node.path]}{_said(tick, node.path)}"
            return
    yield f"{parent.path} ({parent.kind}) did not come to it{_said(tick, parent.path)}"


def _line(trace: RecordedTrace, path: str) -> list[RecordedNode]:
    """The nodes from the root of the tree down to a node."""
    parts = path.strip("/").split("/")
    paths = ["/" + "/".join(parts[:count]) for count in range(1, len(parts) + 1)]
    return [trace.nodes[above] for above in paths if above in trace.nodes]


def _said(tick: RecordedTick, path: str) -> str:
    reason = tick.reason.get(path, "")
    return f": {reason}" if reason else ""
