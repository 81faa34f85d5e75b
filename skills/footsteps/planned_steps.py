"""From footholds to steps: the way of each foot through the air, how long it takes, and what of its sole carries."""

from __future__ import annotations

from itertools import pairwise
from math import dist

from skills.footsteps.footstep import Footstep, Side, Stance
from skills.footsteps.footstep_parameters import FootstepParameters
from skills.footsteps.landing_region import landing_region
from skills.footsteps.supported_polygon import whole_sole
from skills.footsteps.swing_clearance import SwingClearance, swing_clearance
from skills.footsteps.terrain import Foothold, Terrain
from skills.footsteps.way import sole_of
from skills.geometry.pose import Pose


def planned_steps(
    terrain: Terrain,
    stance: Stance,
    first_side: Side,
    footholds: tuple[Foothold, ...],
    parameters: FootstepParameters,
    first_sequence_id: int,
) -> tuple[Footstep, ...]:
    """Footholds from a stance as steps, each with its swing."""
    steps: list[Footstep] = []
    side = first_side
    for i, foothold in enumerate(footholds):
        start, landing = stance.sole(side), sole_of(foothold)
        swing = swing_clearance(terrain, start, landing, parameters)
        whole = foothold.share >= 1.0
        steps.append(
            Footstep(
                sequence_id=first_sequence_id + i,
                side=side,
                T_world_sole=landing,
                foothold_sole=whole_sole(parameters) if whole else terrain.foothold_polygon(landing, parameters),
                swing_duration=swing_duration(start, landing, swing, parameters),
                transfer_duration=parameters.transfer_duration,
                swing_height=swing.height,
                swing_waypoints_world=swing.waypoints_world,
                landing_region_sole=landing_region(terrain, landing, parameters),
                margin=foothold.margin,
            )
        )
        stance = stance.with_sole(side, landing)
        side = side.opposite
    return tuple(steps)


def swing_duration(
    T_world_start: Pose, T_world_end: Pose, swing: SwingClearance, parameters: FootstepParameters
) -> float:
    """How long a foot is in the air [s]: the parameters' time, and longer in proportion where its way is long."""
    corners = (T_world_start.p, *swing.waypoints_world, T_world_end.p)
    length = sum(dist(a, b) for a, b in pairwise(corners))
    return parameters.swing_duration * max(1.0, length / parameters.swing_way)
