"""What a person says to a walking robot by saving a file: parameters, and events of the operator.

```yaml
carrot: [1.5, 0.2, 0.0]
approve: [footsteps, 12]
pause: 1
footsteps.reach: 0.4
/look_and_step/look/regions/rate_limit.period: 0.2
```

A key without a dot is an event of the operator (docs/operator.md), sent whenever its value changes; one that has no
value takes any, so that another number sends it again. All takes effect between two ticks and is part of the trace.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from behaviors import SettingError, Tree
from behaviors.operator import EVENTS, OperatorEvent, OperatorEventError, read_event
from skills.parameters import ParameterError
from strict_yaml import Kind, Node, Problem, YamlError, load_document


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
            target, _, key = entry.key.rpartition(".")
            try:
                if target:
                    self._tree.set_parameter(target, key, value)
                else:
                    self._tree.send(_event(key, value))
            except (OperatorEventError, SettingError, ParameterError) as error:
                self._say(Problem(entry.node.location, str(error)))
                continue
            self._applied[entry.key] = value
            if target:
                self._tree.context.log(f"{entry.key} is {value} now", path=target if target.startswith("/") else "")

    def _say(self, problem: Problem) -> None:
        self._tree.context.log(str(problem), level="warning")


def _event(name: str, value: Any) -> OperatorEvent:
    has_value = name not in EVENTS or EVENTS[name].form != OperatorEvent.form
    return read_event(name, value if has_value else None)


def _value(node: Node) -> Any:
    """A scalar, or a tuple of them."""
    if node.kind is Kind.SEQUENCE:
        return tuple(_value(element) for element in node.elements)
    return node.value
