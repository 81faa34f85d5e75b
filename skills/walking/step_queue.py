"""Which steps of a newer plan replace the queued ones: those not yet begun, in an order that legs can walk."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from skills.footsteps.footstep import Footstep, Side


def accepted_steps(steps: Sequence[Footstep], newest_id: int | None, last_side: Side | None) -> tuple[Footstep, ...]:
    """The steps of a plan that are still to be made.

    Args:
        steps: the plan in order.
        newest_id: sequence id of the newest step that was begun; it and older ones are dropped.
        last_side: foot of the step before them; None where either foot may go first.

    Raises:
        ValueError: where sequence ids do not increase, the feet do not take turns, or a step cannot be made.
    """
    for before, step in pairwise(steps):
        if step.sequence_id <= before.sequence_id:
            raise ValueError(
                f"step {step.sequence_id} comes after step {before.sequence_id}: sequence ids must increase"
            )
    kept = tuple(step for step in steps if newest_id is None or step.sequence_id > newest_id)
    for step in kept:
        if step.side is last_side:
            raise ValueError(
                f"step {step.sequence_id} is {step.side.value} after a {step.side.value} step: the feet must take turns"
            )
        _check(step)
        last_side = step.side
    return kept


def _check(step: Footstep) -> None:
    for name in ("swing_duration", "transfer_duration"):
        duration = getattr(step, name)
        if not (np.isfinite(duration) and duration > 0.0):
            raise ValueError(f"step {step.sequence_id}: got {name} {duration!r} s, needs more than 0")
    pose = step.T_world_sole
    if not (np.all(np.isfinite(pose.p)) and np.all(np.isfinite(pose.R)) and pose.R[2, 2] > 0.0):
        raise ValueError(f"step {step.sequence_id}: its sole pose is not finite or faces down")
