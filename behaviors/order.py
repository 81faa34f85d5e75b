"""What must have happened before a node is ticked: which keys are surely written, what is reached, how long it takes.

The tree is walked once, in the order in which it would be ticked for the first time. For every node it is worked out
which keys are surely written where it succeeds and where it fails, and how long it takes at least. A leaf that needs a
key waits for it, so reading before writing is harmless where another branch of a parallel goes on and writes it; else
the leaf would wait for ever, and that is a problem. So are nodes that no tick can ever reach, and time limits that are
shorter than what they limit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from py_trees.common import Status

from behaviors.check_leaf import Check
from behaviors.decorators import Decorator
from behaviors.leaf import Leaf
from behaviors.ports import declared_inputs
from behaviors.scope import Expansion, Use
from behaviors.spec import NodeSpec
from strict_yaml import Problem

Keys = frozenset[str]


@dataclass(frozen=True, slots=True)
class Ends:
    """How a node can end.

    Attributes:
        success, failure: the keys that are surely written then; None where it never ends so.
        duration: least robot time from its first tick to success [s].
    """

    success: Keys | None
    failure: Keys | None
    duration: float = 0.0


def check_order(expansion: Expansion, problems: list[Problem]) -> None:
    """Walk root and safe stop; problems are appended."""
    places = {(use.path, use.port): use for use in expansion.reads}
    outside = frozenset(port.name for port in expansion.definition.inputs)
    walker = _Walker(places, outside | expansion.doubtful, expansion, problems)
    for root in (expansion.root, expansion.safe_stop):
        if root is not None:
            walker.ends(root, frozenset(), frozenset())


class _Walker:
    """Works out how nodes can end.

    Args:
        places: the ports that read, by node and name.
        outside: keys that may be there at any time.
        expansion: the tree.
        problems: every problem found is appended.
    """

    def __init__(
        self, places: dict[tuple[str, str], Use], outside: Keys, expansion: Expansion, problems: list[Problem]
    ) -> None:
        self.places = places
        self.outside = outside
        self.problems = problems
        self.writers: dict[str, str] = {}
        for use in expansion.writes:
            self.writers.setdefault(use.key, use.path)
        self.everything = frozenset(self.writers)

    def ends(self, spec: NodeSpec, before: Keys, beside: Keys) -> Ends:
        """How a node can end.

        Args:
            spec: the node.
            before: keys that are surely written when it is ticked.
            beside: keys that may be written while it waits.
        """
        if spec.is_leaf:
            return self._leaf(spec, before, beside)
        if len(spec.children) < (len(spec.cls.slots) if issubclass(spec.cls, Decorator) else 1):
            return Ends(before, before)  # A problem that is told elsewhere.
        walk = getattr(self, f"_{spec.kind.removeprefix('reactive_')}")
        return walk(spec, before, beside)

    def _leaf(self, spec: NodeSpec, before: Keys, beside: Keys) -> Ends:
        assert issubclass(spec.cls, Leaf)
        inputs = declared_inputs(spec.cls)
        for wire in spec.inputs:
            port = inputs.get(wire.port)
            waits = port is not None and port.required and port.when_missing is Status.RUNNING
            needs = waits or spec.cls is Check
            if needs and wire.key in self.writers and wire.key not in before | beside | self.outside:
                self._add_read_before_write(spec, wire.port, wire.key)
        can = spec.cls.ends_with
        written = before | {wire.key for wire in spec.outputs}
        return Ends(
            written if Status.SUCCESS in can else None,
            before if Status.FAILURE in can else None,
            spec.cls.least_duration(_parameters(spec)),
        )

    def _add_read_before_write(self, spec: NodeSpec, port: str, key: str) -> None:
        use = self.places[spec.path, port]
        name = key.rpartition("/")[2]
        does = "fails" if spec.cls is Check else "waits for ever"
        message = f'reads "{name}" before it is surely written, and {does} then; it is written by {self.writers[key]}'
        self.problems.append(Problem(use.location, message, spec.path))

    def _sequence(self, spec: NodeSpec, before: Keys, beside: Keys) -> Ends:
        return self._in_turn(spec, before, beside, goes_on_with=Status.SUCCESS)

    def _selector(self, spec: NodeSpec, before: Keys, beside: Keys) -> Ends:
        return self._in_turn(spec, before, beside, goes_on_with=Status.FAILURE)

    def _in_turn(self, spec: NodeSpec, before: Keys, beside: Keys, goes_on_with: Status) -> Ends:
        is_sequence = goes_on_with is Status.SUCCESS
        leaving: list[Keys | None] = []
        durations = []
        going: Keys | None = before
        for index, child in enumerate(spec.children):
            ends = self.ends(child, going, beside)
            leaving.append(ends.failure if is_sequence else ends.success)
            going = ends.success if is_sequence else ends.failure
            if ends.success is not None:
                durations.append(ends.duration)
            if going is None:
                self._tell_unreachable(spec.children[index + 1 :], child, "succeeds" if is_sequence else "fails")
                for unreachable in spec.children[index + 1 :]:
                    self.ends(unreachable, self.everything, beside)
                break
        left = meet(leaving)
        if is_sequence:
            return Ends(going, left, sum(durations))
        return Ends(left, going, min(durations, default=0.0))

    def _parallel(self, spec: NodeSpec, before: Keys, beside: Keys) -> Ends:
        writes = [frozenset(wire.key for node in child for wire in node.outputs) for child in spec.children]
        ends = []
        for index, child in enumerate(spec.children):
            others = frozenset[str]().union(*writes[:index], *writes[index + 1 :])
            ends.append(self.ends(child, before, beside | others))
        needed = _parameters(spec).succeed_after or len(spec.children)
        succeeding = [end for end in ends if end.success is not None]
        failure = before if any(end.failure is not None for end in ends) else None
        if len(succeeding) < needed:
            return Ends(None, failure)
        keys = frozenset[str]().union(*(end.success for end in succeeding if end.success is not None))
        # Written whichever children succeed: fewer than `needed` can succeed without it.
        sure = {key for key in keys if sum(key not in (end.success or ()) for end in succeeding) < needed}
        return Ends(before | sure, failure, sorted(end.duration for end in succeeding)[needed - 1])

    def _inverter(self, spec: NodeSpec, before: Keys, beside: Keys) -> Ends:
        ends = self.ends(spec.children[0], before, beside)
        return Ends(ends.failure, ends.success)

    def _force_success(self, spec: NodeSpec, before: Keys, beside: Keys) -> Ends:
        ends = self.ends(spec.children[0], before, beside)
        return Ends(meet([ends.success, ends.failure]), None, ends.duration if ends.failure is None else 0.0)

    def _force_failure(self, spec: NodeSpec, before: Keys, beside: Keys) -> Ends:
        ends = self.ends(spec.children[0], before, beside)
        return Ends(None, meet([ends.success, ends.failure]))

    def _retry(self, spec: NodeSpec, before: Keys, beside: Keys) -> Ends:
        ends = self.ends(spec.children[0], before, beside)
        return Ends(ends.success, ends.failure if _parameters(spec).attempts else None, ends.duration)

    def _repeat(self, spec: NodeSpec, before: Keys, beside: Keys) -> Ends:
        ends = self.ends(spec.children[0], before, beside)
        times = _parameters(spec).times
        return Ends(ends.success if times else None, ends.failure, times * ends.duration)

    def _loop_forever(self, spec: NodeSpec, before: Keys, beside: Keys) -> Ends:
        self.ends(spec.children[0], before, beside)
        return Ends(None, None)

    def _timeout(self, spec: NodeSpec, before: Keys, beside: Keys) -> Ends:
        ends = self.ends(spec.children[0], before, beside)
        limit = _parameters(spec).after
        if ends.success is not None and ends.duration > limit:
            message = f"can never be met: {spec.children[0].path} takes {ends.duration:g} s at least, limit {limit:g} s"
            self.problems.append(Problem(spec.location, message, spec.path))
        return Ends(ends.success, before, ends.duration)

    def _rate_limit(self, spec: NodeSpec, before: Keys, beside: Keys) -> Ends:
        return self.ends(spec.children[0], before, beside)

    def _run_while(self, spec: NodeSpec, before: Keys, beside: Keys) -> Ends:
        asked, ends = self._guarded(spec, before, beside)
        return Ends(ends.success, meet([ends.failure, asked.failure]), ends.duration)

    def _halt_unless(self, spec: NodeSpec, before: Keys, beside: Keys) -> Ends:
        """While the condition does not succeed it is asked again."""
        return self._guarded(spec, before, beside)[1]

    def _guarded(self, spec: NodeSpec, before: Keys, beside: Keys) -> tuple[Ends, Ends]:
        """A condition, and a child that is ticked once it has succeeded."""
        condition, child = spec.children
        asked = self.ends(condition, before, beside)
        if asked.success is None:
            self._tell_unreachable([child], condition, "succeeds")
            self.ends(child, self.everything, beside)
            return asked, Ends(None, None)
        return asked, self.ends(child, asked.success, beside)

    _pause_on_failure = _rate_limit

    def _suppress(self, spec: NodeSpec, before: Keys, beside: Keys) -> Ends:
        """The child does not wait for the condition, nor the condition for the child."""
        condition, child = spec.children
        written = [frozenset(wire.key for node in part for wire in node.outputs) for part in (condition, child)]
        self.ends(condition, before, beside | written[1])
        return self.ends(child, before, beside | written[0])

    _reset = _suppress

    def _inhibit(self, spec: NodeSpec, before: Keys, beside: Keys) -> Ends:
        """What the child gives may have been held back."""
        ends = self._suppress(spec, before, beside)
        return Ends(None if ends.success is None else before, None if ends.failure is None else before, ends.duration)

    def _tell_unreachable(self, unreachable: Sequence[NodeSpec], cause: NodeSpec, never: str) -> None:
        if unreachable:
            first = unreachable[0]
            message = f"can never be reached: {cause.path} never {never}"
            self.problems.append(Problem(first.location, message, first.path))


def _parameters(spec: NodeSpec) -> Any:
    """The parameters of a node; the defaults where those in the file cannot be read."""
    return spec.cls.Parameters() if spec.parameters is None else spec.parameters


def meet(ways: Sequence[Keys | None]) -> Keys | None:
    """The keys that are written on every way that there is; None where there is no way."""
    possible = [way for way in ways if way is not None]
    return frozenset.intersection(*possible) if possible else None
