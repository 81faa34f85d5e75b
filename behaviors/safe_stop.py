"""What happens after a fault: the safe stop of the tree file; where that is missing or breaks, the robot pauses."""

from __future__ import annotations

from py_trees.common import Status

from behaviors.context import Context, NodeFaultError
from behaviors.node import Node


class SafeStop:
    """Is ticked until it is done.

    Args:
        node: root of the branch that a file gives; None where it gives none.
        context: of the tree.
    """

    def __init__(self, node: Node | None, context: Context) -> None:
        self._node = node
        self._context = context
        self._is_done = False

    def tick(self) -> None:
        """One tick; nothing once it is done."""
        if self._is_done:
            return
        node, faults = self._node, len(self._context.faults)
        if node is None:
            self._pause_walking()
            return
        try:
            node.tick_once()
            self._is_done = node.status is not Status.RUNNING
        except NodeFaultError:
            node.stop(Status.INVALID)
        if len(self._context.faults) > faults:
            self._pause_walking()

    def _pause_walking(self) -> None:
        """What remains where nothing else says how to stop."""
        self._is_done = True
        self._context.robot.caller = "/safe_stop"
        try:
            self._context.robot.pause_walking()
        except Exception as error:
            self._context.record_fault("/safe_stop", "tick", error)
