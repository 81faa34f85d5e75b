"""Why a robot stands that could walk: leaves say so in each tick in which they hold it, for operator and judge."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class HaltCause(Enum):
    """What a robot that is held waits for."""

    REVIEW = "review"
    BLOCKED = "blocked"
    OPERATOR = "operator"
    OLD_DATA = "old_data"


@dataclass(frozen=True, slots=True)
class Halt:
    """A reason to stand.

    Attributes:
        cause: its kind.
        reason: one sentence for the operator.
        path: the node that says so.
    """

    cause: HaltCause
    reason: str
    path: str
