"""Planners of OMPL solve the same problem in a process of their own: repeatable, and a process that dies is told."""

from __future__ import annotations

import dataclasses
import sys

import numpy as np
from path_maps import box, height_map, level

from skills.body_path import BodyPathParameters, Goal, PathEnd, PathRequest, ompl_server, plan_body_path
from skills.body_path.path_parameters import OMPL_PLANNERS
from skills.forking_server import ForkingServer

WALL = height_map(box(level(5.0, 5.0), (1.4, 1.6), (-3.0, 0.6), 1.0))


def request(planner: str, **changes) -> PathRequest:
    parameters = BodyPathParameters(planner=planner, termination_checks=150, **changes)
    return PathRequest(WALL, np.zeros(3), Goal(3.0, 0.0, 0.0), parameters)


def test_every_planner_finds_a_free_way_around_a_wall_and_finds_it_again():
    lattice = plan_body_path(request("lattice"))
    assert lattice.path is not None
    found = 0
    for planner in OMPL_PLANNERS:
        alone = plan_body_path(request(planner, warm_start=False))
        assert alone.path is not None and alone.path.end is PathEnd.GOAL
        at_wall = np.array([alone.path.at(s) for s in np.arange(0.0, alone.path.length, 0.02)])
        assert (at_wall[np.abs(at_wall[:, 0] - 1.5) < 0.1, 1] > 0.6).all()
        again = plan_body_path(request(planner, warm_start=False))
        assert again.path is not None
        np.testing.assert_array_equal(alone.path.waypoints_world, again.path.waypoints_world)
        found += not np.array_equal(alone.path.waypoints_world, lattice.path.waypoints_world)
        assert plan_body_path(request(planner)).cost <= lattice.cost + 1e-9
    assert found >= len(OMPL_PLANNERS) - 3  # Where one finds nothing in so few checks the lattice's way stands.


def test_another_seed_gives_another_way():
    one, other = (plan_body_path(request("RRTstar", warm_start=False, seed=seed)) for seed in (1, 2))
    assert one.path is not None and other.path is not None
    assert not np.array_equal(one.path.waypoints_world, other.path.waypoints_world)


def test_a_process_that_dies_is_the_failure_of_the_plan(monkeypatch):
    dies = "import os, signal; from skills.forking_server import serve; serve(lambda _: os.kill(os.getpid(), 9))"
    server = ForkingServer((sys.executable, "-c", dies))
    monkeypatch.setattr(ompl_server, "SERVER", server)
    plan = plan_body_path(request("RRTstar"))
    server.close()
    assert plan.path is None
    assert plan.failure == "planner RRTstar: the process of this request was killed by signal 9"


def test_without_ompl_the_failure_says_what_to_install(monkeypatch):
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    plan = plan_body_path(request("BITstar"))
    assert plan.path is None and 'it needs the package "ompl"' in plan.failure
    assert plan_body_path(dataclasses.replace(request("lattice"))).path is not None


def test_nothing_is_asked_where_there_is_nowhere_to_go():
    wall = height_map(box(level(5.0, 5.0), (1.4, 1.6), (-3.0, 3.0), 1.0))
    stuck = dataclasses.replace(request("RRTstar"), height_map=wall, start=np.array((1.1, 0.0, 0.0)))
    plan = plan_body_path(stuck)
    assert plan.path is not None and plan.path.end is PathEnd.GOAL_CUT_OFF
    assert plan.path.length < 0.2
