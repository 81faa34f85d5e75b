"""The numbers behind the height map."""

from __future__ import annotations

from skills.parameters import parameter, parameters


@parameters
class HeightMapParameters:
    """How lidar scans become a height map.

    A height is uncertain by the range of its beam, by the angle of the beam, and by the slope of the ground: a beam
    that comes in flat errs along the ground, which is an error in height only where the ground is not level.
    """

    size: float = parameter(10.0, unit="m", minimum=1.0, maximum=50.0, meaning="edge of the map")
    resolution: float = parameter(0.05, unit="m", minimum=0.01, maximum=0.5, meaning="edge of a cell")
    border: float = parameter(
        2.0,
        unit="m",
        minimum=0.0,
        maximum=25.0,
        meaning="the robot stays this far inside the map, whatever the goal",
    )
    ceiling: float = parameter(
        2.0, unit="m", minimum=0.1, maximum=10.0, meaning="what is further above the feet is no obstacle"
    )
    body_margin: float = parameter(
        0.05, unit="m", minimum=0.0, maximum=0.5, meaning="returns this near to the robot's own body are its own"
    )
    range_sd: float = parameter(
        0.015, unit="m", minimum=0.0, maximum=0.5, meaning="standard deviation of a range at the lidar"
    )
    range_sd_per_metre: float = parameter(
        0.0023, unit="1", minimum=0.0, maximum=0.1, meaning="what each metre of range adds to it"
    )
    angle_sd: float = parameter(
        0.001, unit="rad", minimum=0.0, maximum=0.1, meaning="standard deviation of the lidar's tilt"
    )
    slope_sd: float = parameter(0.2, unit="1", minimum=0.0, maximum=2.0, meaning="usual slope of the ground")
    growth: float = parameter(
        1e-5, unit="m^2/s", minimum=0.0, maximum=1.0, meaning="variance that a height gains while nothing confirms it"
    )
    surface: float = parameter(
        0.08,
        unit="m",
        minimum=0.0,
        maximum=0.5,
        meaning="returns this far below the highest of a cell are its top too",
    )
    gate: float = parameter(
        3.0, unit="1", minimum=0.5, maximum=10.0, meaning="standard deviations within which a return confirms a height"
    )
    votes: int = parameter(
        6,
        unit="1",
        minimum=1,
        maximum=100,
        meaning="scans in a row that contradict a height until it is given up",
    )
    check_every: int = parameter(
        4, unit="1", minimum=1, maximum=10, meaning="a cell without returns is checked in one scan of so many"
    )
    see_through: float = parameter(
        0.08, unit="m", minimum=0.01, maximum=1.0, meaning="beams this far below a height that go on contradict it"
    )
    spike: float = parameter(
        0.04, unit="m", minimum=0.0, maximum=1.0, meaning="a cell this far above all its neighbours is an outlier"
    )
    fill_reach: int = parameter(
        3,
        unit="1",
        minimum=0,
        maximum=50,
        meaning="holes with data within so many cells on both sides are filled",
    )
    fill_step: float = parameter(
        0.08, unit="m", minimum=0.0, maximum=1.0, meaning="holes are filled where the sides differ by less"
    )
    ground_low: float = parameter(
        0.02, unit="1", minimum=0.0, maximum=1.0, meaning="share of heights below those of the ground"
    )
    ground_high: float = parameter(
        0.06, unit="1", minimum=0.0, maximum=1.0, meaning="share of heights up to those of the ground"
    )
