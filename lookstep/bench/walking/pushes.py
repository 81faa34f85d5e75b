"""Pushes at the pelvis: when, how long and how hard."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from skills.geometry.pose import Array

PUSH_DURATION = 0.1
_FIRST = 2.0  # [s]


@dataclass(frozen=True, slots=True, eq=False)
class Push:
    """One push.

    Attributes:
        force_world: (3,) [N].
        start: robot time, or time after a landing [s].
        after_landing: sequence id of the step whose landing `start` counts from; None for robot time.
        duration: [s].
    """

    force_world: Array
    start: float
    after_landing: int | None = None
    duration: float = PUSH_DURATION

    def began(self, landings: Mapping[int, float]) -> float:
        """When it begins, by the times at which steps landed; infinite while that is not known [s]."""
        return self.start + (0.0 if self.after_landing is None else landings.get(self.after_landing, np.inf))


def random_pushes(
    rng: np.random.Generator, until: float, *, least: float, most: float, every: float
) -> tuple[Push, ...]:
    """Level pushes of random force and direction at regular times until a robot time."""
    return tuple(
        Push(level_force(rng.uniform(least, most), rng.uniform(0.0, 2.0 * np.pi)), start)
        for start in np.arange(_FIRST, until, every)
    )


def level_force(force: float, direction: float) -> Array:
    """A level force in a direction counted from the world's x to its y, (3,) [N]."""
    return force * np.array((np.cos(direction), np.sin(direction), 0.0))


def force_at(pushes: Sequence[Push], time: float, landings: Mapping[int, float]) -> Array:
    """The sum of all pushes at a robot time, (3,) [N]."""
    total = np.zeros(3)
    for push in pushes:
        began = push.began(landings)
        if began <= time < began + push.duration:
            total = total + push.force_world
    return total
