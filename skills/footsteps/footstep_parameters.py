"""What a step may be and what it costs: the limits, costs and search settings of the footstep planner.

Limits hold in the level frame of the stance foot; reach is measured from the ideal stance point, the place beside the
stance foot at ideal width (after Griffin et al., 2019).
"""

from __future__ import annotations

from math import radians

from skills.parameters import parameter, parameters


@parameters
class FootstepParameters:
    """Limits, costs and search settings of the footstep planner."""

    sole_length: float = parameter(0.26, unit="m", meaning="length of the sole", minimum=0.1, maximum=0.5)
    sole_width: float = parameter(0.138, unit="m", meaning="width of the sole", minimum=0.05, maximum=0.3)
    swing_duration: float = parameter(0.8, unit="s", meaning="time of a step in the air", minimum=0.3, maximum=5.0)
    transfer_duration: float = parameter(0.3, unit="s", meaning="double support before it", minimum=0.05, maximum=5.0)

    reach: float = parameter(0.52, unit="m", meaning="longest step", minimum=0.1, maximum=1.0)
    reach_up: float = parameter(0.45, unit="m", meaning="longest step up", minimum=0.1, maximum=1.0)
    reach_up_height: float = parameter(0.12, unit="m", meaning="rise from which a step is a step up", minimum=0.0)
    reach_down: float = parameter(0.42, unit="m", meaning="longest step down", minimum=0.1, maximum=1.0)
    reach_down_height: float = parameter(0.10, unit="m", meaning="drop from which a step is a step down", minimum=0.0)
    back_reach: float = parameter(0.12, unit="m", meaning="longest way back", minimum=0.0, maximum=0.5)
    minimum_width: float = parameter(0.17, unit="m", meaning="smallest distance sideways", minimum=0.0, maximum=0.5)
    ideal_width: float = parameter(0.24, unit="m", meaning="distance sideways that costs nothing", minimum=0.1)
    maximum_width: float = parameter(0.40, unit="m", meaning="largest distance sideways", minimum=0.1, maximum=0.8)
    sole_gap: float = parameter(0.01, unit="m", meaning="smallest gap between the two soles", minimum=0.0, maximum=0.1)
    max_step_height: float = parameter(
        0.26, unit="m", meaning="largest rise or drop of a step", minimum=0.0, maximum=0.6
    )
    inward_yaw: float = parameter(radians(10.0), unit="rad", meaning="largest turn inwards", minimum=0.0, maximum=1.0)
    outward_yaw: float = parameter(radians(20.0), unit="rad", meaning="largest turn outwards", minimum=0.0, maximum=1.5)
    uphill_drop: float = parameter(0.12, unit="m", meaning="largest drop off a foot that stands uphill", minimum=0.0)
    uphill_slope: float = parameter(radians(8.0), unit="rad", meaning="slope from which a foot stands uphill")
    in_place: float = parameter(0.02, unit="m", meaning="a foot moved less, and not turned, is stuck", minimum=0.0)
    swing_reach: float = parameter(0.95, unit="m", meaning="longest way of a foot in the air", minimum=0.1)
    swing_height_change: float = parameter(0.45, unit="m", meaning="largest rise or drop of a foot in the air")

    tilt: float = parameter(radians(25.0), unit="rad", meaning="steepest foothold", minimum=0.0, maximum=1.0)
    share: float = parameter(0.97, unit="1", meaning="smallest supported share of the sole", minimum=0.1, maximum=1.0)
    support_below: float = parameter(0.008, unit="m", meaning="ground this far below the sole supports it", minimum=0.0)
    ground_above: float = parameter(0.008, unit="m", meaning="highest ground above the sole, under it", minimum=0.0)
    sole_edge: float = parameter(0.01, unit="m", meaning="ground so near counts as under it", minimum=0.0, maximum=0.1)
    cliff_height: float = parameter(0.05, unit="m", meaning="highest ground above the sole, beside it", minimum=0.0)
    cliff_toe: float = parameter(0.04, unit="m", meaning="distance before the toe without a cliff", minimum=0.0)
    cliff_side: float = parameter(0.02, unit="m", meaning="distance from heel and sides without a cliff", minimum=0.0)

    shin_height: float = parameter(0.3, unit="m", meaning="highest ground before the shin", minimum=0.0)
    shin_toe: float = parameter(0.08, unit="m", meaning="distance before the toe that the shin needs", minimum=0.0)
    shin_side: float = parameter(0.04, unit="m", meaning="distance from heel and sides that it needs", minimum=0.0)
    drop_depth: float = parameter(0.1, unit="m", meaning="deepest ground beside the sole", minimum=0.0)
    drop_distance: float = parameter(0.0, unit="m", meaning="distance from the sole without a drop", minimum=0.0)

    body_width: float = parameter(0.45, unit="m", meaning="width of the body, for obstacles", minimum=0.0, maximum=2.0)
    body_depth: float = parameter(0.30, unit="m", meaning="depth of the body, for obstacles", minimum=0.0, maximum=2.0)
    body_base: float = parameter(0.45, unit="m", meaning="height over the feet of the body's lower end", minimum=0.0)
    body_top: float = parameter(1.7, unit="m", meaning="height over the feet of its upper end", minimum=0.0)
    step_over: float = parameter(
        0.3, unit="m", meaning="highest wall, over the feet, that is stepped over", minimum=0.0
    )

    step_cost: float = parameter(0.15, unit="1", meaning="cost of a step", minimum=0.01)
    height_cost: float = parameter(0.5, unit="1/m", meaning="cost of a rise or drop", minimum=0.0)
    tilt_cost: float = parameter(0.05, unit="1", meaning="cost of a foothold's slope, times its tangent", minimum=0.0)
    yaw_cost: float = parameter(0.29, unit="1/rad", meaning="cost of a heading off the path's", minimum=0.0)
    width_cost: float = parameter(0.2, unit="1/m", meaning="cost of a width off the ideal", minimum=0.0)
    path_cost: float = parameter(0.2, unit="1/m", meaning="cost of a step off the path", minimum=0.0)
    share_cost: float = parameter(1.0, unit="1", meaning="cost of an unsupported sole", minimum=0.0)
    keep_share: float = parameter(
        0.05, unit="1", meaning="share by which a kept plan may be dearer than a fresh one", minimum=0.0, maximum=1.0
    )
    keep_move: float = parameter(
        0.028, unit="m", meaning="way that a kept step may move to be allowed, or to hold", minimum=0.0, maximum=0.1
    )
    keep_expansions: int = parameter(
        150, unit="1", meaning="nodes the search for the rest of a kept plan may expand", minimum=1
    )
    recheck_expansions: int = parameter(
        400, unit="1", meaning="nodes the search for a fresh plan may expand where a kept one gets on", minimum=1
    )

    wiggle_margin: float = parameter(0.02, unit="m", meaning="distance wanted from a region's edges", minimum=0.0)
    wiggle_move: float = parameter(0.03, unit="m", meaning="largest move for it, each way", minimum=0.0, maximum=0.2)
    wiggle_turn: float = parameter(0.04, unit="rad", meaning="largest turn for it", minimum=0.0, maximum=0.5)

    swing_height: float = parameter(0.08, unit="m", meaning="rise above the higher foothold", minimum=0.0, maximum=0.4)
    swing_way: float = parameter(0.95, unit="m", meaning="way in the air for which the time suffices", minimum=0.1)
    swing_clearance: float = parameter(0.05, unit="m", meaning="height above all ground on the way", minimum=0.0)
    swing_margin: float = parameter(0.02, unit="m", meaning="ground beside the way that counts as on it", minimum=0.0)
    swing_leg_clearance: float = parameter(0.03, unit="m", meaning="height above ground while it rises", minimum=0.0)
    swing_lead: float = parameter(0.2, unit="1", meaning="share of the way made while it rises", maximum=0.5)
    lift_off_zone: float = parameter(0.20, unit="m", meaning="way after lift-off that is looked at", minimum=0.0)
    lift_off_obstacle: float = parameter(0.06, unit="m", meaning="ground there so high: up before forward", minimum=0.0)
    landing_zone: float = parameter(0.22, unit="m", meaning="way before landing that is looked at", minimum=0.0)
    landing_obstacle: float = parameter(
        0.03, unit="m", meaning="ground there so high: forward before down", minimum=0.0
    )

    landing_move: float = parameter(
        0.15, unit="m", meaning="farthest a step may land from its foothold to save balance", minimum=0.0, maximum=0.5
    )
    landing_margin: float = parameter(
        0.02, unit="m", meaning="distance of such a landing from the region's edges", minimum=0.0, maximum=0.2
    )

    lattice: float = parameter(0.04, unit="m", meaning="spacing of the search lattice", minimum=0.01, maximum=0.2)
    headings: int = parameter(36, unit="1", meaning="headings of the lattice in a full turn", minimum=8, maximum=360)
    heuristic_weight: float = parameter(
        3.0, unit="1", meaning="weight of the least cost to go", minimum=0.0, maximum=10.0
    )
    max_expansions: int = parameter(3000, unit="1", meaning="nodes a search may expand", minimum=1)
    minimum_steps: int = parameter(3, unit="1", meaning="fewest steps to a sub-goal", minimum=1, maximum=10)
    window_margin: float = parameter(0.7, unit="m", meaning="ground searched on all sides of the path", minimum=0.3)
    heading_margin: float = parameter(0.7, unit="rad", meaning="headings searched beyond the path's", minimum=0.2)
    along_tolerance: float = parameter(0.10, unit="m", meaning="sub-goal tolerance along the path", minimum=0.01)
    across_tolerance: float = parameter(0.29, unit="m", meaning="sub-goal tolerance across the path", minimum=0.01)
    heading_tolerance: float = parameter(0.35, unit="rad", meaning="sub-goal tolerance of the heading", minimum=0.0)
    goal_tolerance: float = parameter(0.06, unit="m", meaning="distance of each foot from its place at the goal")
    goal_yaw_tolerance: float = parameter(0.13, unit="rad", meaning="heading of each foot off the goal's", minimum=0.0)
    near_goal: float = parameter(
        0.15, unit="m", meaning="that distance of the last foot, where feet need not end side by side", minimum=0.0
    )
    goal_height_tolerance: float = parameter(0.3, unit="m", meaning="height of a foot off the goal's", minimum=0.0)
    final_turn: float = parameter(0.3, unit="m", meaning="distance at which the goal's heading is taken", minimum=0.0)
    field_cell: float = parameter(0.06, unit="m", meaning="cell of the field that guides a whole way", minimum=0.02)
    whole_way_expansions: int = parameter(
        10000, unit="1", meaning="nodes a search for a whole way may expand", minimum=1
    )
    minimum_progress: float = parameter(0.1, unit="m", meaning="progress that a partial plan must make", minimum=0.0)


@parameters
class TerrainParameters:
    """How planar regions become ground under a sole."""

    resolution: float = parameter(0.01, unit="m", meaning="cell size of the raster", minimum=0.002, maximum=0.05)
    seam_width: float = parameter(0.03, unit="m", meaning="gap between regions that counts as ground", minimum=0.0)
    seam_step: float = parameter(0.02, unit="m", meaning="largest height difference across a seam", minimum=0.0)
    wall_resolution: float = parameter(0.02, unit="m", meaning="cell size for walls", minimum=0.005, maximum=0.1)
    steepest_region: float = parameter(radians(70.0), unit="rad", meaning="steeper regions are walls", maximum=1.5)
