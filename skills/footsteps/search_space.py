"""The memory that a footstep search works on: its limits, its goal, its lattice, and what it learns on the way.

Kernels take it whole, as one named tuple over plain and structured arrays that is made anew for every search.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.plane_raster import Raster
from skills.footsteps.records import Records
from skills.geometry.pose import Array

# Fields are named after the parameters; the half sizes, uphill_tangent, heading (angle
# between two), stride and turn (the most of a step) come from them.
STEP_LIMITS = np.dtype(
    [
        (name, np.float64)
        for name in (
            *("half_length", "half_width", "reach", "reach_up", "reach_up_height", "reach_down", "reach_down_height"),
            *("back_reach", "minimum_width", "ideal_width", "maximum_width", "sole_gap", "max_step_height"),
            *("inward_yaw", "outward_yaw", "uphill_drop", "uphill_tangent", "in_place", "swing_reach"),
            *("swing_height_change",),
            *("body_width", "body_depth", "body_base", "body_top", "step_over"),
            *("step_cost", "height_cost", "tilt_cost", "yaw_cost", "width_cost", "path_cost", "share_cost"),
            *("lattice", "heading", "stride", "turn", "heuristic_weight", "minimum_steps"),
            *("goal_tolerance", "goal_yaw_tolerance", "goal_height_tolerance", "final_turn", "field_cell"),
            "tilt_tangent",
        )
    ]
)
# Progress that ends a search, height of the goal, most that a step brings the body on, what the last foot may be off
# along the way, across it and in heading, whether the way ends there, and whether both feet are to stand at the end.
SEARCH_GOAL = np.dtype(
    [
        *((name, np.float64) for name in ("arc_length", "z", "stride", "along", "across", "turn")),
        ("ends", np.bool_),
        ("final", np.bool_),
    ]
)
# Numbers of floors, headings, rows and columns, those of the stance foot, and how many nodes one side has.
LATTICE = np.dtype(
    [(name, np.int64) for name in ("floors", "headings", "ny", "nx", "floor", "heading", "iy", "ix", "stances")]
)
# What became of a step that a search looked at: after how many expansions, from which node to which, its outcome or why
# it was rejected, its height, the cost with it and the estimated cost to go. Steps to a node to which a cheaper way is
# known are left out.
EDGE_LOG = np.dtype(
    [
        *((name, np.int32) for name in ("expansion", "parent", "node")),
        *((name, np.float32) for name in ("z", "cost", "to_go")),
        ("reason", np.uint8),
    ]
)
# Instead of a reason: the node was expanded, or opened.
EXPANDED, OPENED = range(2)
# A foot on the lattice: cost of the way there, what progress may still take off the cost to go, the estimate of that
# cost, what being off the path costs, and the way back.
NODE = np.dtype(
    [
        *((name, np.float64) for name in ("cost", "left", "to_go", "off_path_cost")),
        *((name, np.int64) for name in ("parent", "depth")),
        *((name, np.uint8) for name in ("status", "arrived")),
    ]
)
UNKNOWN, JUDGED, OPEN, CLOSED = range(4)
# Where a search stands.
SEARCH_STATE = np.dtype(
    [*((name, np.int64) for name in ("begun", "expansions", "size", "best")), ("start_left", np.float64)]
)
# What the ground is under a foot of either side: outcome of the snap, height, slopes, supported share.
GROUND = np.dtype([*((name, np.float64) for name in ("z", "a", "b", "share")), ("outcome", np.uint8)])
# What a step from a stance foot depends on.
STAND = np.dtype(
    [
        *((name, np.float64) for name in ("x", "y", "z", "cos", "sin", "uphill", "cost")),
        *((name, np.float64) for name in ("swing_x", "swing_y", "swing_z", "swing_yaw")),
        ("depth", np.int64),
    ]
)


class SearchSpace(NamedTuple):
    """What a search works on; x and y are measured from the corner of the raster [m].

    A node is (((side * floors + floor) * headings + heading) * ny + iy) * nx + ix; side 0 is left, and the node past
    the last is the swing foot where it is now. In this order a search, which uses few headings, touches little memory.

    Attributes:
        raster: ground and walls.
        snap_limits: one `SNAP_LIMITS`.
        samples: where a sole feels the ground, (N, 2).
        limits: one `STEP_LIMITS`.
        goal: one `SEARCH_GOAL`.
        path: (N, 4) rows of x, y, heading, arc length.
        field: how far the goal is, see `goal_field`; empty where a path leads there.
        feet: (2, 7) stance foot, then swing foot: x, y, z, heading, slopes a and b, side (+1 left).
        lattice: one `LATTICE`.
        headings: (H + 2, 3) rows of angle, its cosine and sine: the lattice's, then the swing foot's and the stance's.
        nodes: one `NODE` a node, zero.
        grounds: one `GROUND` a node of one side, zero.
        steps: (2 H + 1, M, 3) steps on level ground by side and heading of a foot, then those of the stance foot where
            it is now; see `fill_level_steps`.
        step_counts: how many of them are known, (2 H + 1,), zero.
        stand: one `STAND`, that of the stance foot at hand.
        snapped: (4,) what the last snap found.
        state: one `SEARCH_STATE`, zero.
        rejections: counts by reason, added to.
        level_rejections: (2 H + 1, reasons) the same for steps that never were, ordered as `steps`, zero.
        log: the `EDGE_LOG`s that are written; none where there is no room.
        logged: (1,) how many, zero.
    """

    raster: Raster
    snap_limits: Records
    samples: Array
    limits: Records
    goal: Records
    path: Array
    field: Array
    feet: Array
    lattice: Records
    headings: Array
    nodes: Records
    grounds: Records
    steps: NDArray[np.int64]
    step_counts: NDArray[np.int64]
    stand: Records
    snapped: Array
    state: Records
    rejections: NDArray[np.int64]
    level_rejections: NDArray[np.int64]
    log: Records
    logged: NDArray[np.int64]
