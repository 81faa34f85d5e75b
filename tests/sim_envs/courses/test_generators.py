import numpy as np
import pytest

from sim_envs.courses import Course, CourseError, Ground, course_names, load_course
from skills.parameters import ParameterError

ROWS, COLUMNS, PITCH, WIDTH = 19, 3, 0.37, 0.39


def blocks(course: Course):
    return [box for box in course.boxes if box.kind == "block"]


def tops(course: Course):
    return np.array([box.T_world_box @ np.array([0.0, 0.0, box.size[2] / 2]) for box in blocks(course)])


def tilts(course: Course):
    """Angle (N,) and horizontal direction (N, 2) of every block's upward normal."""
    normals = np.array([box.T_world_box.R[:, 2] for box in blocks(course)])
    return np.arccos(np.clip(normals[:, 2], -1, 1)), normals[:, :2]


@pytest.mark.parametrize("seed", range(20))
def test_rough_has_the_statistics_of_the_reference_course(seed):
    course = load_course("rough", seed)
    top, (angles, directions) = tops(course), tilts(course)
    tilted = angles > np.radians(1.0)
    assert len(top) == ROWS * COLUMNS
    assert 0.30 <= tilted.mean() <= 0.38
    assert np.all(np.degrees(angles[tilted]) >= 11.0 - 1e-9)
    assert np.all(np.degrees(angles[tilted]) <= 18.0 + 1e-9)
    for axis in (0, 1):
        assert np.any(directions[tilted, axis] > 0.1)
        assert np.any(directions[tilted, axis] < -0.1)
    assert 0.40 <= top[:, 2].max() <= 0.48
    rows = top[:, 0].reshape(ROWS, COLUMNS)
    np.testing.assert_allclose(np.diff(rows[:, 0]), PITCH)
    np.testing.assert_allclose(np.sort(np.unique(top[:, 1].round(9))), [-WIDTH, 0.0, WIDTH])
    assert 6.9 <= ROWS * PITCH <= 7.1


@pytest.mark.parametrize("seed", range(20))
def test_rough_rows_differ_by_what_a_biped_steps(seed):
    height = tops(load_course("rough", seed))[:, 2].reshape(ROWS, COLUMNS)
    assert np.abs(np.diff(height, axis=0)).max() < 0.20
    assert np.abs(np.diff(height, axis=1)).max() <= 0.10
    assert abs(height[0]).max() < 0.10
    assert abs(height[-1]).max() < 0.10


@pytest.mark.parametrize("name", ["flat", "uneven_flat", "rough", "rough_wide", "moved_blocks", "detour"])
def test_same_seed_gives_the_same_course(name):
    def everything(seed):
        course = load_course(name, seed)
        return [(b.name, b.size, b.kind, b.T_world_box.R.tobytes(), b.T_world_box.p.tobytes()) for b in course.boxes]

    assert everything(4) == everything(4)
    if name != "flat":
        assert everything(4) != everything(5)


@pytest.mark.parametrize("name", ["flat", "uneven_flat", "rough"])
def test_generated_courses_cannot_be_walked_around(name):
    course = load_course(name, 1)
    ground = Ground(course.boxes)
    assert course.start == (0.0, 0.0, 0.0)
    assert course.goal[0] == pytest.approx(8.0, abs=0.1)
    x = np.arange(-0.7, course.goal[0] + 0.7, 0.01)
    half_width = 1.2 if name == "flat" else 0.5 * COLUMNS * WIDTH
    for side in (-1, 1):
        beside = np.column_stack((x, np.full_like(x, side * (half_width + 0.07))))
        assert np.all(np.isneginf(ground.ground_height(beside)))


def test_rough_fills_the_way_without_gaps():
    for seed in range(5):
        ground = Ground(load_course("rough", seed).boxes)
        x, y = np.meshgrid(np.arange(-0.7, 8.7, 0.011), np.arange(-0.58, 0.58, 0.013))
        height = ground.ground_height(np.column_stack((x.ravel(), y.ravel())))
        assert height.min() > -0.15


def test_boxes_have_unique_names():
    for name in course_names():
        names = [box.name for box in load_course(name).boxes]
        assert len(set(names)) == len(names)


def test_uneven_flat_is_level_and_uneven():
    for seed in range(10):
        course = load_course("uneven_flat", seed)
        angles, _ = tilts(course)
        heights = tops(course)[:, 2]
        assert angles.max() < 1e-9
        assert set(heights.round(4)) == {0.0, 0.0884, 0.1415, 0.192}


@pytest.mark.parametrize("share", [0.0, 0.5, 0.7, 1.0])
def test_tilted_share_is_kept_exactly(share):
    angles, _ = tilts(load_course("rough", 2, tilted_share=share))
    assert np.count_nonzero(angles > 0.1) == round(share * ROWS * COLUMNS)


def test_height_spread_widens_the_jitter():
    flat_profile = {"peak": 0.0, "tilted_share": 0.0}
    for spread in (0.0, 0.05, 0.15):
        heights = np.concatenate(
            [tops(load_course("rough", s, height_spread=spread, **flat_profile))[:, 2] for s in range(10)]
        )
        assert np.abs(heights).max() <= spread
        assert np.abs(heights).max() >= 0.95 * spread


@pytest.mark.parametrize("share", [0.15, 0.30])
def test_missing_blocks_leave_one_in_every_row(share):
    for seed in range(10):
        course = load_course("rough", seed, missing_share=share)
        rows = [box.name.split("_")[1] for box in blocks(course)]
        assert len(rows) == ROWS * COLUMNS - round(share * ROWS * COLUMNS)
        assert len(set(rows)) == ROWS


