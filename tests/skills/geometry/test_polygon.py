import numpy as np
import pytest
from polygons import L_SHAPE, SQUARE, is_convex

from skills.geometry.polygon import (
    clip_convex,
    clip_half_plane,
    contains_points,
    convex_hull,
    signed_area,
)


def test_area_is_signed_by_direction():
    assert signed_area(L_SHAPE) == pytest.approx(3.0)
    assert signed_area(L_SHAPE[::-1].copy()) == pytest.approx(-3.0)


@pytest.mark.parametrize("seed", range(5))
def test_clip_area_agrees_with_sampling(seed):
    rng = np.random.default_rng(seed)
    a, b = (convex_hull(rng.normal(size=(8, 2)) + rng.uniform(-0.5, 0.5, 2)) for _ in range(2))
    clipped = clip_convex(a, b)
    points = rng.uniform(-4.0, 4.0, (200_000, 2))
    both = contains_points(a, points) & contains_points(b, points)
    assert signed_area(clipped) == pytest.approx(64.0 * both.mean(), abs=0.06)
    assert is_convex(clipped)
    assert signed_area(clip_convex(b, a)) == pytest.approx(signed_area(clipped), abs=1e-12)


def test_clip_of_separate_polygons_is_empty():
    assert clip_convex(SQUARE, SQUARE + 2.0).shape == (0, 2)
    assert clip_half_plane(SQUARE, 1.0, 0.0, -0.1).shape == (0, 2)


def test_clip_with_the_same_polygon_changes_nothing():
    np.testing.assert_allclose(signed_area(clip_convex(SQUARE, SQUARE)), 1.0)


@pytest.mark.parametrize("seed", range(5))
def test_hull_is_convex_and_holds_every_point(seed):
    points = np.random.default_rng(seed).integers(0, 6, (30, 2)).astype(np.float64)
    hull = convex_hull(points)
    edges = np.roll(hull, -1, axis=0) - hull
    offsets = points[:, None, :] - hull[None, :, :]
    assert np.all(edges[:, 0] * offsets[:, :, 1] - edges[:, 1] * offsets[:, :, 0] >= 0.0)
    assert is_convex(hull) and signed_area(hull) > 0.0
