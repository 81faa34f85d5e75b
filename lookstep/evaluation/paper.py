"""The two tables of Calvert et al., "A Fast, Autonomous, Bipedal Walking Behavior over Rapid Regions" (2022)."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class PartDuration:
    """Mean and standard deviation of a computation over a 22-step walk in simulation [s]."""

    mean: float
    sd: float


@dataclass(frozen=True, slots=True)
class RobotRun:
    """One run on the DRC Atlas robot: steps by kind, and what came of them.

    Attributes:
        steps, flat, uneven_flat, rough, reactive: number of steps; reactive ones are counted among the others, too.
        duration: of the run [s].
        distance: that it walked [m].
        speed, step_length: as printed [m/s], [m].
    """

    steps: int
    flat: int
    uneven_flat: int
    rough: int
    reactive: int
    duration: float
    distance: float
    speed: float
    step_length: float


PART_DURATIONS = {
    "regions": {"uneven_flat": PartDuration(0.087, 0.0363), "rough": PartDuration(0.079, 0.0296)},
    "plan": {"uneven_flat": PartDuration(0.089, 0.0301), "rough": PartDuration(0.134, 0.0642)},
}
"""By part and course."""

ROBOT_RUNS = (
    RobotRun(17, 8, 2, 7, 0, 118.0, 2.5, 0.021, 0.147),
    RobotRun(12, 6, 6, 0, 0, 30.0, 2.1, 0.070, 0.175),
    RobotRun(12, 0, 2, 10, 2, 42.0, 3.0, 0.071, 0.250),
    RobotRun(23, 2, 10, 11, 0, 67.0, 5.3, 0.079, 0.230),
    RobotRun(15, 0, 3, 12, 0, 50.0, 3.5, 0.070, 0.233),
    RobotRun(15, 0, 7, 8, 0, 42.0, 3.5, 0.083, 0.233),
    RobotRun(18, 1, 2, 15, 4, 73.0, 3.3, 0.045, 0.183),
    RobotRun(14, 2, 6, 6, 0, 35.0, 2.3, 0.066, 0.164),
    RobotRun(18, 7, 11, 0, 0, 42.0, 5.5, 0.131, 0.306),
)
"""In the order of the paper's table."""
