"""Suppressor, inhibitor and reset as decorators, after the wiring of subsumption networks (Brooks, 1986).

In such a network a signal line does not call a module: it taps the lines of a module that runs. A suppressor cuts what
goes in, an inhibitor cuts what comes out, both for some time after the signal, and a reset puts the module back to its
initial state. Here the signal is a condition that is asked at every tick, and the module is the child.
"""

from __future__ import annotations

from typing import ClassVar

from py_trees.common import Status

from behaviors.context import Context
from behaviors.decorators import TIME_TOLERANCE, Decorator
from behaviors.leaf import LeafNode
from behaviors.node import Node
from skills.parameters import parameter, parameters


@parameters
class SignalParameters:
    """How long a signal has effect."""

    hold: float = parameter(
        0.0, unit="s", meaning="robot time for which the effect outlasts the signal", minimum=0.0, maximum=3600.0
    )


class SignalDecorator(Decorator):
    """A child and a condition whose success is a signal."""

    slots = ("condition", "child")
    Parameters: ClassVar[type] = SignalParameters
    parameters: SignalParameters

    def __init__(self, path: str, context: Context, parameters: object, children: tuple[Node, ...]) -> None:
        super().__init__(path, context, parameters, children)
        self._until = -float("inf")
        self._cause = ""

    def _signalled(self) -> bool:
        """Whether the signal is there or was there within the hold time; keeps its reason."""
        condition = self.children[0]
        condition.tick_once()
        if condition.status is Status.SUCCESS:
            self._until = self.context.time + self.parameters.hold
            self._cause = condition.reason or f"{condition.name} holds"
            return True
        return self.context.time < self._until - TIME_TOLERANCE


class Suppress(SignalDecorator):
    """Keeps its child from being ticked while the condition succeeds: stops it if it runs, and waits."""

    kind = "suppress"

    def update(self) -> Status:
        """RUNNING with the signal's reason while suppressed, else the child's status."""
        if self._signalled():
            self._stop_from(1)
            self.reason = f"suppressed: {self._cause}"
            return Status.RUNNING
        return self._tick_child()


class Inhibit(SignalDecorator):
    """Lets its child run but holds back what its leaves give while the condition succeeds."""

    kind = "inhibit"

    def __init__(self, path: str, context: Context, parameters: object, children: tuple[Node, ...]) -> None:
        super().__init__(path, context, parameters, children)
        self._leaves = tuple(node.leaf for node in self.child.nodes if isinstance(node, LeafNode))

    def update(self) -> Status:
        """The child's status."""
        inhibited = self._signalled()
        for leaf in self._leaves:
            leaf.inhibitors += inhibited
        try:
            status = self._tick_child()
        finally:
            for leaf in self._leaves:
                leaf.inhibitors -= inhibited
        if inhibited:
            self.reason = f"inhibited: {self._cause}"
        return status


class Reset(Decorator):
    """Stops its child and lets it begin anew whenever the condition begins to succeed."""

    kind = "reset"
    slots = ("condition", "child")

    def initialise(self) -> None:
        """The condition did not succeed before."""
        self._was_signalled = False

    def update(self) -> Status:
        """The child's status, after a reset that of its first tick."""
        condition = self.children[0]
        condition.tick_once()
        signalled = condition.status is Status.SUCCESS
        if signalled and not self._was_signalled:
            self._stop_from(1)
        self._was_signalled = signalled
        return self._tick_child()
