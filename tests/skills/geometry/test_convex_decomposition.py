import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from polygons import L_SHAPE, SQUARE, U_SHAPE, area, circle, distance, inside, is_convex, random_blob, star

from skills.geometry.convex_decomposition import convex_parts

RING = (circle(0.0, 0.0, 1.0), circle(0.0, 0.0, 0.6)[::-1].copy())
SIEVE = (3.0 * SQUARE, *(circle(x, y, 0.3, 12)[::-1].copy() for x in (0.6, 1.5, 2.4) for y in (0.7, 1.6, 2.3)))
SLIVER = np.array([[0.0, 0.0], [2.0, 0.0], [2.0, 0.002], [1.0, 0.0021], [0.0, 0.002]])
SHAPES = {
    "square": (SQUARE,),
    "L": (L_SHAPE,),
    "U": (U_SHAPE,),
    "star 5": (star(5, 0.4),),
    "star 20": (star(20, 0.5),),
    "star 20 blunt": (star(20, 0.9),),
    "small star 20": (0.1 * star(20, 0.9),),
    "ring": RING,
    "sieve": SIEVE,
    "sliver": (SLIVER,),
    **{f"blob {seed}": (random_blob(np.random.default_rng(seed)),) for seed in range(6)},
}


def notches(rings) -> int:
    count = 0
    for ring in rings:
        before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
        count += int(np.sum(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0] < 0.0))
    return count


def samples(rings, count=20_000) -> np.ndarray:
    low, high = rings[0].min(axis=0), rings[0].max(axis=0)
    return np.random.default_rng(0).uniform(low - 0.02, high + 0.02, (count, 2))


def covered(parts, points) -> np.ndarray:
    """How many parts hold each point."""
    return np.sum([inside(part, points) for part in parts], axis=0)


def in_region(rings, points) -> np.ndarray:
    return inside(rings[0], points) & ~np.any([inside(hole, points) for hole in rings[1:]] or [False], axis=0)


@pytest.mark.parametrize("name", SHAPES)
def test_exact_parts_tile_the_polygon(name):
    rings = SHAPES[name]
    parts = convex_parts(rings[0], 1e-9, rings[1:])
    points = samples(rings)
    assert all(is_convex(part) and area(part) > 0.0 for part in parts)
    assert sum(map(area, parts)) == pytest.approx(sum(map(area, rings)), rel=1e-6)
    np.testing.assert_array_equal(covered(parts, points), in_region(rings, points))


@pytest.mark.parametrize("name", SHAPES)
def test_approximate_parts_cover_a_hundredth_more_at_most(name):
    rings, tolerance = SHAPES[name], 0.02
    parts = convex_parts(rings[0], tolerance, rings[1:])
    points = samples(rings, 50_000)
    region, count = in_region(rings, points), covered(parts, points)
    assert all(is_convex(part) for part in parts)
    assert not np.any(region & (count == 0))
    assert sum(map(area, parts)) <= 1.0101 * sum(map(area, rings)) + 1e-12
    outside = points[(count > 0) & ~region]
    assert np.all(distance(list(rings), outside) <= tolerance + 1e-9)


@pytest.mark.parametrize("name", SHAPES)
@pytest.mark.parametrize("tolerance", [1e-9, 0.02])
def test_parts_are_few(name, tolerance):
    """A cut ends one notch or two and hardly ever leaves one; no decomposition has fewer parts than half of them."""
    rings = SHAPES[name]
    assert len(convex_parts(rings[0], tolerance, rings[1:])) <= 1 + 4 * notches(rings) // 3


def test_known_shapes_have_the_fewest_parts():
    assert len(convex_parts(SQUARE, 0.01)) == 1
    assert len(convex_parts(L_SHAPE, 0.01)) == 2
    assert len(convex_parts(U_SHAPE, 0.01)) == 3


@settings(max_examples=60)
@given(st.lists(st.tuples(st.floats(0.2, 1.0), st.floats(0.05, 1.0)), min_size=3, max_size=24), st.floats(1e-9, 0.1))
def test_random_polygons_are_covered(spokes, tolerance):
    radius, gaps = np.array(spokes).T
    angle = np.cumsum(gaps) * 2.0 * np.pi / (gaps.sum() + 0.01)
    polygon = np.column_stack((radius * np.cos(angle), radius * np.sin(angle)))
    if area(polygon) < 0.05 or np.any(np.diff(angle) >= np.pi):
        return
    parts = convex_parts(polygon, tolerance)
    points = np.random.default_rng(0).uniform(-1.0, 1.0, (2_000, 2))
    points = points[distance([polygon], points) > 1e-6]
    assert all(is_convex(part) for part in parts)
    assert np.all(covered(parts, points) >= inside(polygon, points))
    assert sum(map(area, parts)) <= 1.02 * area(polygon)


def test_parts_leave_holes_open():
    hole = np.array([[0.2, 0.2], [0.2, 0.4], [0.4, 0.4], [0.4, 0.2]])
    for offsets in ((0.0,), (0.0, 0.3), (0.0, (0.4, 0.0), (0.1, 0.3))):
        rings = (SQUARE, *(hole + np.array(offset) for offset in offsets))
        parts = convex_parts(SQUARE, 1e-9, rings[1:])
        points = samples(rings, 5_000)
        np.testing.assert_array_equal(covered(parts, points) > 0, in_region(rings, points))
