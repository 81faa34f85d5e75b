from itertools import combinations

import numpy as np
import pytest

from skills.geometry.polygon import convex_hull
from skills.geometry.pose import Array
from skills.walking.contact import Contact, contact_points

CORNERS = np.array([[0.13, 0.069], [-0.13, 0.069], [-0.13, -0.069], [0.13, -0.069]])
FRICTION = 0.6


def area(polygon: Array) -> float:
    x, y = polygon.T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def test_rays_span_the_pyramid_with_the_full_friction_along_x_and_y() -> None:
    contact = Contact.at(CORNERS, FRICTION)
    for point in range(4):
        rays = contact.rays_wrench[:3, 4 * point : 4 * point + 4]
        np.testing.assert_allclose(rays[2], 1.0)
        np.testing.assert_allclose(np.linalg.norm(rays[:2], axis=0), FRICTION)
        for direction in np.vstack((np.eye(2), -np.eye(2))):
            assert (direction @ rays[:2]).max() == pytest.approx(FRICTION)
        # Any force with |fx| + |fy| <= friction * fz is a sum of rays, none of them pulling.
        force = np.array((0.4 * FRICTION, -0.6 * FRICTION, 1.0))
        weights = np.array((0.4, 0.0, 0.0, 0.6))
        np.testing.assert_allclose(rays @ weights, force, atol=1e-12)


def test_the_wrench_is_that_of_the_forces_at_their_points() -> None:
    contact, rng = Contact.at(CORNERS, FRICTION), np.random.default_rng(4)
    weights = rng.uniform(0.0, 10.0, 16)
    force, torque = np.zeros(3), np.zeros(3)
    for point, around in zip(CORNERS, weights.reshape(4, 4), strict=True):
        pushed = np.array((FRICTION * (around[0] - around[2]), FRICTION * (around[1] - around[3]), around.sum()))
        force += pushed
        torque += np.cross(np.append(point, 0.0), pushed)
    np.testing.assert_allclose(contact.rays_wrench @ weights, np.concatenate((force, torque)), atol=1e-12)


def test_the_cop_is_the_mean_of_the_points_by_their_load() -> None:
    contact, rng = Contact.at(CORNERS, FRICTION), np.random.default_rng(5)
    weights = rng.uniform(0.0, 10.0, 16)
    loads = weights.reshape(4, 4).sum(axis=1)
    cop = contact.cop_sole(weights)
    assert cop is not None
    np.testing.assert_allclose(cop, loads @ CORNERS / loads.sum(), atol=1e-12)
    assert contact.cop_sole(np.zeros(16)) is None


def test_all_points_are_loaded_unless_told_otherwise() -> None:
    assert Contact.at(CORNERS, FRICTION).loaded.all()
    loaded = np.array((True, False, False, True))
    np.testing.assert_array_equal(Contact.at(CORNERS, FRICTION, loaded).loaded, loaded)


@pytest.mark.parametrize("seed", range(8))
def test_contact_points_span_the_largest_quadrangle_of_a_foothold(seed: int) -> None:
    rng = np.random.default_rng(seed)
    hull = convex_hull(rng.uniform((-0.13, -0.069), (0.13, 0.069), (12, 2)))
    assert len(hull) > 4
    points = contact_points(hull)
    assert all(any(np.array_equal(point, corner) for corner in hull) for point in points)
    largest = max(area(hull[list(chosen)]) for chosen in combinations(range(len(hull)), 4))
    assert area(points) == pytest.approx(largest)


def test_a_foothold_of_four_keeps_its_corners_and_one_of_three_has_one_twice() -> None:
    np.testing.assert_array_equal(contact_points(CORNERS), CORNERS)
    points = contact_points(CORNERS[:3])
    assert points.shape == (4, 2)
    np.testing.assert_array_equal(points[:3], CORNERS[:3])
    np.testing.assert_array_equal(points[3], CORNERS[2])
