"""A request for footsteps as the search takes it: terrain, stance, sub-goal and parameters as plain arrays."""

from __future__ import annotations

from mmap import MAP_ANONYMOUS, MAP_PRIVATE, mmap

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.footstep import FootstepPlan, Side, Stance
from skills.footsteps.footstep_lattice import FootstepLattice
from skills.footsteps.footstep_parameters import FootstepParameters
from skills.footsteps.level_steps import most_level_steps
from skills.footsteps.search_space import GROUND, NODE, SEARCH_GOAL, STAND, STEP_LIMITS, SearchSpace
from skills.footsteps.search_target import SearchTarget
from skills.footsteps.step_cost import REASONS
from skills.footsteps.terrain import Terrain, foothold_rules, pack, slopes
from skills.geometry.pose import Array

_SAME_PLACE = 0.03


def search_space(
    terrain: Terrain,
    lattice: FootstepLattice,
    stance: Stance,
    first_side: Side,
    target: SearchTarget,
    reference: FootstepPlan | None,
    parameters: FootstepParameters,
) -> SearchSpace:
    """Fresh memory for a search whose first step `first_side` makes; `reference` is the plan before."""
    corner = terrain.corner_world
    headings = lattice.shape[1]
    snap_limits, samples = foothold_rules(parameters)
    return SearchSpace(
        raster=terrain.raster,
        snap_limits=snap_limits,
        samples=samples,
        limits=step_limits(parameters),
        goal=np.array([(target.arc_length, target.z, target.final)], dtype=SEARCH_GOAL),
        path=target.path_world - (*corner, 0.0, 0.0),
        field=target.field,
        reference=_reference_places(reference, stance, first_side, parameters.reference_steps) - corner,
        feet=np.array([_foot(stance, side, corner) for side in (first_side.opposite, first_side)]),
        lattice=lattice.record(),
        headings=lattice.headings(stance.sole(first_side).yaw),
        nodes=_zeros(2 * lattice.stances + 1, NODE),
        grounds=_zeros(lattice.stances, GROUND),
        steps=np.empty((2 * headings, most_level_steps(parameters), 3), dtype=np.int64),
        step_counts=np.zeros(2 * headings, dtype=np.int64),
        stand=np.zeros(1, dtype=STAND),
        snapped=np.zeros(4),
        rejections=np.zeros(len(REASONS), dtype=np.int64),
    )


def _zeros(count: int, dtype: np.dtype[np.void]) -> NDArray[np.void]:
    """Zeros of which only what is touched costs time: fresh pages from the system, where numpy may clear old memory."""
    pages = mmap(-1, count * dtype.itemsize, flags=MAP_PRIVATE | MAP_ANONYMOUS)
    return np.frombuffer(pages, dtype=dtype)


def _foot(stance: Stance, side: Side, corner: Array) -> tuple[float, ...]:
    sole = stance.sole(side)
    x, y = sole.p[:2] - corner
    return (x, y, sole.p[2], sole.yaw, *slopes(sole), side.sign)


def _reference_places(reference: FootstepPlan | None, stance: Stance, first_side: Side, count: int) -> Array:
    """Places of the first `count` steps in the plan before, (count, 2); NaN where it has none.

    They are the steps after the one that lands where the stance foot stands, or, where none does, its first steps.
    """
    places = np.full((count, 2), np.nan)
    steps = () if reference is None else reference.steps
    stance_xy = stance.sole(first_side.opposite).p[:2]
    for i, step in enumerate(steps):
        if step.side is not first_side and np.linalg.norm(step.T_world_sole.p[:2] - stance_xy) < _SAME_PLACE:
            steps = steps[i + 1 :]
            break
    if steps and steps[0].side is first_side:
        known = np.array([step.T_world_sole.p[:2] for step in steps[:count]])
        places[: len(known)] = known
    return places


def step_limits(parameters: FootstepParameters) -> NDArray[np.void]:
    """Limits, costs and settings, as the search takes them: one `STEP_LIMITS`."""
    turn = max(parameters.inward_yaw, parameters.outward_yaw)
    derived = {
        "half_length": 0.5 * parameters.sole_length,
        "half_width": 0.5 * parameters.sole_width,
        "tilt_tangent": np.tan(parameters.tilt),
        "uphill_tangent": np.tan(parameters.uphill_slope),
        # The body beside a foot moves on by the reach, and a little more where the foot turns.
        "stride": parameters.reach + 0.5 * parameters.ideal_width * turn,
        "turn": turn,
        "heading": 2 * np.pi / parameters.headings,
    }
    return pack(STEP_LIMITS, parameters, derived)
