"""How far a step brings the body, against all steps that are allowed."""

from __future__ import annotations

import itertools
from math import cos, pi, radians, sin

import numpy as np
import pytest

from skills.footsteps import FootstepParameters
from skills.footsteps.stride import stride_along, stride_towards

PARAMETERS = FootstepParameters(back_reach=0.3)


def body_moves(p: FootstepParameters) -> np.ndarray:
    """Ways of the body, (N, 2) ahead and to the left, by steps of either foot from a level stance."""
    moves = []
    lengths, widths = np.linspace(-p.back_reach, p.reach, 24), np.linspace(p.minimum_width, p.maximum_width, 12)
    for sign, length, width in itertools.product((1.0, -1.0), lengths, widths):
        if np.hypot(length, width - p.ideal_width) > p.reach:
            continue
        for outward in np.linspace(-p.inward_yaw, p.outward_yaw, 7):
            turn, half = sign * outward, 0.5 * p.ideal_width
            before = np.array((0.0, half * sign))
            after = np.array((length, sign * width)) + sign * half * np.array((sin(turn), -cos(turn)))
            moves.append(after - before)
    return np.array(moves)


def test_no_step_brings_the_body_farther_in_its_direction():
    for move in body_moves(PARAMETERS):
        assert np.hypot(*move) <= stride_towards(np.arctan2(move[1], move[0]), PARAMETERS) + 1e-9


@pytest.mark.parametrize(("direction_deg", "share"), [(0, 0.9), (90, 0.9), (180, 0.85), (-90, 0.9)])
def test_some_step_brings_it_nearly_as_far(direction_deg, share):
    moves, direction = body_moves(PARAMETERS), radians(direction_deg)
    along = np.array((cos(direction), sin(direction)))
    straight = moves[np.abs(moves @ (-along[1], along[0])) < 0.02]
    assert (straight @ along).max() >= share * stride_towards(direction, PARAMETERS)


def test_a_path_counts_for_its_fastest_piece():
    ahead = stride_towards(0.0, PARAMETERS)
    aside = np.array(((0.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
    assert stride_along(aside, PARAMETERS) == pytest.approx(stride_towards(pi / 2, PARAMETERS))
    assert stride_along(np.vstack((aside, (1.0, 1.0, 0.0))), PARAMETERS) == ahead
    assert stride_along(np.zeros((2, 3)), PARAMETERS) == ahead
