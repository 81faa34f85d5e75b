"""How often in a row the robot has tried in vain to go on: by then the way is blocked."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

# A body path may be planned anew meanwhile; one whose end has moved less leads to the same goal [m].
_SAME_GOAL = 0.5


@dataclass(frozen=True, slots=True)
class VainAttempts:
    """Attempts in a row to plan toward one goal that found no step.

    Attributes:
        count: how many.
        goal: end of the body path, x and y [m].
        reason: why the last one found none.
    """

    count: int
    goal: tuple[float, float]
    reason: str

    @classmethod
    def after(cls, before: VainAttempts | None, goal: tuple[float, float], reason: str) -> VainAttempts:
        """One more attempt in vain; toward another goal it is the first."""
        same = before is not None and np.hypot(*np.subtract(before.goal, goal)) < _SAME_GOAL
        return cls(before.count + 1 if before is not None and same else 1, goal, reason)
