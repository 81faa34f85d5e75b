import numpy as np
import pytest
from polygons import L_SHAPE, SQUARE, are_simple, area, circle, distance, random_blob

from skills.geometry.simplification import simplify


def dense(polygon: np.ndarray, spacing: float) -> np.ndarray:
    edges = zip(polygon, np.roll(polygon, -1, axis=0), strict=True)
    return np.concatenate(
        [np.linspace(a, b, max(2, int(np.linalg.norm(b - a) / spacing)), endpoint=False) for a, b in edges]
    )


def test_corners_stay_and_the_rest_goes():
    (short,) = simplify(dense(L_SHAPE, 0.05), 0.01)
    assert len(short) == 6
    assert np.max(distance([L_SHAPE], short)) < 1e-9
    assert area(short) == pytest.approx(area(L_SHAPE))


@pytest.mark.parametrize("seed", range(4))
def test_edges_in_noise_come_out_straight_and_in_their_place(seed):
    rng = np.random.default_rng(seed)
    outline = dense(SQUARE, 0.004)
    (short,) = simplify(outline + rng.uniform(-0.004, 0.004, outline.shape), 0.01)
    assert len(short) == 4
    assert np.max([np.min(np.linalg.norm(short - corner, axis=1)) for corner in SQUARE]) < 0.003
    assert area(short) == pytest.approx(1.0, abs=0.003)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("tolerance", [0.01, 0.05, 0.2])
def test_the_result_is_simple_near_and_smaller(seed, tolerance):
    outline = dense(random_blob(np.random.default_rng(seed)), 0.02)
    rings = simplify(outline, tolerance)
    for ring in rings:
        assert len(ring) <= len(outline) and area(ring) > 0.0
        assert np.max(distance([outline], ring)) <= 2.0 * tolerance + 1e-9
    assert are_simple(list(rings))


def test_a_hole_never_crosses_the_outline():
    """Walls around the holes are thinner than the tolerance."""
    outline = dense(SQUARE, 0.02)
    holes = tuple(circle(x, 0.5, 0.23, 60)[::-1].copy() for x in (0.24, 0.74))
    rings = simplify(outline, 0.05, holes)
    assert len(rings) == 3 and are_simple(list(rings))
    assert all(area(hole) < 0.0 for hole in rings[1:])


def test_what_is_thinner_than_the_tolerance_is_nothing():
    assert simplify(dense(SQUARE * (1.0, 0.004), 0.02), 0.01) == ()
    short = simplify(dense(SQUARE, 0.02), 0.01, (circle(0.5, 0.5, 0.004)[::-1].copy(),))
    assert len(short) == 1
