"""Our own planner finds what a search of all ways finds, and no way leads through a wall."""

from __future__ import annotations

import heapq

import numpy as np
import pytest
from path_maps import RESOLUTION, box, height_map, level, random_ground

from skills.body_path.ground_layers import GroundLayers
from skills.body_path.lattice_search import JOINED, NEIGHBOURS, search_lattice
from skills.body_path.path_cost import motion_cost, motion_fits, way_cost
from skills.body_path.path_parameters import BodyPathParameters
from skills.body_path.path_problem import PathProblem

PARAMETERS = BodyPathParameters()


def problem(heights, start=(0.0, 0.0, 0.0), goal=(4.0, 0.0, 0.0), parameters=PARAMETERS) -> PathProblem:
    ground = GroundLayers.of(height_map(heights), parameters)
    return PathProblem(ground, np.array(start), np.array(goal), parameters)


def search(asked: PathProblem):
    ground = asked.ground
    beyond = 0.0 if asked.goal_is_on_map else asked.beyond
    start, goal = asked.start[:2].copy(), np.array(asked.goal)
    return search_lattice(ground.layers, ground.cells, asked.scale, start, goal, beyond, PARAMETERS.way_out)


def cheapest_of_all(asked: PathProblem) -> float:
    """Dijkstra over the same lattice, which knows of it where nodes are and what a motion costs, and no more."""
    ground, scale = asked.ground, asked.scale
    _, rows, columns = ground.layers.shape
    start, goal = tuple(asked.start[:2].tolist()), tuple(asked.goal[:2].tolist())

    def place(node: tuple[int, int]) -> tuple[float, float]:
        return ground.x + node[0] * ground.spacing, ground.y + node[1] * ground.spacing

    def edge(here: tuple[float, float], there: tuple[float, float]) -> float:
        if not motion_fits(ground.layers, ground.cells, scale, *here, *there):
            return np.inf
        return motion_cost(ground.layers, scale, *here, *there)

    def near(here: tuple[float, float], there: tuple[float, float]) -> bool:
        return bool(np.hypot(here[0] - there[0], here[1] - there[1]) <= JOINED * ground.spacing)

    costs: dict[tuple[int, int], float] = {}
    queue = [
        (cost, node)
        for node in ((i, j) for i in range(columns) for j in range(rows))
        if near(start, place(node)) and (cost := edge(start, place(node))) < np.inf
    ]
    heapq.heapify(queue)
    best = np.inf
    while queue and queue[0][0] < best:
        cost, node = heapq.heappop(queue)
        if node in costs:
            continue
        costs[node] = cost
        if near(place(node), goal):
            best = min(best, cost + edge(place(node), goal))
        for dx, dy in NEIGHBOURS.tolist():
            there = (node[0] + dx, node[1] + dy)
            if 0 <= there[0] < columns and 0 <= there[1] < rows and there not in costs:
                heapq.heappush(queue, (cost + edge(place(node), place(there)), there))
    return best


@pytest.mark.parametrize("seed", range(4))
def test_no_way_over_the_lattice_is_cheaper(seed):
    asked = problem(random_ground(seed, 5.0), start=(0.013, 0.021, 0.0), goal=(2.98, 0.04, 0.0))
    points, cost, reached, _ = search(asked)
    assert reached
    assert cost == pytest.approx(cheapest_of_all(asked), rel=1e-9)
    assert cost == pytest.approx(way_cost(asked.ground.layers, asked.scale, points), rel=1e-9)
    assert asked.fits(points)


def test_level_ground_costs_its_length_along_a_heading_of_the_lattice():
    points, cost, reached, _ = search(problem(level(), start=(0.05, 0.05, 0.0), goal=(4.05, 2.05, 0.0)))
    assert reached
    assert cost == pytest.approx(np.hypot(4.0, 2.0), rel=1e-6)
    np.testing.assert_allclose(points[[0, -1]], ((0.05, 0.05), (4.05, 2.05)))


def test_a_wall_with_a_gap_is_walked_through_and_one_without_is_not():
    wall = box(level(), (1.9, 2.1), (-3.0, 3.0), 1.0)
    gap = box(wall, (1.9, 2.1), (1.0, 2.2), 0.0)
    points, _, reached, _ = search(problem(gap))
    assert reached
    crossing = points[(points[:, 0] > 1.8) & (points[:, 0] < 2.2), 1]
    assert (np.abs(crossing - 1.6) < 0.6 - 0.5 * PARAMETERS.body_width + RESOLUTION).all()
    points, _, reached, _ = search(problem(wall))
    assert not reached
    assert points[:, 0].max() < 1.9 - 0.5 * PARAMETERS.body_depth + RESOLUTION


def test_good_footholds_are_worth_a_detour():
    holes = box(level(), (1.0, 3.0), (-0.5, 0.5), -0.5)
    points, _, reached, _ = search(problem(holes))
    assert reached
    assert np.abs(points[:, 1]).max() > 0.5


def test_a_goal_beyond_the_map_leads_to_the_border_on_the_best_way_to_it():
    wall = box(level(), (2.9, 3.1), (-3.0, 1.0), 1.0)
    points, _, reached, _ = search(problem(wall, goal=(9.0, 0.0, 0.0)))
    assert reached
    assert points[-1, 0] == pytest.approx(5.0, abs=PARAMETERS.spacing)
    assert points[:, 1].max() > 1.0


def test_a_start_in_an_obstacle_is_left():
    post = box(level(), (0.1, 0.4), (-0.1, 0.1), 1.0)
    points, _, reached, _ = search(problem(post))
    assert reached
    np.testing.assert_allclose(points[0], (0.0, 0.0))


def test_a_start_too_near_to_a_block_is_left_but_not_onto_the_block():
    block = box(level(), (0.3, 1.5), (-1.0, 1.0), 1.0)
    points, _, reached, _ = search(problem(block, start=(0.0, 0.05, 0.0)))
    assert reached
    assert (points[1:, 0] < 0.0).any()
    assert not ((points[:, 0] > 0.3) & (points[:, 0] < 1.5) & (np.abs(points[:, 1]) < 1.0)).any()
