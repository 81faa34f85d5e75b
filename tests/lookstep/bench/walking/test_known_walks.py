"""Courses with known footsteps hold what they say: ground under every sole, off by no more than the errors."""

import numpy as np
import pytest

from lookstep.bench.walking.cases import CASES
from lookstep.bench.walking.known_walks import Cadence, GroundErrors, block_walk, flat_walk, ridge_walk
from sim_envs.courses import Ground

CADENCE = Cadence(0.385, 0.8, 0.3)


def _walks(errors=None):
    for seed in range(5):
        rng = np.random.default_rng(seed)
        yield block_walk(12, CADENCE, rng, levels=(0.0, 0.1), tilt=np.deg2rad(15.0), errors=errors)


def test_without_errors_the_ground_is_where_the_steps_say():
    for walk in (*_walks(), ridge_walk(12, CADENCE, np.random.default_rng(0), share=0.6)):
        ground = Ground(walk.course.boxes)
        for step in walk.steps:
            corners = step.T_world_sole @ np.column_stack((0.99 * step.foothold_sole, np.zeros(4)))
            np.testing.assert_allclose(ground.ground_height(corners[:, :2]), corners[:, 2], atol=1e-6)


def test_errors_of_the_ground_stay_within_their_range_and_fill_it():
    errors = GroundErrors(height=0.02, tilt=np.deg2rad(3.0))
    heights = []
    for walk in _walks(errors):
        ground = Ground(walk.course.boxes)
        for step in walk.steps[:-2]:
            height, normal, _ = ground.surface(step.T_world_sole.p[None, :2])
            heights.append(float(height[0] - step.T_world_sole.p[2]))
            assert np.arccos(normal[0] @ step.T_world_sole.R[:, 2]) <= np.sqrt(2.0) * errors.tilt + 1e-9
    # Seen from above a raised tilted block is met beside its middle, a little off.
    assert max(np.abs(heights)) <= errors.height / np.cos(np.deg2rad(18.0)) + 1e-3
    assert np.std(heights) == pytest.approx(errors.height / np.sqrt(3.0), rel=0.2)


@pytest.mark.parametrize("ridge", [False, True])
def test_soles_at_rest_and_blocks_keep_clear_of_each_other(ridge):
    rng = np.random.default_rng(1)
    cadence = Cadence(0.3, 0.8, 0.3)
    walk = ridge_walk(8, cadence, rng, share=0.6) if ridge else block_walk(8, cadence, rng, levels=(0.0, 0.2))
    ground = Ground(walk.course.boxes)
    for side in (1.0, -1.0):
        start = np.array([[x, side * 0.12 + y, 0.001] for x in (-0.13, 0.13) for y in (-0.069, 0.069)])
        assert np.all(ground.penetration(start) < 0.0)


def test_feet_take_turns_and_end_beside_each_other():
    for walk in (*_walks(), flat_walk(9, CADENCE, np.random.default_rng(2), turn=0.4)):
        assert all(a.side is b.side.opposite for a, b in zip(walk.steps, walk.steps[1:], strict=False))
        left, right = (step.T_world_sole for step in walk.steps[-2:])
        assert np.linalg.norm(left.p - right.p) == pytest.approx(0.24)
        assert np.allclose(0.5 * (left.p + right.p)[:2], walk.course.goal[:2])


def test_every_case_makes_the_same_trial_from_the_same_seed():
    for case in CASES.values():
        one, two = case.trial(3, 4), case.trial(3, 4)
        assert one.case == case.name and one.physics == two.physics
        for a, b in zip(one.walk.course.boxes, two.walk.course.boxes, strict=True):
            assert np.array_equal(a.T_world_box.p, b.T_world_box.p) and np.array_equal(a.T_world_box.R, b.T_world_box.R)
