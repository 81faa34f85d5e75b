"""How a foot swings: when it travels, how it rises and sinks, when it turns into its foothold."""

from __future__ import annotations

from skills.parameters import parameter, parameters


@parameters
class SwingParameters:
    """Settings of the way of a sole through the air; shares are of the swing's duration."""

    knots: int = parameter(32, unit="1", meaning="spline intervals of a swing", minimum=16, maximum=128)
    leave: float = parameter(0.12, unit="1", meaning="share before the foot travels", minimum=0.1)
    arrive: float = parameter(0.85, unit="1", meaning="share when the foot has travelled", maximum=0.9)
    detour: float = parameter(0.15, unit="1", meaning="travel starts later, ends earlier at walls", maximum=0.25)
    ramp: float = parameter(0.45, unit="1", meaning="most of the swing to rise or sink in", minimum=0.1, maximum=0.5)
    shoulder: float = parameter(0.35, unit="1", meaning="share of the way to the apex without waypoints", maximum=0.5)
    normal: float = parameter(0.03, unit="m", meaning="way along the surface normal at both ends", minimum=0.001)
    level: float = parameter(0.5, unit="1", meaning="share when the sole is level", minimum=0.1)
    aligned: float = parameter(0.9, unit="1", meaning="share when it has the foothold's tilt")
    touchdown_speed: float = parameter(
        0.25, unit="m/s", meaning="speed down at landing and until the ground comes", minimum=0.0, maximum=1.0
    )
