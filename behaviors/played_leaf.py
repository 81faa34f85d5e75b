"""Leaves that say again what they said in a recording, instead of sensing and computing."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from py_trees.common import Status

from behaviors.leaf import Leaf, LeafNode
from behaviors.recorded_trace import RecordedTick
from behaviors.trace import Unrecorded
from behaviors.tree import Tree
from behaviors.values import from_json


class Playback:
    """The tick of the recording that is played now.

    Attributes:
        tick: that tick; None before the first.
        strayed: leaves that were asked in a tick in which the recording did not ask them, and when first [s].
    """

    def __init__(self) -> None:
        self.tick: RecordedTick | None = None
        self.strayed: dict[str, float] = {}


class PlayedLeaf(Leaf):
    """Stands in for a leaf of a recording."""

    def __init__(self, replaced: Leaf, outputs: Mapping[str, str], playback: Playback) -> None:
        super().__init__(replaced.node_path, replaced.context, replaced.parameters, replaced.ports)
        self._outputs = outputs
        self._playback = playback

    def tick(self) -> Status:
        """The recorded status, outputs, commands and corrections of this tick."""
        tick = self._playback.tick
        assert tick is not None, "a tick of the recording is chosen before the tree is ticked"
        path = self.node_path
        if not tick.ticked.get(path, False):
            self._playback.strayed.setdefault(path, tick.time)
            return self.running("the recording does not say: it did not ask this leaf at this time")
        self._write_outputs(tick)
        robot = self.context.robot
        for correction in tick.happened("corrections"):
            if correction["node"] == path:
                robot.correct(from_json(correction["value"]))
        for command in tick.happened("commands"):
            if command["node"] == path:
                self._command(command)
        status = Status[tick.status[path]]
        self.reason = tick.reason.get(path, "")
        # A leaf that was preempted in the same tick had run until then.
        return Status.RUNNING if status is Status.INVALID else status

    def _command(self, command: dict[str, Any]) -> None:
        robot = self.context.robot
        if command["name"] == "send_footsteps":
            robot.send_footsteps(from_json(command["value"]))
        else:
            robot.pause_walking()

    def _write_outputs(self, tick: RecordedTick) -> None:
        changed = tick.happened("ports")
        for port, key in self._outputs.items():
            if key not in changed:
                continue
            hashed = tick.ports[key]
            if hashed is None:
                self.ports[port].value = None
            elif key in tick.values:
                self.ports[port].value = from_json(tick.values[key])
            else:
                self.ports[port].value = Unrecorded(bytes.fromhex(hashed))


def play_back(tree: Tree, outputs: Mapping[str, Mapping[str, str]], playback: Playback) -> None:
    """Let every leaf that a recording has say again what it said.

    Args:
        tree: whose leaves are replaced before its first tick.
        outputs: of the recording's leaves, keys by port, by node path.
        playback: has to be told the tick before each tick of the tree.
    """
    for node in tree.nodes:
        if isinstance(node, LeafNode) and node.path in outputs:
            node.replace_leaf(PlayedLeaf(node.leaf, outputs[node.path], playback))
