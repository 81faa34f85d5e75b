"""The leaf that asks a condition over ports: `check: left > 0`."""

from __future__ import annotations

from typing import Any

from py_trees.common import Status

from behaviors.blackboard import Slot
from behaviors.context import Context
from behaviors.expression import parse_expression
from behaviors.leaf import Leaf
from skills.parameters import parameter, parameters


@parameters
class CheckParameters:
    """What is asked."""

    that: str = parameter("true", unit="1", meaning="condition over keys, such as left > 0 and not blocked")


class Check(Leaf):
    """Succeeds while a condition over keys holds, else fails; fails where a key holds nothing."""

    kind = "check"
    Parameters = CheckParameters
    parameters: CheckParameters

    def __init__(self, path: str, context: Context, parameters: Any, ports: dict[str, Slot]) -> None:
        super().__init__(path, context, parameters, ports)
        self._text = ""

    def tick(self) -> Status:
        """SUCCESS where it holds."""
        if self._text != self.parameters.that:
            self._text = self.parameters.that
            self._holds = parse_expression(self._text).compile({name: slot.type for name, slot in self.ports.items()})
        values = {name: slot.value for name, slot in self.ports.items()}
        missing = [name for name, value in values.items() if value is None]
        if missing:
            return self.failed(f'nothing on "{missing[0]}"')
        if self._holds(values):
            return self.succeeded(self._text)
        return self.failed(f"not so: {self._text}")
