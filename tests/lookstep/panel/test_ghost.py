"""The ghost's walk: the foot that carries stays, nothing jumps, and it ends where the plan ends."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from lookstep.panel.ghost import Ghost
from skills.footsteps import Footstep, Side, Stance
from skills.geometry import Pose

STANCE = Stance(Pose.from_xyz_rpy((0.0, 0.12, 0.0)), Pose.from_xyz_rpy((0.0, -0.12, 0.0)))


def step(number: int, side: Side, x: float, z: float) -> Footstep:
    pose = Pose.from_xyz_rpy((x, 0.12 * side.sign, z), (0.1, -0.1, 0.2))
    sole = np.array([[0.1, 0.05], [-0.1, 0.05], [-0.1, -0.05], [0.1, -0.05]])
    return Footstep(number, side, pose, sole, 0.6, 0.2, 0.1, np.zeros((0, 3)))


STEPS = (step(0, Side.LEFT, 0.4, 0.1), step(1, Side.RIGHT, 0.8, 0.2), step(2, Side.LEFT, 1.1, 0.2))


def test_it_begins_at_the_stance_and_ends_at_the_plans_end():
    ghost = Ghost(STANCE, STEPS)
    assert ghost.duration == pytest.approx(3 * 0.8)
    for side in Side:
        assert np.allclose(ghost.at(0.0).stance.sole(side).p, STANCE.sole(side).p)
    end = ghost.at(ghost.duration + 0.1).stance
    assert np.allclose(end.sole(Side.LEFT).p, STEPS[2].T_world_sole.p)
    assert np.allclose(end.sole(Side.RIGHT).R, STEPS[1].T_world_sole.R)


def test_one_foot_at_least_stays_and_none_jumps():
    ghost, dt = Ghost(STANCE, STEPS), 0.01
    poses = [ghost.at(time) for time in np.arange(0.0, ghost.duration, dt)]
    for before, after in pairwise(poses):
        moved = [float(np.linalg.norm(after.stance.sole(s).p - before.stance.sole(s).p)) for s in Side]
        assert min(moved) < 1e-9
        assert max(moved) < 4.0 * dt
        assert np.linalg.norm(after.com_xy - before.com_xy) < 4.0 * dt


def test_a_swinging_foot_clears_both_ends_by_its_swing_height():
    ghost = Ghost(STANCE, STEPS[:1])
    heights = [ghost.at(time).stance.sole(Side.LEFT).p[2] for time in np.arange(0.2, 0.8, 0.005)]
    assert max(heights) == pytest.approx(0.1 + 0.1, abs=5e-3)
