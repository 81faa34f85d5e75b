"""The steps of a plan, each moved inside its region where the whole plan stays within its limits."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from skills.footsteps.footstep import Side, Stance
from skills.footsteps.footstep_parameters import FootstepParameters
from skills.footsteps.level_steps import level_step_allowed
from skills.footsteps.search_request import step_limits
from skills.footsteps.search_space import GROUND, STAND
from skills.footsteps.sole_snap import FOOTHOLD
from skills.footsteps.step_cost import step_cost
from skills.footsteps.terrain import Foothold, Terrain, slopes
from skills.footsteps.wiggle import wiggle_sole
from skills.geometry.pose import Array, Pose, wrap_angle
from skills.regions.planar_region import PlanarRegion

_NO_REFERENCE = np.zeros((0, 2))
# Tries of a move that breaks a limit: the whole of it, then half.
_TRIES = (1.0, 0.5)


def wiggle_steps(
    terrain: Terrain,
    stance: Stance,
    first_side: Side,
    landings: list[Foothold],
    parameters: FootstepParameters,
    goal_xy: Array | None = None,
) -> list[Foothold]:
    """Move each foothold off the edges of its region by the parameters' margin, or as far as limits allow.

    Args:
        terrain: the ground.
        stance: before the first step.
        first_side: the foot that makes it.
        landings: the footholds of the steps, all usable.
        parameters: limits and margin.
        goal_xy: where the middle of the feet ends, (2,) in the world; None where the steps do not end at a goal.

    Returns:
        As many footholds, usable, whose steps keep the limits.
    """
    limits = step_limits(parameters)
    soles = [stance.sole(first_side), stance.sole(first_side.opposite), *(_sole(landing) for landing in landings)]
    moved = list(landings)
    for i in range(len(landings)):
        side = first_side if i % 2 == 0 else first_side.opposite
        move = _move(terrain, soles[i + 2], parameters)
        if move is None:
            continue
        for part in _TRIES:
            candidate = _snapped(terrain, soles[i + 2], part * move, parameters)
            if candidate is None or candidate.share < landings[i].share:
                continue
            if goal_xy is not None and i >= len(landings) - 2:
                off_before, off = (
                    _off_goal(sole, side, goal_xy, parameters) for sole in (soles[i + 2], _sole(candidate))
                )
                if off > max(off_before, parameters.goal_tolerance):
                    continue
            tried = [*soles[: i + 2], _sole(candidate), *soles[i + 3 :]]
            # A foothold is the end of its step, the stance of the next and the start of the one after.
            if all(
                _allowed(terrain, limits, tried, k, side if (k - i) % 2 == 0 else side.opposite)
                for k in range(i, min(i + 3, len(landings)))
            ):
                soles, moved[i] = tried, candidate
                break
    return moved


def _off_goal(T_world_sole: Pose, side: Side, goal_xy: Array, parameters: FootstepParameters) -> float:
    """How far the body beside a foot is from the goal [m]."""
    half = 0.5 * side.sign * parameters.ideal_width
    body = T_world_sole.p[:2] + half * np.array((np.sin(T_world_sole.yaw), -np.cos(T_world_sole.yaw)))
    return float(np.linalg.norm(body - goal_xy))


def _sole(foothold: Foothold) -> Pose:
    assert foothold.T_world_sole is not None, "a usable foothold has a pose"
    return foothold.T_world_sole


def _move(terrain: Terrain, T_world_sole: Pose, parameters: FootstepParameters) -> Array | None:
    """The move (x, y, turn) in the sole's frame that its region asks for; None for none."""
    region = terrain.region(T_world_sole.p)
    if region is None:
        return None
    half = 0.5 * np.array((parameters.sole_length, parameters.sole_width))
    corners = half * np.array(((-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)))
    near = float(np.linalg.norm(half)) + parameters.wiggle_margin + parameters.wiggle_move
    edges = _edges_near(region, T_world_sole, near)
    move = np.zeros(3)
    limits = (parameters.wiggle_move, parameters.wiggle_turn)
    margin = wiggle_sole(edges, corners, parameters.wiggle_margin, *limits, move)
    return move if margin > 0.0 and np.any(move) else None


def _edges_near(region: PlanarRegion, T_world_sole: Pose, near: float) -> Array:
    """Edges of a region's rings that come near a sole's centre and have it inside: normal, offset, 1; sole's frame."""
    T_sole_region = T_world_sole.inverse @ region.T_world_region
    rows = []
    for ring in (region.hull_region, *region.holes_region):
        points = (T_sole_region @ np.column_stack((ring, np.zeros(len(ring)))))[:, :2]
        spans = np.roll(points, -1, axis=0) - points
        lengths = np.maximum(np.linalg.norm(spans, axis=1), 1e-9)
        normals = np.column_stack((spans[:, 1], -spans[:, 0])) / lengths[:, None]
        offsets = np.einsum("ij,ij->i", normals, points)
        along = np.clip(-np.einsum("ij,ij->i", points, spans) / lengths**2, 0.0, 1.0)
        distances = np.linalg.norm(points + along[:, None] * spans, axis=1)
        counts = (distances < near) & (offsets > 0.0) & (lengths > 1e-6)
        rows.append(np.column_stack((normals, offsets, counts))[counts])
    return np.ascontiguousarray(np.concatenate(rows))


def _snapped(terrain: Terrain, T_world_sole: Pose, move: Array, parameters: FootstepParameters) -> Foothold | None:
    """The foothold after a move; None where it is not usable."""
    x, y, z = T_world_sole @ np.array((move[0], move[1], 0.0))
    found = terrain.snap(float(x), float(y), T_world_sole.yaw + float(move[2]), parameters, float(z))
    return found if found.usable else None


def _allowed(terrain: Terrain, limits: NDArray[np.void], soles: list[Pose], step: int, side: Side) -> bool:
    """Whether a step of a sequence of soles keeps the limits; the first two soles are the stance before the steps."""
    start, stance, landing = soles[step], soles[step + 1], soles[step + 2]
    cos, sin = np.cos(stance.yaw), np.sin(stance.yaw)
    dx, dy, _ = landing.p - stance.p
    length, width = cos * dx + sin * dy, side.sign * (cos * dy - sin * dx)
    outward = side.sign * wrap_angle(landing.yaw - stance.yaw)
    if not level_step_allowed(limits[0], length, width, outward):
        return False
    corner = terrain.corner_world
    a, b = slopes(stance)
    stand = np.zeros(1, dtype=STAND)
    record = stand[0]
    record["x"], record["y"], record["z"] = *(stance.p[:2] - corner), stance.p[2]
    record["cos"], record["sin"], record["uphill"] = cos, sin, a * cos + b * sin
    record["swing_x"], record["swing_y"], record["swing_z"] = *(start.p[:2] - corner), start.p[2]
    ground = np.array([(landing.p[2], *slopes(landing), 1.0, FOOTHOLD)], dtype=GROUND)
    x, y = landing.p[:2] - corner
    return step_cost(terrain.raster, limits[0], _NO_REFERENCE, stand[0], float(x), float(y), ground[0]) >= 0.0