@pytest.mark.parametrize("count", [1, 2])
def test_missing_rows_lie_together_in_the_middle_half_and_the_rest_is_the_same_course(count):
    gone_somewhere = set()
    for seed in range(10):
        whole, course = load_course("rough", seed), load_course("rough", seed, missing_rows=count)
        left = {box.name: box for box in course.boxes}
        gone = {int(box.name.split("_")[1][1:]) for box in blocks(whole) if box.name not in left}
        assert gone == set(range(min(gone), min(gone) + count))
        assert min(gone) >= ROWS // 4 and max(gone) < ROWS - ROWS // 4
        assert len(blocks(course)) == (ROWS - count) * COLUMNS
        assert all(box.T_world_box.p.tobytes() == left[box.name].T_world_box.p.tobytes() for box in whole.boxes
                   if box.name in left)  # fmt: skip
        x = 0.5 + (np.array(sorted(gone)) + 0.5) * PITCH
        assert np.all(np.isneginf(Ground(course.boxes).ground_height(np.column_stack((x, np.zeros(count))))))
        gone_somewhere |= gone
    assert len(gone_somewhere) > 3


def rows_of(names):
    return sorted({int(name.split("_")[1][1:]) for name in names})


@pytest.mark.parametrize("seed", range(20))
def test_moved_blocks_are_the_rough_course_before_or_after(seed):
    """Blocks that move begin there, blocks that appear end there, blocks that vanish end in the pit."""
    rough = {box.name: box.T_world_box.p for box in load_course("rough", seed).boxes}
    course = load_course("moved_blocks", seed)
    first = {box.name: box.T_world_box.p for box in course.boxes}
    last = {event.box: event.T_world_box.p for event in course.events}
    assert len(last) == len(course.events) and set(first) == set(rough)
    appear = {name for name, p in last.items() if p[2] - first[name][2] > 0.5}
    vanish = {name for name, p in last.items() if p[2] - first[name][2] < -0.5}
    move = set(last) - appear - vanish
    for name in rough:
        assert (last if name in appear else first)[name].tobytes() == rough[name].tobytes()
    shifts = np.array([last[name][2] - first[name][2] for name in move])
    assert np.all((np.abs(shifts) >= 0.04) & (np.abs(shifts) <= 0.08))
    # Two rows wide, so that no step passes them by; where one cannot step, another column is free.
    rows = rows_of(move)
    assert len(rows) == 4 and rows[1] == rows[0] + 1 and rows[3] == rows[2] + 1
    assert {name for name in first if name.startswith("block_") and rows_of([name])[0] in rows} <= move
    for gone in (appear, vanish):
        columns = [name.split("_")[2] for name in gone if name.startswith("block_")]
        assert len(rows_of(gone)) == 2 and len(set(columns)) == (2 if gone is appear else 1)
    assert all(event.distance == 1.0 for event in course.events)


def test_unusable_names_and_options_say_what_is_allowed():
    with pytest.raises(CourseError, match=r'unknown course "ruogh"; did you mean "rough"\? \(courses: flat, .*stairs'):
        load_course("ruogh")
    with pytest.raises(CourseError, match=r'no option "tilted_shar"; did you mean "tilted_share"\?'):
        load_course("rough", tilted_shar=0.5)
    with pytest.raises(ParameterError, match=r"tilted_share: got 2, allowed: 0 \.\. 1"):
        load_course("rough", tilted_share=2)
    with pytest.raises(CourseError, match="goal_y: got 2, the pad reaches"):
        load_course("rough", goal_y=2.0)
    with pytest.raises(CourseError, match="missing_rows: got 3, 4 rows can lack 2"):
        load_course("rough", rows=4, missing_rows=3)
    with pytest.raises(CourseError, match="rows: got 12, needs at least 18 for blocks to move"):
        load_course("moved_blocks", rows=12)
    with pytest.raises(CourseError, match="above tilt_maximum"):
        load_course("rough", tilt_minimum=0.4)
    with pytest.raises(CourseError, match='course "stairs" is a file and takes no options, got peak'):
        load_course("stairs", peak=1.0)
    with pytest.raises(CourseError, match="got seed -1, needs a whole number from 0"):
        load_course("rough", -1)


@pytest.mark.parametrize("seed", range(6))
def test_detour_is_walled_in_and_passable_on_one_side_of_the_obstacle(seed):
    course = load_course("detour", seed)
    ground = Ground(course.boxes)
    (obstacle,) = (box for box in course.boxes if box.name == "obstacle")

    def gaps(x: float) -> list[float]:
        """Widths of what can be walked on across the way at x, from right to left."""
        y = np.arange(-4.0, 4.0, 0.01)
        height = ground.ground_height(np.column_stack((np.full_like(y, x), y)))
        walls = np.flatnonzero(height > 0.9)
        assert np.all(np.isneginf(height[: walls[0] - 70])) and np.all(np.isneginf(height[walls[-1] + 70 :]))
        assert np.isfinite(height[walls[0] : walls[-1]]).all()
        return [width for width in np.diff(y[walls]) if width > 0.02]

    for x in np.arange(-0.7, course.goal[0] + 0.7, 0.1):
        if abs(x - obstacle.T_world_box.p[0]) > 0.3:
            assert len(gaps(x)) == 1 and gaps(x)[0] > 2.3
    narrow, wide = sorted(gaps(obstacle.T_world_box.p[0]))
    assert narrow < 0.9 and wide > 1.1


def test_detour_bends_to_either_side_and_its_obstacle_stands_on_either_side():
    courses = [load_course("detour", seed) for seed in range(8)]
    assert {np.sign(course.goal[1]) for course in courses} == {-1.0, 1.0}
