"""How cheap a path a planner of OMPL finds on a map when it may search for some time, beside ours."""

from __future__ import annotations

import dataclasses
import time
from dataclasses import dataclass

import numpy as np

from skills.body_path import BodyPathParameters, PathEnd, PathPlan, PathRequest, plan_body_path

_FIRST_CHECKS = 100
# These end with their first path, however long they may search.
_SINGLE = ("RRT", "RRTConnect", "KPIECE1", "BKPIECE1", "LBKPIECE1")


@dataclass(frozen=True, slots=True)
class Trial:
    """One planner on one map.

    Attributes:
        planner: its name.
        cost: of its best path after smoothing; infinite where it found none [m of good ground].
        seconds: wall time that it searched.
        checks: of the longest search.
    """

    planner: str
    cost: float
    seconds: float
    checks: int


def longest_search(planner: str, request: PathRequest, seconds: float, lattice: PathPlan) -> Trial:
    """Search again and again with twice the checks until the time is spent, and keep the best."""
    checks, best, spent = _FIRST_CHECKS, np.inf, 0.0
    while spent < seconds:
        started = time.perf_counter()
        plan = plan_body_path(dataclasses.replace(request, parameters=_alone(request.parameters, planner, checks)))
        spent += time.perf_counter() - started
        if not _same(plan, lattice):
            best = min(best, plan.cost)
            if planner in _SINGLE:
                return Trial(planner, best, spent, checks)
        checks *= 2
    return Trial(planner, best, spent, checks // 2)


def _alone(parameters: BodyPathParameters, planner: str, checks: int) -> BodyPathParameters:
    return dataclasses.replace(parameters, planner=planner, termination_checks=checks, warm_start=False)


def _same(plan: PathPlan, other: PathPlan) -> bool:
    """Whether two plans have the same path; where OMPL finds none, that of the lattice stands."""
    if plan.path is None or other.path is None:
        return plan.path is None and other.path is None
    return plan.path.end is PathEnd.GOAL and np.array_equal(plan.path.waypoints_world, other.path.waypoints_world)
