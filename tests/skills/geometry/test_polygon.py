import numpy as np
import pytest

from skills.geometry.convex_decomposition import convex_parts
from skills.geometry.polygon import (
    clip_convex,
    clip_half_plane,
    contains_points,
    convex_hull,
    signed_area,
)
from skills.geometry.simplification import simplify

SQUARE = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]])
L_SHAPE = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]])
U_SHAPE = np.array([[0, 0], [3, 0], [3, 2], [2, 2], [2, 1], [1, 1], [1, 2], [0, 2]], dtype=np.float64)


def star(points: int, inner: float, phase: float = 0.1) -> np.ndarray:
    angle = np.arange(2 * points) * np.pi / points + phase
    radius = np.where(np.arange(2 * points) % 2 == 1, inner, 1.0)
    return np.column_stack((radius * np.cos(angle), radius * np.sin(angle)))


def random_blob(rng: np.random.Generator) -> np.ndarray:
    angle = np.sort(rng.uniform(0.0, 2.0 * np.pi, rng.integers(12, 40)))
    return (rng.uniform(0.3, 1.0, len(angle)) * np.array([np.cos(angle), np.sin(angle)])).T.copy()


def holds(polygons: tuple[np.ndarray, ...], points: np.ndarray) -> np.ndarray:
    return np.any([contains_points(polygon, points) for polygon in polygons], axis=0)


def is_convex(polygon: np.ndarray) -> bool:
    edges = np.roll(polygon, -1, axis=0) - polygon
    following = np.roll(edges, -1, axis=0)
    return bool(np.all(edges[:, 0] * following[:, 1] - edges[:, 1] * following[:, 0] > -1e-12))


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


def test_simplify_keeps_corners_and_drops_the_rest():
    dense = np.concatenate([np.linspace(SQUARE[i], SQUARE[(i + 1) % 4], 10, endpoint=False) for i in range(4)])
    (short,) = simplify(dense, 0.01)
    assert len(short) == 4
    assert signed_area(short) == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize(
    "polygon",
    [
        L_SHAPE,
        U_SHAPE,
        star(5, 0.4),
        star(20, 0.5),
        star(20, 0.9),
        *map(random_blob, map(np.random.default_rng, range(8))),
    ],
)
def test_exact_parts_tile_the_polygon(polygon):
    parts = convex_parts(polygon, 1e-9)
    points = np.random.default_rng(0).uniform(-1.0, 3.0, (20_000, 2))
    assert all(is_convex(part) for part in parts)
    assert sum(signed_area(part) for part in parts) == pytest.approx(signed_area(polygon), rel=1e-6)
    np.testing.assert_array_equal(holds(parts, points), contains_points(polygon, points))


@pytest.mark.parametrize("seed", range(8))
def test_approximate_parts_cover_the_polygon_and_stay_within_the_tolerance(seed):
    polygon, tolerance = random_blob(np.random.default_rng(seed)), 0.05
    exact, rough = convex_parts(polygon, 1e-9), convex_parts(polygon, tolerance)
    points = np.random.default_rng(0).uniform(-1.1, 1.1, (20_000, 2))
    inside = contains_points(polygon, points)
    assert len(rough) <= len(exact)
    assert not np.any(inside & ~holds(rough, points))
    following = np.roll(polygon, -1, axis=0)
    for point in points[holds(rough, points) & ~inside]:
        edge = following - polygon
        t = np.clip(np.sum((point - polygon) * edge, axis=1) / np.sum(edge * edge, axis=1), 0.0, 1.0)
        assert np.min(np.linalg.norm(polygon + t[:, None] * edge - point, axis=1)) <= tolerance + 1e-9


def test_parts_leave_holes_open():
    hole = np.array([[0.2, 0.2], [0.2, 0.4], [0.4, 0.4], [0.4, 0.2]])
    for offsets in ((0.0,), (0.0, 0.3), (0.0, (0.4, 0.0), (0.1, 0.3))):
        holes = tuple(hole + np.array(offset) for offset in offsets)
        parts = convex_parts(SQUARE, 1e-9, holes)
        points = np.random.default_rng(0).uniform(0.0, 1.0, (5_000, 2))
        np.testing.assert_array_equal(holds(parts, points), ~holds(holes, points))
