"""A request for footsteps as the search takes it: terrain, stance, sub-goal and parameters as plain arrays."""

from __future__ import annotations

from functools import lru_cache
from mmap import MAP_ANONYMOUS, MAP_PRIVATE, mmap

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.footstep import Side, Stance
from skills.footsteps.footstep_lattice import FootstepLattice
from skills.footsteps.footstep_parameters import FootstepParameters
from skills.footsteps.level_steps import most_level_steps
from skills.footsteps.rejections import REASONS
from skills.footsteps.search_space import (
    EDGE_LOG,
    GROUND,
    NODE,
    SEARCH_GOAL,
    SEARCH_STATE,
    STAND,
    STEP_LIMITS,
    SearchSpace,
)
from skills.footsteps.search_target import SearchTarget
from skills.footsteps.stride import stride_towards
from skills.footsteps.terrain import Terrain, foothold_rules, pack, slopes
from skills.geometry.pose import Array


def search_space(
    terrain: Terrain,
    lattice: FootstepLattice,
    stance: Stance,
    first_side: Side,
    target: SearchTarget,
    parameters: FootstepParameters,
    fewest_steps: int,
    logged_expansions: int,
) -> SearchSpace:
    """Fresh memory for a search whose first step `first_side` makes, and for the log of so many expansions.

    It may end at a sub-goal after `fewest_steps`.
    """
    corner = terrain.corner_world
    headings = lattice.shape[1]
    snap_limits, samples = foothold_rules(parameters)
    limits = step_limits(parameters).copy()
    limits["minimum_steps"] = fewest_steps
    return SearchSpace(
        raster=terrain.raster,
        snap_limits=snap_limits,
        samples=samples,
        limits=limits,
        goal=goal_record(target),
        path=target.path_world - (*corner, 0.0, 0.0),
        field=target.field,
        feet=np.array([_foot(stance, side, corner) for side in (first_side.opposite, first_side)]),
        lattice=lattice.record(),
        headings=lattice.headings(*(stance.sole(side).yaw for side in (first_side, first_side.opposite))),
        nodes=_zeros(2 * lattice.stances + 1, NODE),
        grounds=_zeros(lattice.stances, GROUND),
        steps=np.empty((2 * headings + 1, most_level_steps(parameters), 3), dtype=np.int64),
        step_counts=np.zeros(2 * headings + 1, dtype=np.int64),
        stand=np.zeros(1, dtype=STAND),
        snapped=np.zeros(4),
        state=np.zeros(1, dtype=SEARCH_STATE),
        rejections=np.zeros(len(REASONS), dtype=np.int64),
        level_rejections=np.zeros((2 * headings + 1, len(REASONS)), dtype=np.int64),
        log=_zeros(_most_logged(logged_expansions, lattice, parameters), EDGE_LOG),
        logged=np.zeros(1, dtype=np.int64),
    )


def _most_logged(expansions: int, lattice: FootstepLattice, parameters: FootstepParameters) -> int:
    """Each step from an expanded node is noted when it is opened or rejected, and once more when it was lazy."""
    if expansions == 0:
        return 0
    return (expansions + 1) * (1 + 2 * lattice.shape[0] * most_level_steps(parameters))


def _zeros(count: int, dtype: np.dtype[np.void]) -> NDArray[np.void]:
    """Zeros of which only what is touched costs time: fresh pages from the system, where numpy may clear old memory."""
    if count == 0:
        return np.zeros(0, dtype=dtype)
    pages = mmap(-1, count * dtype.itemsize, flags=MAP_PRIVATE | MAP_ANONYMOUS)
    return np.frombuffer(pages, dtype=dtype)


def _foot(stance: Stance, side: Side, corner: Array) -> tuple[float, ...]:
    sole = stance.sole(side)
    x, y = sole.p[:2] - corner
    return (x, y, sole.p[2], sole.yaw, *slopes(sole), side.sign)


def goal_record(target: SearchTarget) -> NDArray[np.void]:
    """What ends a search, as the kernels take it: one `SEARCH_GOAL`."""
    row = (target.arc_length, target.z, target.stride, *target.tolerances, target.ends, target.final)
    return np.array([row], dtype=SEARCH_GOAL)


@lru_cache(maxsize=8)
def step_limits(parameters: FootstepParameters) -> NDArray[np.void]:
    """Limits, costs and settings, as the search takes them: one `STEP_LIMITS`."""
    turn = max(parameters.inward_yaw, parameters.outward_yaw)
    derived = {
        "half_length": 0.5 * parameters.sole_length,
        "half_width": 0.5 * parameters.sole_width,
        "tilt_tangent": np.tan(parameters.tilt),
        "uphill_tangent": np.tan(parameters.uphill_slope),
        "stride": stride_towards(0.0, parameters),
        "turn": turn,
        "heading": 2 * np.pi / parameters.headings,
    }
    limits = pack(STEP_LIMITS, parameters, derived)
    limits.flags.writeable = False
    return limits
