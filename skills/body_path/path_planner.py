"""Plans the way of the body over a height map, and plans it again while the robot walks it.

Search, then smoothing, then headings. Every request has a path for an answer: to the goal; to the border of the map
where the goal lies beyond; or as near to the goal as the body gets, with the reason. A path that is walked is kept
until it is blocked or another is clearly cheaper.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skills.body_path.body_path import BodyPath, PathEnd
from skills.body_path.goal import Goal
from skills.body_path.ground_layers import GroundLayers
from skills.body_path.lattice_search import search_lattice
from skills.body_path.ompl_server import ask_ompl
from skills.body_path.ompl_solver import OmplProblem
from skills.body_path.path_cost import way_cost
from skills.body_path.path_parameters import LATTICE, BodyPathParameters
from skills.body_path.path_problem import PathProblem
from skills.body_path.smoothing import choose_points, smooth
from skills.body_path.way_headings import path_along
from skills.forking_server import ServerError
from skills.geometry.pose import Array
from skills.height_map import HeightMap


@dataclass(frozen=True, slots=True, eq=False)
class PathRequest:
    """All that a body path depends on.

    Attributes:
        height_map: the ground.
        start: (3,) x, y [m] and heading [rad] in the world.
        goal: where the robot is sent.
        parameters: of cost, body and planners.
        walked: the path to the same goal that the robot is on; None where there is none.
        path_id: of a new path.
    """

    height_map: HeightMap
    start: Array
    goal: Goal
    parameters: BodyPathParameters
    walked: BodyPath | None = None
    path_id: int = 0


@dataclass(frozen=True, slots=True, eq=False)
class PathPlan:
    """The answer to a request.

    Attributes:
        path: the way of the body; the very one that is walked where that is kept; None where planning itself failed.
        cost: of the way [m of good ground].
        kept: whether it is the one that is walked.
        expansions: nodes of the lattice that were expanded.
        failure: why planning failed.
    """

    path: BodyPath | None
    cost: float
    kept: bool
    expansions: int
    failure: str = ""


def plan_body_path(request: PathRequest) -> PathPlan:
    """Find a way, or keep the one that is walked; planning itself fails only where OMPL does."""
    parameters = request.parameters
    ground = GroundLayers.of(request.height_map, parameters)
    problem = PathProblem(ground, request.start, request.goal.xyyaw_world, parameters)
    rest = None if request.walked is None else _rest(request.walked, problem)
    try:
        way, end, expansions = find_way(problem if request.walked is None else problem.staying_near(request.walked))
    except ServerError as error:
        return PathPlan(None, np.inf, False, 0, f"planner {parameters.planner}: {error}")
    cost = problem.cost(way)
    if request.walked is not None and rest is not None and end is request.walked.end:
        rest_cost = problem.cost(rest)
        if _is_as_good(rest, rest_cost, way, cost, problem):
            return PathPlan(request.walked, rest_cost, True, expansions)
    path = path_along(way, float(request.start[2]), request.goal, end, parameters, request.path_id)
    return PathPlan(path, cost, False, expansions)


def _is_as_good(rest: Array, rest_cost: float, way: Array, cost: float, problem: PathProblem) -> bool:
    """Whether what is left of a path may stay: another ends no nearer to the goal, and is not clearly cheaper."""
    p, goal = problem.parameters, problem.goal[:2]
    nearer = np.hypot(*(rest[-1] - goal)) - np.hypot(*(way[-1] - goal))
    return bool(nearer <= p.same_way and cost > (1.0 - p.better_by) * rest_cost - p.same_way)


def find_way(problem: PathProblem) -> tuple[Array, PathEnd, int]:
    """The points of a smooth way (N, 2), where it ends, and how many nodes were expanded."""
    p, ground, scale = problem.parameters, problem.ground, problem.scale
    beyond = 0.0 if problem.goal_is_on_map else problem.beyond
    straight = np.array((problem.start[:2], problem.goal[:2]))
    if np.hypot(*(straight[1] - straight[0])) <= p.direct and problem.goal_is_free and problem.fits(straight):
        return straight, PathEnd.GOAL, 0
    points, _, reached, expansions = search_lattice(
        ground.layers, ground.cells, scale, straight[0].copy(), np.array(problem.goal), beyond, p.way_out
    )
    if len(points) < 2:
        points = np.array((problem.start[:2], problem.start[:2]))
    end = _end(problem, reached)
    if p.planner != LATTICE and not np.array_equal(points[0], points[-1]):
        points = _way_of_ompl(problem, points, end)
    chosen = choose_points(ground.layers, ground.cells, scale, points)
    way = smooth(
        ground.layers, ground.cells, scale, chosen, p.curvature_weight, p.smoothing_spacing, p.smoothing_sweeps
    )
    return way, end, expansions


def _way_of_ompl(problem: PathProblem, lattice_way: Array, end: PathEnd) -> Array:
    """Points of the way that OMPL finds to where the lattice's way ends; that one where it finds nothing cheaper."""
    p, ground = problem.parameters, problem.ground
    points = lattice_way.copy()
    bound = float(way_cost(ground.layers, problem.scale, points))
    step = points[-1] - points[-2]
    yaw = problem.goal[2] if end is PathEnd.GOAL else np.arctan2(step[1], step[0])
    found = ask_ompl(
        OmplProblem(
            layers=ground.layers,
            cells=ground.cells,
            scale=problem.scale,
            start=problem.start,
            goal=np.array((*points[-1], yaw)),
            planner=p.planner,
            seed=p.seed,
            checks=p.termination_checks,
            bound=bound if p.warm_start else np.inf,
        )
    )
    if found is None:
        return points
    if p.warm_start and way_cost(ground.layers, problem.scale, found) > bound:
        return points
    return found


def _end(problem: PathProblem, reached: bool) -> PathEnd:
    if reached:
        return PathEnd.GOAL if problem.goal_is_on_map else PathEnd.BORDER
    return PathEnd.GOAL_CUT_OFF if not problem.goal_is_on_map or problem.goal_is_free else PathEnd.GOAL_OCCUPIED


def _rest(path: BodyPath, problem: PathProblem) -> Array | None:
    """What is left of a path (N, 2); None where it is blocked or left, or would grow with the map."""
    if path.end is PathEnd.BORDER or (path.end is PathEnd.GOAL and not problem.goal_is_free):
        return None
    begun = path.project(problem.start)
    here = path.at(begun)[:2]
    if np.hypot(*(here - problem.start[:2])) > problem.parameters.same_way:
        return None
    ahead = path.waypoints_world[path.arc_lengths > begun, :2]
    rest = np.vstack((here, ahead)) if len(ahead) else np.array((here, path.waypoints_world[-1, :2]))
    return rest if problem.fits(rest) else None
