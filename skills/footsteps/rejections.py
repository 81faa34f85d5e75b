"""Why a step is rejected: the reasons, by the numbers under which kernels count them.

The list follows the reasons of the reference planner (Griffin et al., 2019), for what a biped with flat soles may do.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

REASONS = (
    *("", ""),
    # Seen from the stance foot, on whatever ground.
    *("too far", "too far back", "too narrow", "too wide", "turned too much", "soles too near"),
    # The ground under and around the sole.
    *("no ground", "too steep", "ground above the sole", "foothold too small", "at a cliff", "at a wall"),
    *("ground at the shin", "drop beside the sole"),
    # The step on that ground.
    *("step too high", "step too low", "too far for a step up", "too far for a step down"),
    *("step down off a foot that stands uphill", "step in place", "swing too long", "swing too high"),
    *("wall under the swing", "body at an obstacle", "obstacle across the body's way", "outside the searched ground"),
)
# fmt: off
(
    UNSEEN, FOOTHOLD,
    TOO_FAR, TOO_FAR_BACK, TOO_NARROW, TOO_WIDE, TURNED, SOLES_NEAR,
    NO_GROUND, TOO_STEEP, GROUND_ABOVE, TOO_SMALL, AT_CLIFF, AT_WALL,
    AT_SHIN, AT_DROP,
    TOO_HIGH, TOO_LOW, FAR_UP, FAR_DOWN,
    UPHILL, IN_PLACE, SWING_LONG, SWING_HIGH,
    WALL_UNDER, BODY_AT, BODY_WAY, OUTSIDE,
) = range(len(REASONS))
# fmt: on
# Most candidates fail these; they say how large a step is, not what the ground lacks.
_LEVEL = REASONS[TOO_FAR : SOLES_NEAR + 1]


def counted(rejections: NDArray[np.int64]) -> tuple[tuple[str, int], ...]:
    """Reasons and their counts, the most frequent first."""
    counts = [(reason, int(n)) for reason, n in zip(REASONS, rejections, strict=True) if n > 0]
    return tuple(sorted(counts, key=lambda item: -item[1]))


def most_frequent(rejections: tuple[tuple[str, int], ...]) -> str:
    """The reason for which the ground was most often rejected, with its count; empty where there is none."""
    for reason, count in rejections:
        if reason not in _LEVEL:
            return f"{reason} ({count} times)"
    return ""


def in_percent(rejections: tuple[tuple[str, int], ...]) -> tuple[tuple[str, float], ...]:
    """Each reason's share of the rejected edges [%]; places that no step of that size reaches are no edges."""
    edges = [(reason, count) for reason, count in rejections if reason not in _LEVEL]
    total = sum(count for _, count in edges)
    return tuple((reason, 100.0 * count / total) for reason, count in edges)


def sizes_in_percent(rejections: tuple[tuple[str, int], ...]) -> tuple[tuple[str, float], ...]:
    """Each reason's share of the places around the stance feet that are no edges [%]."""
    places = [(reason, count) for reason, count in rejections if reason in _LEVEL]
    total = sum(count for _, count in places)
    return tuple((reason, 100.0 * count / total) for reason, count in places)
