"""What a person says to a walking robot by saving a file: parameters, and events of the operator.

```yaml
carrot: [1.5, 0.2, 0.0]
approve: 12
footsteps.reach: 0.4
/look_and_step/walk/sequence/walk_to/follow_path/selector/go_on/take_a_step/wait_for_swing.fraction: 0.4
```

A key without a dot is an event, sent whenever its value changes; three numbers are a place, x, y and yaw. All takes
effect between two ticks and is part of the trace.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from behaviors import OperatorEvent, SettingError, Tree
from skills.body_path import Goal
from skills.parameters import ParameterError
from strict_yaml import Kind, Node, Problem, YamlError, load_document

# Parameters that are taken when a run begins: of the simulated world, and of maps that are under way.
FIXED = (
    *("robot", "camera", "noise", "lidar", "lidar_noise", "world", "physics", "kinematic", "drift", "falls", "judge"),
    *("walking", "swing", "whole_body", "height_map"),
)


class LiveParameters:
    """Watches a file and hands what changes in it to a tree.

    A mistake in the file changes nothing; it is told in the tree's log, with its place.

    Args:
        path: the file; it may come later.
        tree: whose parameters change.
    """

    def __init__(self, path: Path, tree: Tree) -> None:
        self._path = path
        self._tree = tree
        self._seen: tuple[int, int] | None = None
        self._applied: dict[str, Any] = {}

    def poll(self) -> None:
        """Apply what has changed in the file since the last call; for between two ticks."""
        try:
            stat = self._path.stat()
        except OSError:
            return
        if (stat.st_mtime_ns, stat.st_size) == self._seen:
            return
        self._seen = (stat.st_mtime_ns, stat.st_size)
        try:
            self._apply(load_document(self._path))
        except YamlError as error:
            for problem in error.problems:
                self._say(problem)

    def _apply(self, document: Node) -> None:
        if document.kind is not Kind.MAPPING:
            message = f"got {document.describe()}, needs a mapping such as footsteps.reach: 0.4"
            self._say(Problem(document.location, message))
            return
        for entry in document.entries:
            value = _value(entry.node)
            if self._applied.get(entry.key) == value:
                continue
            if "." not in entry.key:
                self._applied[entry.key] = value
                self._tree.send(OperatorEvent(entry.key, _place(value)))
                continue
            target, _, key = entry.key.rpartition(".")
            if target in FIXED:
                message = f"{target} is taken when a run begins; it cannot change while the robot walks"
                self._say(Problem(entry.location, message))
                continue
            try:
                self._tree.set_parameter(target, key, value)
            except (SettingError, ParameterError) as error:
                self._say(Problem(entry.node.location, str(error)))
                continue
            self._applied[entry.key] = value
            self._tree.context.log(f"{entry.key} is {value} now", path=target if target.startswith("/") else "")

    def _say(self, problem: Problem) -> None:
        self._tree.context.log(str(problem), level="warning")


def _place(value: Any) -> Any:
    """Three numbers as a goal."""
    is_place = isinstance(value, tuple) and len(value) == 3 and all(isinstance(part, int | float) for part in value)
    return Goal(*map(float, value)) if is_place else value


def _value(node: Node) -> Any:
    """A scalar, or a tuple of them."""
    if node.kind is Kind.SEQUENCE:
        return tuple(_value(element) for element in node.elements)
    return node.value
