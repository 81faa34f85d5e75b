"""The numbers behind the body path: what a way costs, what the body needs, how it is searched and smoothed.

The cost is that of McCrory et al. (2022), to which the distance from obstacles is added.
"""

from __future__ import annotations

from math import radians

from skills.parameters import parameter, parameters

OMPL_PLANNERS = (
    *("RRTstar", "InformedRRTstar", "SORRTstar", "BITstar", "AORRTC", "FMT", "BFMT"),
    *("RRT", "RRTConnect", "KPIECE1", "BKPIECE1", "LBKPIECE1"),
)
"""Planners of OMPL that its Python bindings offer; its PRMs start threads of their own and never end from Python."""

LATTICE = "lattice"
"""Our own planner."""


@parameters
class BodyPathParameters:
    """What a way of the body costs, and how it is planned."""

    planner: str = parameter(
        LATTICE,
        unit="1",
        meaning="our own A* on a lattice, or a planner of OMPL",
        choices=(LATTICE, *OMPL_PLANNERS),
    )
    termination_checks: int = parameter(
        2000, unit="1", meaning="OMPL ends when it has asked so often whether to end", minimum=1
    )
    seed: int = parameter(1, unit="1", meaning="of OMPL's random numbers", minimum=1, maximum=2**31 - 1)
    warm_start: bool = parameter(
        True, unit="1", meaning="OMPL looks only for what is cheaper than the path of our own planner"
    )

    spacing: float = parameter(0.1, unit="m", meaning="of the lattice and of the ground's layers", minimum=0.02)
    body_depth: float = parameter(
        0.5, unit="m", meaning="of the box that must be free, along the way", minimum=0.3, maximum=3.0
    )
    body_width: float = parameter(
        0.9, unit="m", meaning="of the box that must be free, across the way", minimum=0.3, maximum=3.0
    )
    ground_clearance: float = parameter(
        0.4, unit="m", meaning="what rises further above the ground under the body is an obstacle", minimum=0.05
    )

    half_stance: float = parameter(0.12, unit="m", meaning="from the body's middle to each foot", minimum=0.0)
    foot_window: float = parameter(
        0.3, unit="m", meaning="edge of the ground that is judged for a foothold", minimum=0.05
    )
    height_deadband: float = parameter(
        0.1, unit="m", meaning="a foothold this far off the ground's mean height is as good", minimum=0.0
    )
    height_window: float = parameter(
        0.25, unit="m", meaning="a foothold this far off the ground's mean height is none", minimum=0.01
    )
    slope_deadband: float = parameter(
        radians(20.0), unit="rad", meaning="a foothold this steep is as good as a level one", minimum=0.0, maximum=1.5
    )
    slope_most: float = parameter(
        radians(45.0), unit="rad", meaning="a foothold this steep is none", minimum=0.01, maximum=1.5
    )
    unseen_quality: float = parameter(
        0.25, unit="1", meaning="what a foothold counts that nobody has seen yet", minimum=0.0, maximum=1.0
    )
    stance_weight: float = parameter(4.0, unit="1", meaning="cost of ground where no foot can stand", minimum=0.0)
    step_weight: float = parameter(2.0, unit="1", meaning="cost of ground where one of the feet cannot", minimum=0.0)

    slope_window: float = parameter(
        0.7, unit="m", meaning="edge of the ground whose slope counts for the body", minimum=0.1
    )
    roll_weight: float = parameter(1.5, unit="1", meaning="cost of walking across a slope", minimum=0.0)
    roll_deadband: float = parameter(radians(1.5), unit="rad", meaning="roll that costs nothing", minimum=0.0)
    roll_most: float = parameter(radians(7.0), unit="rad", meaning="roll that costs most", minimum=0.001)
    incline_weight: float = parameter(
        1.0, unit="1", meaning="cost of a slope of 45 degrees up, beyond that from start to goal", minimum=0.0
    )
    incline_deadband: float = parameter(0.05, unit="1", meaning="slope beyond it that costs nothing", minimum=0.0)
    clearance_weight: float = parameter(3.0, unit="1", meaning="cost of touching an obstacle", minimum=0.0)
    clearance: float = parameter(
        0.3, unit="m", meaning="obstacles this far from the body cost nothing", minimum=0.0, maximum=3.0
    )

    direct: float = parameter(
        0.5, unit="m", meaning="a goal so near is walked to without turning to it", minimum=0.0, maximum=2.0
    )
    turn_length: float = parameter(
        0.25, unit="m", meaning="way on which the body turns at the start and at the goal", minimum=0.01
    )
    way_out: float = parameter(
        0.6, unit="m", meaning="a start that is not free is left within", minimum=0.0, maximum=3.0
    )

    smoothing_sweeps: int = parameter(
        12, unit="1", meaning="sweeps over all points, at each of three spacings", minimum=0, maximum=1000
    )
    smoothing_spacing: float = parameter(0.2, unit="m", meaning="of points at the end", minimum=0.05, maximum=2.0)
    curvature_weight: float = parameter(
        0.05, unit="m^2", meaning="what a metre with a curvature of 1/m costs a smoothed path", minimum=0.0
    )
    straightness: float = parameter(
        0.01, unit="m", meaning="points are left out where the path moves less", minimum=0.0
    )

    better_by: float = parameter(
        0.1, unit="1", meaning="share by which another way must be cheaper to be taken", minimum=0.0, maximum=0.9
    )
    same_way: float = parameter(
        0.3, unit="m", meaning="a way this near to the one that is walked is no other", minimum=0.01, maximum=3.0
    )
