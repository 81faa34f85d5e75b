"""A planner with the truth and all the time in the world: breadth-first over every foothold on a 4 cm grid."""

import dataclasses
from collections import deque

import numpy as np
import pytest

from sim_envs.courses import Ground, course_names, load_course

CELL = 0.04
SOLE = (0.26, 0.138)
REACH, BACK, WIDTHS, RISE, TILT = 0.50, 0.12, (0.17, 0.40), 0.25, np.radians(25.0)
CARRIED, NEAR = 0.95, 0.015


def footholds(ground, x, y):
    """Height of the ground at grid nodes (X, Y); NaN where a sole has no hold."""
    grid_x, grid_y = np.meshgrid(x, y, indexing="ij")
    height, normal, _ = ground.surface(np.column_stack((grid_x.ravel(), grid_y.ravel())))
    usable = np.isfinite(height) & (normal[:, 2] > np.cos(TILT))
    z = np.where(usable, height, 0.0)
    slope = np.where(usable[:, None], -normal[:, :2] / np.maximum(normal[:, 2:], 0.1), 0.0)
    carried = np.zeros(len(z))
    samples = [(dx, dy) for dx in np.linspace(-0.5, 0.5, 9) for dy in np.linspace(-0.5, 0.5, 5)]
    for dx, dy in samples:
        offset = np.array((dx * SOLE[0], dy * SOLE[1]))
        under = ground.ground_height(np.column_stack((grid_x.ravel(), grid_y.ravel())) + offset)
        carried += np.abs(under - (z + slope @ offset)) < NEAR
    return np.where(usable & (carried / len(samples) >= CARRIED), z, np.nan).reshape(grid_x.shape)


def is_walkable(course):
    """Whether steps within a biped's limits lead from the start to the goal, soles straight ahead."""
    x = np.arange(-0.24, course.goal[0] + 0.3, CELL)
    y = np.arange(min(0.0, course.goal[1]) - 0.6, max(0.0, course.goal[1]) + 0.61, CELL)
    hold = footholds(Ground(course.boxes), x, y)
    steps = [
        (i, j)
        for i in range(-int(BACK / CELL), int(REACH / CELL) + 1)
        for j in range(1, int(REACH / CELL) + 1)
        if WIDTHS[0] <= j * CELL <= WIDTHS[1] and np.hypot(i * CELL, j * CELL - 0.24) <= REACH
    ]
    start = (int(np.argmin(abs(x))), int(np.argmin(abs(y - 0.12))), 0)
    queue: deque[tuple[int, int, int]] = deque([start])
    seen = set(queue)
    while queue:
        i, j, foot = queue.popleft()
        if np.hypot(x[i] - course.goal[0], y[j] - course.goal[1]) < 0.25:
            return True
        side = -1 if foot == 0 else 1
        for di, dj in steps:
            node = (i + di, j + side * dj, 1 - foot)
            if 0 <= node[0] < len(x) and 0 <= node[1] < len(y) and node not in seen:
                change = hold[node[0], node[1]] - hold[i, j]
                if abs(change) <= RISE:  # False where there is no hold.
                    seen.add(node)
                    queue.append(node)
    return False


@pytest.mark.parametrize("name", course_names())
def test_every_course_can_be_walked_by_a_planner_with_the_truth(name):
    assert is_walkable(load_course(name, 0))


@pytest.mark.parametrize("seed", range(5))
def test_rough_can_be_walked_whatever_the_seed(seed):
    assert is_walkable(load_course("rough", seed))


def test_a_course_with_a_row_missing_cannot_be_walked():
    assert is_walkable(load_course("rough", 0, rows=6))
    assert not is_walkable(load_course("rough", 0, rows=6, missing_rows=1))


def test_moved_blocks_can_be_walked_when_all_have_moved():
    course = load_course("moved_blocks", 0)
    last = {event.box: event.T_world_box for event in course.events}
    boxes = tuple(dataclasses.replace(box, T_world_box=last.get(box.name, box.T_world_box)) for box in course.boxes)
    assert is_walkable(dataclasses.replace(course, boxes=boxes))


@pytest.mark.sweep
@pytest.mark.parametrize(
    ("options", "least"),
    [
        ({}, 1.0),
        ({"tilted_share": 0.7}, 1.0),
        ({"tilted_share": 1.0}, 0.95),
        ({"tilted_share": 1.0, "height_spread": 0.15}, 0.9),
        ({"missing_share": 0.15}, 0.95),
        ({"missing_share": 0.30}, 0.5),
    ],
)
def test_share_of_rough_courses_that_can_be_walked(options, least):
    walked = [is_walkable(load_course("rough", seed, **options)) for seed in range(20)]
    print(options, np.mean(walked))
    assert np.mean(walked) >= least
