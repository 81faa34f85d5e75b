"""Whole requests: where paths lead and where they end, and which path is kept while it is walked."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from path_maps import RESOLUTION, box, height_map, level, random_ground

from skills.body_path import BodyPath, BodyPathParameters, Goal, PathEnd, PathPlan, PathRequest, plan_body_path

PARAMETERS = BodyPathParameters()


def plan(heights, start=(0.0, 0.0, 0.0), goal=(4.0, 0.0, 0.0), walked: BodyPath | None = None) -> PathPlan:
    return plan_body_path(PathRequest(height_map(heights), np.array(start), Goal(*goal), PARAMETERS, walked))


def path(*arguments, **options) -> BodyPath:
    found = plan(*arguments, **options).path
    assert found is not None
    return found


def touched(body_path: BodyPath, heights, width: float, depth: float) -> bool:
    """Whether a body that walks a path touches anything that stands out of the ground by 0.5 m: cell by cell."""
    rows, columns = np.nonzero(heights > 0.5)
    cells = np.column_stack((columns, rows)) * RESOLUTION + (-1.0, -3.0) + 0.5 * RESOLUTION
    for arc in np.arange(0.0, body_path.length, 0.01):
        x, y, yaw = body_path.at(arc)
        ahead, left = np.array((np.cos(yaw), np.sin(yaw))), np.array((-np.sin(yaw), np.cos(yaw)))
        off = cells - (x, y)
        if ((np.abs(off @ ahead) < 0.5 * depth) & (np.abs(off @ left) < 0.5 * width)).any():
            return True
    return False


@pytest.mark.parametrize("seed", range(8))
def test_no_path_leads_through_a_wall(seed):
    heights = random_ground(seed)
    found = path(heights)
    assert found.end is PathEnd.GOAL
    assert not touched(found, heights, PARAMETERS.body_width - 0.1, PARAMETERS.body_depth - 0.1)


def test_the_body_looks_along_the_way_and_turns_at_both_ends():
    found = path(level(), start=(0.0, 0.0, 1.0), goal=(3.0, 0.0, -1.0))
    np.testing.assert_allclose(found.waypoints_world, ((0, 0, 1), (0.25, 0, 0), (2.75, 0, 0), (3, 0, -1)), atol=1e-3)


def test_a_goal_near_by_is_walked_to_without_turning_to_it():
    found = path(level(), goal=(0.0, 0.4, 0.3))
    np.testing.assert_allclose(found.waypoints_world, ((0, 0, 0), (0, 0.4, 0.3)))


def test_a_goal_beyond_the_map_is_walked_to_as_far_as_the_border():
    found = path(level(), goal=(9.0, 0.0, 1.0))
    assert found.end is PathEnd.BORDER
    x, y, yaw = found.waypoints_world[-1]
    assert (x, y, yaw) == pytest.approx((5.0, 0.0, 0.0), abs=PARAMETERS.spacing)
    assert found.leads_to(Goal(9.0, 0.0, 1.0))


def test_ground_that_nobody_has_seen_is_walked_on_but_not_chosen():
    unseen = np.full_like(level(), np.nan)
    assert path(unseen).end is PathEnd.GOAL
    patch = box(level(), (1.5, 2.5), (-0.8, 0.8), np.nan)
    assert np.abs(path(patch).waypoints_world[:, 1]).max() > 0.8


def test_a_goal_inside_a_block_is_walked_to_as_near_as_it_gets():
    block = box(level(), (3.7, 4.3), (-0.3, 0.3), 1.0)
    found = path(block)
    assert found.end is PathEnd.GOAL_OCCUPIED
    assert 0.5 < np.hypot(*(found.waypoints_world[-1, :2] - (4.0, 0.0))) < 0.75
    assert not touched(found, block, 0.8, 0.4)


def test_a_goal_behind_a_wall_without_a_gap_is_cut_off():
    wall = box(level(), (1.9, 2.1), (-3.0, 3.0), 1.0)
    found = path(wall)
    assert found.end is PathEnd.GOAL_CUT_OFF
    assert 1.2 < found.waypoints_world[-1, 0] < 1.9


def test_where_no_place_is_nearer_to_the_goal_the_path_stays():
    wall = box(level(), (1.9, 2.1), (-3.0, 3.0), 1.0)
    there = path(wall).waypoints_world[-1]
    found = path(wall, start=there)
    assert found.length < 0.2 and found.end is PathEnd.GOAL_CUT_OFF


def test_a_free_path_is_kept_until_another_is_clearly_cheaper():
    # A block in the middle: both ways around it cost nearly the same.
    def ground(spoilt: float) -> np.ndarray:
        block = box(level(), (1.5, 2.3), (-0.4, 0.4), 1.0)
        return box(block, (1.4, 2.4), (0.4, 3.0), spoilt)

    first = path(ground(0.0))
    side = np.sign(first.waypoints_world[np.argmax(np.abs(first.waypoints_world[:, 1])), 1])
    mirrored = [ground(0.0), ground(0.0)[::-1]]
    for heights in mirrored:
        again = plan(heights, start=(0.2, 0.02, 0.0), walked=first)
        assert again.kept and again.path is first
    heights = ground(1.2) if side > 0 else ground(1.2)[::-1]
    blocked = plan(heights, start=(0.2, 0.0, 0.0), walked=first)
    assert not blocked.kept and blocked.path is not None
    assert np.sign(blocked.path.waypoints_world[np.argmax(np.abs(blocked.path.waypoints_world[:, 1])), 1]) == -side


def test_a_cheaper_way_is_taken_only_where_it_saves_the_fraction():
    free = level()
    detour = path(box(free, (1.5, 2.3), (-0.6, 0.6), 1.0))
    cost = plan(free).cost
    patient = dataclasses.replace(PARAMETERS, better_by=0.5)
    request = PathRequest(height_map(free), np.zeros(3), Goal(4.0, 0.0, 0.0), patient, detour)
    kept = plan_body_path(request)
    assert kept.kept and cost < kept.cost < 2.0 * cost
    taken = plan_body_path(dataclasses.replace(request, parameters=dataclasses.replace(PARAMETERS, better_by=0.02)))
    assert not taken.kept and taken.cost == pytest.approx(cost, rel=0.01)


def test_a_path_does_not_flap_while_the_map_is_noisy():
    rng = np.random.default_rng(0)
    block = box(level(), (1.5, 2.3), (-0.4, 0.4), 1.0)
    walked = path(block)
    sides = []
    for step in range(12):
        x, y, yaw = walked.at(0.1 * step)
        noisy = block + rng.normal(0.0, 0.015, block.shape)
        noisy[rng.random(block.shape) < 0.1] = np.nan
        walked = path(noisy, start=(x, y, yaw), walked=walked)
        sides.append(np.sign(walked.waypoints_world[np.argmax(np.abs(walked.waypoints_world[:, 1])), 1]))
    assert len(set(sides)) == 1


def test_the_same_request_gives_the_same_path():
    first, second = (path(random_ground(3)) for _ in range(2))
    np.testing.assert_array_equal(first.waypoints_world, second.waypoints_world)
