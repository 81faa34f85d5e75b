import numpy as np
import pytest

from skills.geometry.pose import Pose
from skills.walking.support_polygon import SupportPolygon, foothold_corners

SQUARE = np.array([[0.1, 0.1], [-0.1, 0.1], [-0.1, -0.1], [0.1, -0.1]])


@pytest.mark.parametrize("seed", range(5))
def test_nearest_and_distance_match_a_dense_search(seed: int) -> None:
    rng = np.random.default_rng(seed)
    polygon = SupportPolygon([rng.uniform(-0.3, 0.3, (6, 2)), rng.uniform(0.0, 0.6, (3, 2))])
    hull = polygon.hull_world
    shares = np.linspace(0.0, 1.0, 2000)[:, None]
    outline = np.concatenate([a + shares * (b - a) for a, b in zip(hull, np.roll(hull, -1, axis=0), strict=True)])
    for point in rng.uniform(-1.0, 1.0, (40, 2)):
        to_outline = np.linalg.norm(outline - point, axis=1).min()
        nearest = polygon.nearest(point)
        if polygon.distance(point) <= 0.0:
            np.testing.assert_array_equal(nearest, point)
        else:
            assert polygon.distance(point) == pytest.approx(to_outline, abs=1e-3)
            assert np.linalg.norm(nearest - point) == pytest.approx(to_outline, abs=1e-3)


def test_tilted_and_shrunk_footholds_are_seen_from_above() -> None:
    sole = Pose.from_xyz_rpy((1.0, 2.0, 0.3), (0.0, 0.6, 0.0))
    corners = foothold_corners(sole, SQUARE, 0.0)
    np.testing.assert_allclose(np.ptp(corners, axis=0), (0.2 * np.cos(0.6), 0.2))
    np.testing.assert_allclose(corners.mean(axis=0), (1.0, 2.0))
    inner = foothold_corners(Pose.identity(), SQUARE, 0.01)
    np.testing.assert_allclose(np.linalg.norm(inner, axis=1), np.hypot(0.1, 0.1) - 0.01)
