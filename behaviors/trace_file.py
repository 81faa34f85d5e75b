"""The file of a trace: one line of JSON for the tree, then one for every tick with what changed in it.

The first line holds `format`, `tree`, `rate`, the `nodes` with their kinds, parameters and wires, the types of all
`keys`, and the texts of the tree's files; a tree that takes over has a line like it. A line of a tick holds `tick`,
`time`, `hash` of the run so far, `robot` (hash of the robot's state and status) and, where there are any,

- `status`, `reason` by node path, `ticked` (whether the tick visited it) and `ports` (hash by key, null for an emptied
  one), where they changed;
- `values` by key of those ports whose value is small;
- `commands` and `corrections` (of the robot's estimate) with the node that gave them, `events` of steps, `operator`
  events, `parameters` that were changed, and `delivered` (nodes whose computations ended).
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from dataclasses import fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

from py_trees.common import Status

from behaviors.blackboard import type_name
from behaviors.node import Node
from behaviors.robot_view import Command, RobotView
from behaviors.values import ValueFormatError, is_small, to_json

if TYPE_CHECKING:
    from behaviors.blackboard import Slot
    from behaviors.spec import TreeSpec
    from behaviors.trace import Happened

FORMAT = 1
# Values up to this size are written out, larger ones are known by their hash alone [bytes].
LARGEST_VALUE = 16_384


class TraceFile:
    """Writes one file."""

    def __init__(self, path: str | Path) -> None:
        self._file = open(path, "w", encoding="utf-8")  # noqa: SIM115 (closed with the trace)
        self._statuses: dict[str, Status] = {}
        self._reasons: dict[str, str] = {}
        self._ticked: dict[str, bool] = {}
        self._ports: dict[str, bytes] = {}

    def begin(self, spec: TreeSpec, rate: float, nodes: Iterable[Node]) -> None:
        """Write the line of a tree: the first, and one wherever another tree takes over."""
        specs = {node.path: node for node in spec}
        described = []
        for node in nodes:
            wired = specs[node.path]
            described.append(
                {
                    "path": node.path,
                    "kind": wired.kind,
                    "parameters": {
                        field.name: to_json(getattr(node.parameters, field.name)) for field in fields(node.parameters)
                    },
                    "in": {wire.port: wire.key for wire in wired.inputs},
                    "out": {wire.port: wire.key for wire in wired.outputs},
                }
            )
        keys = {key: type_name(declared) for key, declared in spec.keys.items()}
        head = {"format": FORMAT, "tree": spec.name, "rate": rate, "nodes": described, "keys": keys}
        self._write({**head, "file": spec.file, "sources": dict(spec.sources)})
        self._statuses, self._reasons, self._ticked, self._ports = {}, {}, {}, {}

    def write(
        self,
        head: dict[str, Any],
        nodes: tuple[Node, ...],
        slots: tuple[Slot, ...],
        hashes: dict[str, bytes],
        robot: RobotView,
        happened: Happened,
    ) -> None:
        """Write the line of a tick."""
        statuses = {node.path: node.status for node in nodes}
        reasons = {node.path: node.reason for node in nodes}
        ticked = {node.path: node.ticked_at == head["tick"] for node in nodes}
        ports = dict(_changed(self._ports, hashes))
        parts = {
            "status": {path: status.name for path, status in _changed(self._statuses, statuses)},
            "reason": dict(_changed(self._reasons, reasons)),
            "ticked": dict(_changed(self._ticked, ticked)),
            "ports": {key: None if not any(data) else data.hex() for key, data in ports.items()},
            "values": _values(slot for slot in slots if slot.key in ports),
            "commands": [_command(command) for command in robot.commands],
            "corrections": [{"node": node, "value": to_json(pose)} for node, pose in robot.corrections],
            "events": [{"kind": event.kind.value, "step": event.step.sequence_id} for event in robot.events],
            "operator": [{"name": event.name, "value": event.value} for event in happened.operator],
            "inputs": [{"key": key, "value": to_json(value)} for key, value in happened.inputs],
            "parameters": [
                {"target": change.target, "key": change.key, "value": to_json(change.value)}
                for change in happened.changes
            ],
            "delivered": list(happened.delivered),
        }
        self._statuses, self._reasons, self._ticked, self._ports = statuses, reasons, ticked, hashes
        self._write({**head, **{name: part for name, part in parts.items() if part}})

    def close(self) -> None:
        """End the file."""
        self._file.close()

    def _write(self, line: dict[str, Any]) -> None:
        self._file.write(json.dumps(line, separators=(",", ":")) + "\n")


def _command(command: Command) -> dict[str, Any]:
    line = {"name": command.name, "node": command.node, "steps": len(command.steps), "value": to_json(command.steps)}
    if command.sent is not command.steps:
        line["sent"] = to_json(command.sent)
    return line


def _values(slots: Iterable[Slot]) -> dict[str, Any]:
    values = {}
    for slot in slots:
        if slot.value is not None and is_small(slot.value, LARGEST_VALUE):
            try:
                values[slot.key] = to_json(slot.value)
            except ValueFormatError:
                continue  # Hashed, but of a type that only lives in memory.
    return values


def _changed(before: dict[str, Any], after: dict[str, Any]) -> list[tuple[str, Any]]:
    return [(key, value) for key, value in after.items() if before.get(key) != value]
