"""The steps of a plan, each moved inside its region where the whole plan stays within its limits."""

from __future__ import annotations

from dataclasses import replace
from math import hypot

import numpy as np

from skills.footsteps.footstep import Side
from skills.footsteps.footstep_parameters import FootstepParameters
from skills.footsteps.supported_polygon import whole_sole
from skills.footsteps.terrain import Foothold, Terrain
from skills.footsteps.way import WayRules, body_beside, sole_of
from skills.footsteps.wiggle import sole_margin, wiggle_sole
from skills.geometry.pose import Array, Pose

# Tries of a move that breaks a limit: the whole of it, then half.
_TRIES = (1.0, 0.5)


def wiggle_steps(
    terrain: Terrain,
    rules: WayRules,
    first_side: Side,
    footholds: list[Foothold],
    first: int,
    parameters: FootstepParameters,
    goal_xy: Array | None = None,
) -> list[Foothold]:
    """Move footholds off the edges of their regions by the parameters' margin, or as far as limits allow.

    Args:
        terrain: the ground.
        rules: what the steps must keep to.
        first_side: the foot that makes the first step.
        footholds: the footholds of the steps, all usable.
        first: those before this one stay where they are.
        parameters: limits and margin.
        goal_xy: where the middle of the feet ends, (2,) in the world; None where the steps do not end at a goal.

    Returns:
        As many footholds, usable, whose steps keep the limits, each with the margin that it has.
    """
    moved = list(footholds)
    for i in range(len(moved)):
        side = first_side if i % 2 == 0 else first_side.opposite
        margin, move = _wanted(terrain, sole_of(moved[i]), parameters)
        moved[i] = replace(moved[i], margin=margin)
        if i < first or not np.any(move):
            continue
        for part in _TRIES:
            candidate = _snapped(terrain, sole_of(moved[i]), part * move, parameters)
            if candidate is None or candidate.share < moved[i].share or candidate.margin <= margin:
                continue
            if goal_xy is not None and i >= len(moved) - 2:
                before, after = (body_beside(sole_of(step), side, parameters) for step in (moved[i], candidate))
                if _farther_off(before, after, goal_xy, parameters):
                    continue
            # A foothold is the end of its step, the stance of the next and the start of the one after.
            if not rules.rejection([*moved[:i], candidate, *moved[i + 1 :]], i, i + 2):
                moved[i] = candidate
                break
    return moved


def _farther_off(before_xy: Array, after_xy: Array, goal_xy: Array, parameters: FootstepParameters) -> bool:
    """Whether a move takes the body beyond what is allowed at the goal, or beyond what it was."""
    off_before, off = np.linalg.norm(before_xy - goal_xy), np.linalg.norm(after_xy - goal_xy)
    return bool(off > max(off_before, parameters.goal_tolerance))


def _wanted(terrain: Terrain, T_world_sole: Pose, parameters: FootstepParameters) -> tuple[float, Array]:
    """The margin that a sole has inside its region, and the move (x, y, turn) in its frame that it asks for."""
    move = np.zeros(3)
    near = (
        0.5 * hypot(parameters.sole_length, parameters.sole_width) + parameters.wiggle_margin + parameters.wiggle_move
    )
    edges, sole = terrain.edges(T_world_sole, near), whole_sole(parameters)
    if edges is None:
        return 0.0, move
    margin = sole_margin(edges, sole, parameters.wiggle_margin)
    if margin < parameters.wiggle_margin:
        limits = (parameters.wiggle_move, parameters.wiggle_turn)
        wiggle_sole(edges, sole, parameters.wiggle_margin, *limits, move)
    return margin, move


def _snapped(terrain: Terrain, T_world_sole: Pose, move: Array, parameters: FootstepParameters) -> Foothold | None:
    """The foothold after a move, with its margin; None where it is not usable."""
    x, y, z = T_world_sole @ np.array((move[0], move[1], 0.0))
    found = terrain.snap(float(x), float(y), T_world_sole.yaw + float(move[2]), parameters, float(z))
    if not found.usable:
        return None
    return replace(found, margin=_wanted(terrain, sole_of(found), parameters)[0])
