"""The body path in OMPL's terms, for any of its planners; runs in a process of its own (`ompl_server`).

States are poses in the plane. A state is valid where the body's box is free, and a motion where the body can walk it
straight; the objective is the cost of the way. All three ask the kernels of `path_cost`, as our own planner does.
"""

# OMPL's binary module has stubs for some of its names only.
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from skills.body_path.path_cost import body_fits, motion_cost, motion_fits
from skills.footsteps.records import Records
from skills.geometry.pose import Array

_RANGE = 1.0  # Longest motion that planners add to their trees at once [m].


@dataclass(frozen=True, slots=True, eq=False)
class OmplProblem:
    """All that a planner of OMPL is told.

    Attributes:
        layers, cells, scale: of the ground, as the kernels take them.
        start, goal: (3,) x, y [m] and heading [rad].
        planner: name of its class.
        seed: of its random numbers.
        checks: it ends when it has asked so often whether to end.
        bound: places are left out where not even the straight ways to start and goal are cheaper [m of good ground].
    """

    layers: Array
    cells: NDArray[np.float32]
    scale: Records
    start: Array
    goal: Array
    planner: str
    seed: int
    checks: int
    bound: float


def solve_with_ompl(problem: OmplProblem) -> Array | None:
    """Points of the best way that the planner finds (N, 2); None where it finds none.

    The seed has effect on the first call in a process alone: OMPL seeds its random numbers once.
    """
    from ompl import base as ob
    from ompl import geometric as og
    from ompl import util as ou

    for array in (problem.layers, problem.cells):
        array.flags.writeable = False  # As where the kernels were compiled for.
    ou.setLogLevel(ou.LogLevel.LOG_NONE)
    ou.RNG.setSeed(problem.seed)
    space = ob.SE2StateSpace()
    space.setBounds(_bounds(ob, problem))
    setup = og.SimpleSetup(space)
    information = setup.getSpaceInformation()
    # OMPL keeps no reference to what is written in Python.
    checker, validator, objective = _pose(ob, information, problem)
    setup.setStateValidityChecker(checker)
    information.setMotionValidator(validator)
    setup.setOptimizationObjective(objective)
    start, goal = (_state(space, pose) for pose in (problem.start, problem.goal))
    setup.setStartAndGoalStates(start, goal)
    planner = getattr(og, problem.planner)(information)
    if hasattr(planner, "setRange"):
        planner.setRange(_RANGE)
    setup.setPlanner(planner)
    asked = itertools.count(1)
    setup.solve(ob.PlannerTerminationCondition(lambda: next(asked) >= problem.checks))
    if not setup.haveExactSolutionPath():
        return None
    states = setup.getSolutionPath().getStates()
    return np.array([(state.getX(), state.getY()) for state in states])


def _bounds(ob: Any, problem: OmplProblem) -> Any:
    """Of the map."""
    scale, (_, rows, columns) = problem.scale, problem.layers.shape
    bounds = ob.RealVectorBounds(2)
    for axis, first, count in ((0, scale["x"], columns), (1, scale["y"], rows)):
        bounds.setLow(axis, float(first))
        bounds.setHigh(axis, float(first + (count - 1) * scale["spacing"]))
    return bounds


def _state(space: Any, pose: Array) -> Any:
    state = space.allocState()
    state.setXY(float(pose[0]), float(pose[1]))
    state.setYaw(float(pose[2]))
    return state


def _pose(ob: Any, information: Any, problem: OmplProblem) -> tuple[Any, Any, Any]:
    """Validity of states, validity of motions, and the objective.

    A subclass of `StateCostIntegralObjective` would be ignored without a word: it is a plain objective.
    """
    layers, cells, scale = problem.layers, problem.cells, problem.scale
    (start_x, start_y), (goal_x, goal_y) = problem.start[:2].tolist(), problem.goal[:2].tolist()
    bound, hypot = problem.bound, math.hypot

    class Checker(ob.StateValidityChecker):
        def isValid(self, state: Any) -> bool:
            x, y, yaw = state.getX(), state.getY(), state.getYaw()
            if hypot(x - start_x, y - start_y) + hypot(goal_x - x, goal_y - y) > bound:
                return False
            return body_fits(layers, cells, scale, x, y, math.cos(yaw), math.sin(yaw))

    class Validator(ob.MotionValidator):
        def checkMotion(self, before: Any, after: Any) -> bool:
            return checker.isValid(after) and motion_fits(
                layers, cells, scale, before.getX(), before.getY(), after.getX(), after.getY()
            )

    class Objective(ob.OptimizationObjective):
        def stateCost(self, state: Any) -> Any:
            return ob.Cost(0.0)

        def motionCost(self, before: Any, after: Any) -> Any:
            return ob.Cost(motion_cost(layers, scale, before.getX(), before.getY(), after.getX(), after.getY()))

        def motionCostHeuristic(self, before: Any, after: Any) -> Any:
            return ob.Cost(hypot(after.getX() - before.getX(), after.getY() - before.getY()))

    checker = Checker(information)
    return checker, Validator(information), Objective(information)
