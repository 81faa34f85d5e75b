"""Compute times of repeated calls, in time of the thread: other programs on the machine do not count."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Timing:
    """Times of a call.

    Attributes:
        median_ms, p99_ms: median and 99th percentile over the repeats [ms].
    """

    median_ms: float
    p99_ms: float

    @classmethod
    def of(cls, times: Sequence[float]) -> Timing:
        """From times in seconds."""
        median, p99 = np.percentile(times, (50, 99)) * 1e3
        return cls(round(float(median), 3), round(float(p99), 3))


def timed(function: Callable[[], T], repeats: int, most: float = float("inf")) -> tuple[T, list[float]]:
    """What a function returns and how long each of its calls took [s]; no more repeats once `most` seconds are spent.

    The first call warms up and does not count.
    """
    result = function()
    times: list[float] = []
    while len(times) < repeats and (not times or sum(times) < most):
        started = time.thread_time()
        result = function()
        times.append(time.thread_time() - started)
    return result, times
