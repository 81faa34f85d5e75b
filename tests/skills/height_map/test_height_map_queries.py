"""Asking a height map: nearest, bilinear, inside, points."""

from __future__ import annotations

import numpy as np
import pytest

from skills.height_map import HeightMap, ScanAccount

ORIGIN = np.array((-1.0, 2.0))


@pytest.fixture
def plane() -> HeightMap:
    """z = 0.5 + 0.2 x - 0.1 y on 6 rows of 10 cells, one of which is unknown."""
    x, y = np.meshgrid(ORIGIN[0] + 0.1 * (np.arange(10) + 0.5), ORIGIN[1] + 0.1 * (np.arange(6) + 0.5))
    heights = (0.5 + 0.2 * x - 0.1 * y).astype(np.float32)
    heights[3, 7] = np.nan
    filled = np.zeros(heights.shape, np.bool_)
    return HeightMap(heights, np.ones_like(heights), filled, 0.1, ORIGIN, 0.0, 0, 0.0, ScanAccount())


def test_bilinear_is_exact_on_a_plane_and_nearest_is_within_half_a_cell(plane):
    xy = ORIGIN + np.random.default_rng(0).uniform((0.05, 0.05), (0.6, 0.55), (200, 2))
    true = 0.5 + 0.2 * xy[:, 0] - 0.1 * xy[:, 1]
    np.testing.assert_allclose(plane.bilinear(xy), true, atol=1e-6)
    assert np.abs(plane.nearest(xy) - true).max() <= 0.05 * 0.3 + 1e-6


def test_shapes_follow_those_of_the_points(plane):
    grid = np.zeros((4, 3, 2)) + ORIGIN + 0.2
    assert plane.nearest(grid).shape == plane.bilinear(grid).shape == plane.inside(grid).shape == (4, 3)
    assert plane.nearest(ORIGIN + 0.2).shape == ()


def test_outside_and_unknown_cells_have_no_height(plane):
    outside = ORIGIN + np.array([(-0.01, 0.3), (0.3, -0.01), (1.01, 0.3), (0.3, 0.61), (np.nan, 0.3), (np.inf, 0.3)])
    assert not plane.inside(outside).any()
    assert np.isnan(plane.nearest(outside)).all() and np.isnan(plane.bilinear(outside)).all()
    assert np.isnan(plane.bilinear(ORIGIN + np.array((0.75, 0.35))))


def test_beside_an_unknown_cell_the_nearest_stands_in(plane):
    point = ORIGIN + np.array((0.68, 0.35))
    assert plane.bilinear(point) == plane.nearest(point) == plane.heights[3, 6]


def test_points_are_the_centres_of_the_known_cells(plane):
    points = plane.points_world
    assert points.shape == (59, 3)
    np.testing.assert_allclose(points[:, 2], plane.nearest(points[:, :2]))
