"""Composites: sequences, selectors and parallels, each with memory or reactive.

With memory a composite goes on where it was; a reactive one asks every child again, in order, at every tick, so that an
earlier child can preempt a later one. Status tables are those of py_trees and BehaviorTree.CPP: `docs/trees.md`.
"""

from __future__ import annotations

from typing import ClassVar

from py_trees.common import Status

from behaviors.node import Node
from skills.parameters import parameter, parameters


class Composite(Node):
    """A node with any number of children; its reason is that of the child that decided."""

    def _adopt(self, child: Node, status: Status) -> Status:
        self.reason = child.reason
        return status


class Sequence(Composite):
    """Ticks its children one after another until one does not succeed; goes on with the running child."""

    kind = "sequence"

    def initialise(self) -> None:
        """Begin with the first child."""
        self._index = 0
        self._stop_from(0)

    def update(self) -> Status:
        """RUNNING or FAILURE with the child that is; SUCCESS after the last."""
        children = self.children
        while self._index < len(children):
            child = children[self._index]
            child.tick_once()
            if child.status is not Status.SUCCESS:
                return self._adopt(child, child.status)
            self._index += 1
        self.reason = ""
        return Status.SUCCESS


class ReactiveSequence(Composite):
    """Ticks its children from the first at every tick; a child that does not succeed preempts the later ones."""

    kind = "reactive_sequence"

    def update(self) -> Status:
        """RUNNING or FAILURE with the first child that is; SUCCESS where all succeed."""
        for index, child in enumerate(self.children):
            child.tick_once()
            if child.status is not Status.SUCCESS:
                self._stop_from(index + 1)
                return self._adopt(child, child.status)
        self.reason = ""
        return Status.SUCCESS


class Selector(Composite):
    """Ticks its children one after another until one does not fail; goes on with the running child."""

    kind = "selector"

    def initialise(self) -> None:
        """Begin with the first child."""
        self._index = 0
        self._stop_from(0)

    def update(self) -> Status:
        """RUNNING or SUCCESS with the child that is; FAILURE after the last."""
        children = self.children
        while self._index < len(children):
            child = children[self._index]
            child.tick_once()
            if child.status is not Status.FAILURE or self._index == len(children) - 1:
                return self._adopt(child, child.status)
            self._index += 1
        return Status.FAILURE


class ReactiveSelector(Composite):
    """Ticks its children from the first at every tick; a child that does not fail preempts the later ones."""

    kind = "reactive_selector"

    def update(self) -> Status:
        """RUNNING or SUCCESS with the first child that is; FAILURE where all fail."""
        for index, child in enumerate(self.children):
            child.tick_once()
            if child.status is not Status.FAILURE:
                self._stop_from(index + 1)
                return self._adopt(child, child.status)
        if self.children:
            self.reason = self.children[-1].reason
        return Status.FAILURE


@parameters
class ParallelParameters:
    """When a parallel ends."""

    succeed_after: int = parameter(
        0, unit="1", meaning="children that must succeed for it to succeed; 0 stands for all", minimum=0, maximum=1000
    )
    fail_after: int = parameter(
        1, unit="1", meaning="children that must fail for it to fail; 0 stands for all", minimum=0, maximum=1000
    )


class Parallel(Composite):
    """Ticks all its children at every tick, in order; a child that has ended rests until the parallel ends."""

    kind = "parallel"
    Parameters: ClassVar[type] = ParallelParameters
    parameters: ParallelParameters

    def initialise(self) -> None:
        """Let all children begin anew."""
        self._stop_from(0)

    def update(self) -> Status:
        """FAILURE where enough children failed, else SUCCESS where enough succeeded, else RUNNING."""
        for child in self.children:
            if self._ticks_again(child.status):
                child.tick_once()
        return self._decide()

    def _ticks_again(self, status: Status) -> bool:
        return status is Status.RUNNING or status is Status.INVALID

    def _decide(self) -> Status:
        children = self.children
        succeeded = [child for child in children if child.status is Status.SUCCESS]
        failed = [child for child in children if child.status is Status.FAILURE]
        if failed and len(failed) >= (self.parameters.fail_after or len(children)):
            return self._adopt(failed[-1], Status.FAILURE)
        if len(succeeded) >= (self.parameters.succeed_after or len(children)):
            self.reason = ""
            return Status.SUCCESS
        running = len(children) - len(succeeded) - len(failed)
        if running == 0:
            self.reason = (
                f"{len(succeeded)} of {len(children)} succeeded, needs {self.parameters.succeed_after or 'all'}"
            )
            return Status.FAILURE
        self.reason = next(child.reason for child in children if child.status is Status.RUNNING)
        return Status.RUNNING


class ReactiveParallel(Parallel):
    """Ticks all its children at every tick, in order, also those that ended at the last."""

    kind = "reactive_parallel"

    def _ticks_again(self, status: Status) -> bool:
        return True


COMPOSITES: dict[str, type[Composite]] = {
    cls.kind: cls for cls in (Sequence, ReactiveSequence, Selector, ReactiveSelector, Parallel, ReactiveParallel)
}
