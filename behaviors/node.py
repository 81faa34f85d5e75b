"""A node of a tree: a py_trees behaviour whose id is its path, with a reason that an operator can read.

py_trees ticks through nested generators, which cost more than the nodes' work, and names nodes by random ids. These
nodes tick by plain calls, know their path, and turn an exception into a recorded fault. `tick()`, `stop()`, `status`,
`iterate()` and the `initialise`, `update`, `terminate` hooks mean what they mean in py_trees, so its tools still apply.

"""

from __future__ import annotations

import uuid
from collections.abc import Iterator
from typing import Any, ClassVar

from py_trees.behaviour import Behaviour
from py_trees.common import Status

from behaviors.context import Context, NodeFaultError
from skills.parameters import parameters


@parameters
class NoParameters:
    """For a node without parameters."""


class Node(Behaviour):
    """A node with its children.

    Attributes:
        path: from the tree's name down, such as `/look_and_step/walk/plan_footsteps`.
        context: shared by the nodes of one tree.
        parameters: an instance of the class's `Parameters`.
        ticked_at: index of the tick that visited it last; -1 before the first.
    """

    kind: str = ""
    Parameters: ClassVar[type] = NoParameters

    parameters: Any
    children: list[Node]  # type: ignore[assignment]

    def __init__(self, path: str, context: Context, parameters: Any, children: tuple[Node, ...] = ()) -> None:
        super().__init__(path.rpartition("/")[2])
        self.id = uuid.uuid5(uuid.NAMESPACE_URL, path)
        self.path = path
        self.context = context
        self.parameters = parameters
        self.ticked_at = -1
        for child in children:
            child.parent = self
            self.children.append(child)

    @property
    def reason(self) -> str:
        """Why the node is not done, or how it ended; may be empty."""
        return self.feedback_message

    @reason.setter
    def reason(self, text: str) -> None:
        self.feedback_message = text

    @property
    def nodes(self) -> tuple[Node, ...]:
        """This node and all below it, parents before children."""
        below = (node for child in self.children for node in child.nodes)
        return (self, *below)

    def set_parameters(self, parameters: Any) -> None:
        """Replace the parameters between two ticks."""
        self.parameters = parameters

    def tick_once(self) -> None:
        """Tick this node.

        Raises:
            NodeFaultError: where a node below raised; the fault is recorded.
        """
        self.ticked_at = self.context.tick
        try:
            if self.status is not Status.RUNNING:
                self.initialise()
            status = self.update()
        except NodeFaultError:
            raise
        except Exception as error:
            raise self._fault("tick", error) from error
        if status is not Status.RUNNING:
            self._stop_running_children()
            self.terminate(status)
        self.status = status

    def tick(self) -> Iterator[Behaviour]:
        """Tick as py_trees does: a generator over the nodes that were visited, children before parents."""
        self.tick_once()
        for node in self.iterate():
            if not isinstance(node, Node) or node.ticked_at == self.context.tick:
                yield node

    def stop(self, new_status: Status = Status.INVALID) -> None:
        """Preempt this node and all below it that still hold a status."""
        for child in self.children:
            child.stop(new_status)
        self.terminate(new_status)
        self.status = new_status
        self.reason = ""

    def _stop_running_children(self) -> None:
        for child in self.children:
            if child.status is Status.RUNNING:
                child.stop(Status.INVALID)

    def _stop_from(self, first: int) -> None:
        """Clear the status of the children from an index on; preempts those that run."""
        for child in self.children[first:]:
            if child.status is not Status.INVALID:
                child.stop(Status.INVALID)

    def _fault(self, phase: str, error: Exception) -> NodeFaultError:
        self.context.record_fault(self.path, phase, error)
        return NodeFaultError(self.path)
