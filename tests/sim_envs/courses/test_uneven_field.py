"""The figure-eight on which a carrot leads: as long as it says, round, and all of it over blocks."""

from __future__ import annotations

import numpy as np
import pytest

from sim_envs.courses import CarrotWay, CourseError, Ground, load_course


def way_of(**options: float) -> CarrotWay:
    way = load_course("uneven_field", seed=2, **options).carrot
    assert way is not None
    return way


@pytest.mark.parametrize("length", [20.0, 12.0])
def test_the_eight_is_as_long_as_asked_and_ends_in_its_middle(length):
    way = way_of(eight_length=length)
    lead_in = float(np.linalg.norm(way.points_world[1] - way.points_world[0]))
    assert way.length - lead_in == pytest.approx(length, rel=2e-3)
    np.testing.assert_allclose(way.points_world[-1], way.points_world[1], atol=1e-9)
    assert load_course("uneven_field", eight_length=length).goal[:2] == pytest.approx(tuple(way.points_world[-1]))


def test_the_carrot_moves_steadily_and_faces_where_it_goes():
    way = way_of(carrot_speed=0.4)
    times = np.arange(0.0, way.length / 0.4, 0.1)
    poses = np.array([way.at(time) for time in times])
    steps = np.diff(poses[:, :2], axis=0)
    np.testing.assert_allclose(np.linalg.norm(steps, axis=1), 0.04, rtol=0.02)
    directions = np.arctan2(steps[:, 1], steps[:, 0])
    assert np.abs(np.angle(np.exp(1j * (directions - poses[:-1, 2])))).max() < 0.09
    assert way.at(1e6)[:2] == pytest.approx(tuple(way.points_world[-1]))


def test_all_around_the_way_there_is_ground():
    course = load_course("uneven_field", seed=2)
    assert course.carrot is not None
    ground, sides = Ground(course.boxes), np.linspace(0.0, 2 * np.pi, 8, endpoint=False)
    points = np.array([course.carrot.at(time)[:2] for time in np.arange(0.0, course.carrot.length / 0.3, 2.0)])
    around = points[:, None] + 0.5 * np.column_stack((np.cos(sides), np.sin(sides)))
    assert np.isfinite(ground.ground_height(around.reshape(-1, 2))).all()


def test_the_distance_is_that_of_the_nearest_point():
    way = way_of()
    middle, radius = way.points_world[1], 20.0 / (4 * np.pi)
    for angle in np.linspace(0.0, 6.0, 20):
        out = np.array((np.sin(angle), -np.cos(angle)))
        point = middle + (0.0, radius) + (radius + 0.3) * out
        if point[1] > 0.4:
            assert way.distance(np.array((*point, 1.0))) == pytest.approx(0.3, abs=2e-3)


def test_an_eight_that_does_not_fit_is_refused():
    with pytest.raises(CourseError, match=r"eight_length: got 40, which needs blocks 13.9 m across"):
        load_course("uneven_field", eight_length=40.0)
