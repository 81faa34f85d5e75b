"""What the reference system's planner of 2019 took for maps that it was tested on, as a yardstick.

Search time of a plan of the whole way [ms], median of five, on another machine with two cores: 90 % foothold, a foot of
0.20 x 0.10 m, a straight-line heuristic times 1.5, no wiggle and no swing.
"""

from __future__ import annotations

REFERENCE_MS = {
    "EOD_Cinders": 66.0,
    "_CinderBlockField": 280.0,
    "OverCinderBlockField": 280.0,
    "SteppingStones": 1510.0,
    "SimpleGaps": 1970.0,
    "SimpleStairs": 147.0,
    "StairsUpDown": 160.0,
    "StepsAndRamp": 45.0,
    "Jersey_Barriers_IHMC_55cm": 90.0,
    "Jersey_Barriers_JSC_60cm": 56.0,
    "PartialShallowMaze": 106.0,
    "StepAfterPitchUp": 61.0,
    "StepUpsAndDowns": 23.0,
    "Bollards": 13.0,
    "FlatGround": 1220.0,
    "Ramp_2Story": 530.0,
}


def reference_ms(name: str) -> float | None:
    """The time for a map, by a part of its name; None where there is none [ms]."""
    return next((time for part, time in REFERENCE_MS.items() if part in name), None)
