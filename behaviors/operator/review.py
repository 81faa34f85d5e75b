"""What a checkpoint asks the operator, and which checkpoints ask."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from skills.parameters import parameter, parameters


@parameters
class ReviewParameters:
    """Which checkpoints ask the operator; a simulated run without `--review` switches all of them off."""

    body_path: bool = parameter(True, unit="1", meaning="ask before a body path is followed")
    footsteps: bool = parameter(True, unit="1", meaning="ask before the footsteps of a plan are sent")


@dataclass(frozen=True, slots=True, eq=False)
class ReviewRequest:
    """Something that waits for the operator's decision.

    Attributes:
        checkpoint: that asks: a parameter of `ReviewParameters`, which switches it on and off.
        item_id: names the thing in `Approve` and `Reject`.
        item: the thing itself, such as a footstep plan.
        path: the node that asks.
        since: robot time at which it began to ask [s].
    """

    checkpoint: str
    item_id: int
    item: Any
    path: str
    since: float
