"""Tolerances of the judge."""

from __future__ import annotations

import math

from skills.parameters import parameter, parameters


@parameters
class JudgeParameters:
    """What counts as level, coplanar, supported, reactive and a pause."""

    level_tilt: float = parameter(
        math.radians(3.0), unit="rad", minimum=0.0, maximum=0.5, meaning="a foothold is level below this tilt"
    )
    coplanar_tilt: float = parameter(
        math.radians(3.0), unit="rad", minimum=0.0, maximum=0.5, meaning="largest angle between coplanar footholds"
    )
    coplanar_distance: float = parameter(
        0.01, unit="m", minimum=0.0, maximum=0.1, meaning="largest offset between coplanar footholds"
    )
    support_distance: float = parameter(
        0.01, unit="m", minimum=0.0, maximum=0.1, meaning="a sole is supported where ground is this near"
    )
    support_cell: float = parameter(
        0.01, unit="m", minimum=0.001, maximum=0.05, meaning="edge of the cells in which a sole's area is counted"
    )
    approach_distance: float = parameter(
        2.0, unit="m", minimum=0.1, maximum=20.0, meaning="a robot this near to a box is approaching it"
    )
    pause_ratio: float = parameter(
        1.5, unit="1", minimum=1.0, maximum=10.0, meaning="double support over nominal transfer that is a pause"
    )
    goal_distance: float = parameter(
        0.25, unit="m", minimum=0.01, maximum=5.0, meaning="a run that ends this near to its goal has reached it"
    )
