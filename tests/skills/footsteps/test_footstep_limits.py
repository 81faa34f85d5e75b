import itertools

import numpy as np
import pytest
from open_loop import Taken, generated, random_field, stance_foot, swing_start, walk

from skills.footsteps import FootstepParameters, PlanOutcome, Terrain
from skills.geometry.pose import Array, Pose

PARAMETERS = FootstepParameters()
ROUNDING = 1e-9
COURSES = [("rough", 0), ("rough", 1), ("uneven_flat", 0)]


@pytest.fixture(scope="module", params=COURSES, ids=lambda course: f"{course[0]}-{course[1]}")
def taken(request: pytest.FixtureRequest) -> list[Taken]:
    steps, stopped = walk(*generated(*request.param))
    assert stopped is None
    return steps


def planned_steps(taken: list[Taken]) -> list[tuple[Pose, Pose, Pose, float]]:
    """Stance foot, swing start, landing and side sign of every step of every plan, also of those not taken."""
    found = []
    for one in taken:
        stance = one.stance
        for step in one.plan.steps:
            found.append((stance.sole(step.side.opposite), stance.sole(step.side), step.T_world_sole, step.side.sign))
            stance = stance.with_sole(step.side, step.T_world_sole)
    return found


def in_stance_frame(stance: Pose, landing: Pose, sign: float) -> tuple[float, float, float, float]:
    """Length, width, rise and outward yaw of a step, seen from the stance foot held level."""
    offset = landing.p - stance.p
    c, s = np.cos(stance.yaw), np.sin(stance.yaw)
    outward = sign * (landing.yaw - stance.yaw)
    return (
        c * offset[0] + s * offset[1],
        sign * (c * offset[1] - s * offset[0]),
        offset[2],
        (outward + np.pi) % (2 * np.pi) - np.pi,
    )


def test_every_planned_step_keeps_the_limits_on_the_pose_that_is_returned(taken: list[Taken]):
    p = PARAMETERS
    for stance, start, landing, sign in planned_steps(taken):
        length, width, rise, outward = in_stance_frame(stance, landing, sign)
        reach = np.hypot(length, width - p.ideal_width)
        assert reach <= p.reach + ROUNDING
        assert length >= -p.back_reach - ROUNDING
        assert p.minimum_width - ROUNDING <= width <= p.maximum_width + ROUNDING
        assert abs(rise) <= p.max_step_height
        assert -p.inward_yaw - ROUNDING <= outward <= p.outward_yaw + ROUNDING
        if rise > p.reach_up_height:
            assert reach <= p.reach_up + ROUNDING
        if rise < -p.reach_down_height:
            assert reach <= p.reach_down + ROUNDING
        if rise < -p.uphill_drop:
            assert np.arcsin(stance.R[2, 0]) <= p.uphill_slope + ROUNDING
        assert np.hypot(*(landing.p - start.p)[:2]) <= p.swing_reach + ROUNDING
        assert abs(landing.p[2] - start.p[2]) <= p.swing_height_change
        assert np.arccos(landing.R[2, 2]) <= p.tilt


def test_soles_of_a_step_do_not_overlap(taken: list[Taken]):
    for stance, _, landing, _ in planned_steps(taken):
        assert not polygons_overlap(outline(stance), outline(landing))


def test_footholds_hold_the_sole_up(taken: list[Taken]):
    for one in taken:
        for step in one.plan.steps:
            rise = heights_over_sole(one.terrain, step.T_world_sole)
            assert np.nanmax(rise) <= PARAMETERS.ground_above + 1e-9
            supported = rise >= -PARAMETERS.support_below - 1e-9
            # The finer grid of this test may meet a few more cells of a gap than the planner's samples did.
            assert np.mean(supported) >= PARAMETERS.share - 0.02


def test_plans_are_three_steps_or_more_until_the_goal_is_in_sight(taken: list[Taken]):
    for one in taken:
        if one.plan.outcome is not PlanOutcome.GOAL_REACHED:
            assert len(one.plan.steps) >= 3
        sides = [step.side for step in one.plan.steps]
        assert all(a is b.opposite for a, b in itertools.pairwise(sides))


def test_sole_frames_lie_in_the_ground_and_look_along_the_heading(taken: list[Taken]):
    for one in taken:
        T = one.step.T_world_sole
        np.testing.assert_allclose(T.R @ T.R.T, np.eye(3), atol=1e-12)
        centre, ahead = one.terrain.heights(np.stack((T.p, T @ np.array((0.02, 0.0, 0.0)))))
        np.testing.assert_allclose(centre, T.p[2], atol=1e-12)
        assert ahead == pytest.approx((T @ np.array((0.02, 0.0, 0.0)))[2], abs=PARAMETERS.ground_above)


@pytest.mark.parametrize("seed", range(4))
def test_short_random_fields_are_crossed(seed: int):
    steps, stopped = walk(random_field(seed), np.zeros(3), np.array((1.2 + 0.37 * 8, 0.0, 0.0)))
    assert stopped is None
    assert len(steps) < 20


@pytest.mark.sweep
@pytest.mark.parametrize("seed", range(10))
@pytest.mark.parametrize("name", ["rough", "uneven_flat", "flat"])
def test_generated_courses_are_crossed_on_true_regions(name: str, seed: int):
    taken, stopped = walk(*generated(name, seed))
    assert stopped is None
    for stance, _, landing, sign in planned_steps(taken):
        length, width, _, _ = in_stance_frame(stance, landing, sign)
        assert np.hypot(length, width - PARAMETERS.ideal_width) <= PARAMETERS.reach + ROUNDING


def heights_over_sole(terrain: Terrain, T_world_sole: Pose) -> Array:
    """Ground above the sole's plane at points 5 mm apart; a gap counts as far below."""
    x = np.linspace(-0.5, 0.5, 53) * PARAMETERS.sole_length
    y = np.linspace(-0.5, 0.5, 29) * PARAMETERS.sole_width
    points = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    points_world = T_world_sole @ np.column_stack((points, np.zeros(len(points))))
    return np.nan_to_num(terrain.heights(points_world), nan=-1.0) - points_world[:, 2]


def outline(T_world_sole: Pose) -> Array:
    x, y = 0.5 * PARAMETERS.sole_length, 0.5 * PARAMETERS.sole_width
    return (T_world_sole @ np.array(((-x, -y, 0), (x, -y, 0), (x, y, 0), (-x, y, 0))))[:, :2]


def polygons_overlap(a: Array, b: Array) -> bool:
    for polygon in (a, b):
        for edge in np.roll(polygon, -1, axis=0) - polygon:
            normal = np.array((-edge[1], edge[0]))
            if max(a @ normal) <= min(b @ normal) or max(b @ normal) <= min(a @ normal):
                return False
    return True


def test_the_first_step_starts_from_the_imminent_stance(taken: list[Taken]):
    for before, after in itertools.pairwise(taken):
        assert stance_foot(after).p == pytest.approx(before.step.T_world_sole.p)
        assert swing_start(after).p == pytest.approx(stance_foot(before).p)
