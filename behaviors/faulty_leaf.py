"""A leaf that breaks as it is told to, and is itself at all other times."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from py_trees.common import Status

from behaviors.faults import Fault, FaultMode, InjectedFaultError
from behaviors.leaf import Leaf, LeafNode, SkillLeaf
from behaviors.ports import declared_outputs

_SAYS = {"S": Status.SUCCESS, "F": Status.FAILURE, "R": Status.RUNNING}
_INJECTED = "injected fault"


class FaultyLeaf(Leaf):
    """Stands between a node and its leaf.

    Args:
        leaf: that breaks.
        faults: those of this leaf.
    """

    def __init__(self, leaf: Leaf, faults: Sequence[Fault]) -> None:
        super().__init__(leaf.node_path, leaf.context, leaf.parameters, leaf.ports)
        self.leaf = leaf
        self._faults = faults
        self._said = 0
        self._starts = 0

    def setup(self) -> None:
        """That of the leaf."""
        self.leaf.setup()

    def start(self) -> None:
        """That of the leaf."""
        self._starts += 1
        self._said = 0
        self.leaf.start()

    def stop(self) -> None:
        """That of the leaf."""
        self.leaf.stop()

    def tick(self) -> Status:
        """That of the leaf, or what the fault says."""
        self.leaf.parameters = self.parameters
        fault = next((fault for fault in self._faults if fault.holds(self.context.time)), None)
        if isinstance(self.leaf, SkillLeaf):
            self.leaf.slower_by = fault.by if fault is not None and fault.mode is FaultMode.SLOW else 0.0
        status = None if fault is None else self._broken(fault)
        if status is not None:
            return status
        self.leaf.reason = ""
        status = self.leaf.tick()
        self.reason = self.leaf.reason
        return status

    def _broken(self, fault: Fault) -> Status | None:
        """What the fault says; None where the leaf has the say."""
        match fault.mode:
            case FaultMode.EXCEPTION:
                raise InjectedFaultError(_INJECTED)
            case FaultMode.OFF:
                return self.failed(_INJECTED)
            case FaultMode.STUCK:
                return self.running(_INJECTED)
            case FaultMode.WRONG:
                for name in declared_outputs(type(self.leaf)):
                    self.leaf.ports[name].write(None)
                return self.succeeded(f"{_INJECTED}: gives nothing")
            case FaultMode.INTERMITTENT:
                chance = np.random.default_rng((fault.seed, self._starts)).random()
                return self.failed(_INJECTED) if chance < fault.share else None
            case FaultMode.SCRIPT:
                letter = fault.says[min(self._said, len(fault.says) - 1)]
                self._said += 1
                self.reason = f"{_INJECTED}: told to say {letter}"
                return _SAYS[letter]
        return None


def break_leaf(node: Any, faults: Sequence[Fault]) -> None:
    """Let the leaf of a node break.

    Raises:
        ValueError: where the node is no leaf, or a fault cannot be injected there.
    """
    if not isinstance(node, LeafNode):
        raise ValueError(f"{node.path} is no leaf")
    slow = any(fault.mode is FaultMode.SLOW for fault in faults)
    if slow and not isinstance(node.leaf, SkillLeaf):
        raise ValueError(f'"slow" cannot be injected at {node.path}: {node.kind} computes nothing')
    node.leaf = FaultyLeaf(node.leaf, faults)
