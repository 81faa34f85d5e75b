"""The gradient is that of the cost, and smoothing only makes a way better."""

from __future__ import annotations

import numpy as np
import pytest
from path_maps import random_ground
from test_lattice_search import problem, search

from skills.body_path.path_cost import way_cost
from skills.body_path.path_parameters import BodyPathParameters
from skills.body_path.path_problem import PathProblem
from skills.body_path.smoothing import choose_points, cost_around, resample, smooth

PARAMETERS = BodyPathParameters()


def curvature(way) -> float:
    """Integral of the squared curvature, from the turns between the pieces of a way."""
    steps = np.diff(way, axis=0)
    lengths = np.hypot(*steps.T)
    units = steps / lengths[:, None]
    return float(((np.diff(units, axis=0) ** 2).sum(axis=1) / (0.5 * (lengths[1:] + lengths[:-1]))).sum())


def whole_cost(asked: PathProblem, way, weight: float) -> float:
    return way_cost(asked.ground.layers, asked.scale, way) + weight * curvature(way)


@pytest.mark.parametrize("seed", range(3))
def test_the_gradient_is_that_of_the_whole_cost(seed):
    asked = problem(random_ground(seed))
    rng = np.random.default_rng(seed)
    # Not on the lattice, where the layers have kinks, nor at lengths where one piece becomes two.
    way = np.column_stack((np.linspace(-0.4, 4.3, 14), np.zeros(14))) + rng.uniform(-0.13, 0.13, (14, 2))
    weight, h = 0.05, 1e-6
    checked = 0
    for k in range(1, len(way) - 1):
        _, *gradient = cost_around(asked.ground.layers, asked.scale, way, k, weight)
        for axis in range(2):
            there = []
            for sign in (1, -1):
                moved = way.copy()
                moved[k, axis] += sign * h
                there.append(whole_cost(asked, moved, weight))
            assert gradient[axis] == pytest.approx((there[0] - there[1]) / (2 * h), rel=1e-4, abs=1e-4)
            checked += abs(gradient[axis]) > 0.1
    assert checked > 10


@pytest.mark.parametrize("seed", range(4))
def test_smoothing_makes_a_way_cheaper_and_straighter_and_keeps_it_free(seed):
    asked = problem(random_ground(seed))
    points, cost, reached, _ = search(asked)
    assert reached
    ground, p = asked.ground, PARAMETERS
    chosen = choose_points(ground.layers, ground.cells, asked.scale, points)
    assert way_cost(ground.layers, asked.scale, chosen) <= cost + 1e-9
    spaced = resample(ground.layers, ground.cells, asked.scale, chosen, p.smoothing_spacing)
    way = smooth(ground.layers, ground.cells, asked.scale, chosen, p.curvature_weight, p.smoothing_spacing, 12)
    np.testing.assert_array_equal(way[[0, -1]], points[[0, -1]])
    assert asked.fits(way)
    assert whole_cost(asked, way, p.curvature_weight) <= whole_cost(asked, spaced, p.curvature_weight) + 1e-9
    assert way_cost(ground.layers, asked.scale, way) <= 1.01 * cost


def test_a_straight_way_over_level_ground_stays_straight():
    asked = problem(np.zeros((120, 120)))
    ground = asked.ground
    straight = np.array(((0.0, 0.0), (4.0, 1.0)))
    way = smooth(ground.layers, ground.cells, asked.scale, straight, 0.05, 0.2, 12)
    np.testing.assert_allclose(way[:, 1], 0.25 * way[:, 0], atol=1e-9)
