"""Consistency: the steps of the plan before that may still be made are made, as long as they are about as good.

A plan that changes with every image makes a robot restless, and where two ways are equally good it may step on the
spot for ever. So the steps that were planned before and have not begun are put on the ground as it is known now, and
searched on from; a fresh plan takes their place only where it is cheaper by more than a share, or gets farther.
"""

from __future__ import annotations

from math import cos, pi, sin

import numpy as np

from skills.footsteps.footstep import Footstep, FootstepPlan, Side, Stance
from skills.footsteps.footstep_parameters import FootstepParameters
from skills.footsteps.terrain import Foothold, Terrain
from skills.footsteps.way import Way, WayRules, sole_of
from skills.geometry.pose import Pose

# A step of the plan before led to a foot that stands so near [m].
_SAME_PLACE = 0.03
_DIRECTIONS = 8


def steps_ahead(reference: FootstepPlan, stance: Stance, first_side: Side) -> tuple[Footstep, ...]:
    """The steps of a plan that are still to be made from a stance: empty where it does not go on from there.

    They are the steps after the one that landed where the stance foot stands, or, where none did, its first steps.
    """
    steps = reference.steps
    stance_xy = stance.sole(first_side.opposite).p[:2]
    for i, step in enumerate(steps):
        if step.side is not first_side and np.linalg.norm(step.T_world_sole.p[:2] - stance_xy) < _SAME_PLACE:
            steps = steps[i + 1 :]
            break
    return steps if steps and steps[0].side is first_side else ()


def kept_footholds(
    terrain: Terrain, steps: tuple[Footstep, ...], rules: WayRules, parameters: FootstepParameters
) -> list[Foothold]:
    """The footholds of the first steps that are allowed on the ground as it is known now.

    A step that is not is moved a little if that makes it so; the first that cannot be kept ends the way.
    """
    kept: list[Foothold] = []
    for step in steps:
        for move in _moves(parameters):
            found = _put(terrain, step.T_world_sole, move, parameters)
            if found.usable and not rules.rejection([*kept, found], len(kept), len(kept)):
                kept.append(found)
                break
        else:
            break
    return kept


def nearly_kept(
    terrain: Terrain, first: Foothold, fresh: Foothold, rules: WayRules, parameters: FootstepParameters
) -> list[Foothold]:
    """Footholds next to that of the first step, where a way may be cheaper that begins almost as it was planned.

    The first of them lies on the way to the first foothold of a fresh plan.
    """
    T_world_sole = sole_of(first)
    off = T_world_sole.inverse @ sole_of(fresh).p
    towards = np.arctan2(off[1], off[0])
    part = min(1.0, parameters.keep_move / max(float(np.hypot(off[0], off[1])), 1e-9))
    moves = [(part * off[0], part * off[1])]
    for angle in towards + 0.5 * pi * np.arange(1, 4):
        moves.append((parameters.keep_move * cos(angle), parameters.keep_move * sin(angle)))
    found = [_put(terrain, T_world_sole, move, parameters) for move in moves]
    return [foothold for foothold in found if foothold.usable and not rules.rejection([foothold], 0, 0)]


def holds(kept: Way, fresh: Way, parameters: FootstepParameters) -> bool:
    """Whether a kept way is about as good as a fresh one: as far as it is to go, and not much dearer."""
    if kept.reached != fresh.reached:
        return kept.reached
    if kept.reached:
        return kept.cost <= (1.0 + parameters.keep_share) * fresh.cost
    far_enough = max(parameters.minimum_progress, (1.0 - parameters.keep_share) * fresh.progress)
    return kept.progress >= far_enough


def _put(terrain: Terrain, T_world_sole: Pose, move: tuple[float, float], parameters: FootstepParameters) -> Foothold:
    """The foothold at a place moved in the sole's frame, on the ground as it is now."""
    x, y, z = T_world_sole @ np.array((*move, 0.0))
    return terrain.snap(float(x), float(y), T_world_sole.yaw, parameters, float(z))


def _moves(parameters: FootstepParameters) -> list[tuple[float, float]]:
    """None at first, then small ones in all directions, then larger ones."""
    moves = [(0.0, 0.0)]
    for part in (0.5, 1.0):
        for k in range(_DIRECTIONS if parameters.keep_move > 0.0 else 0):
            angle = 2 * pi * k / _DIRECTIONS
            moves.append((part * parameters.keep_move * cos(angle), part * parameters.keep_move * sin(angle)))
    return moves
