import numpy as np
import pytest
from scipy.optimize import minimize

from skills.footsteps.wiggle import wiggle_sole
from skills.geometry.pose import Array

SOLE = np.array(((-0.13, -0.069), (0.13, -0.069), (0.13, 0.069), (-0.13, 0.069)))
MOST_MOVE, MOST_TURN, ARM = 0.05, 0.1, 0.15


def half_planes(outline: Array) -> Array:
    """Edges of a counter-clockwise convex polygon as rows of normal, offset and 1."""
    edges = np.roll(outline, -1, axis=0) - outline
    normals = np.column_stack((edges[:, 1], -edges[:, 0])) / np.linalg.norm(edges, axis=1)[:, None]
    return np.column_stack((normals, np.einsum("ij,ij->i", normals, outline), np.ones(len(outline))))


def rectangle(x: float, y: float, length: float, width: float, yaw: float) -> Array:
    half = 0.5 * np.array(((-length, -width), (length, -width), (length, width), (-length, width)))
    c, s = np.cos(yaw), np.sin(yaw)
    return half @ np.array(((c, s), (-s, c))) + (x, y)


def margins(planes: Array, move: Array) -> Array:
    """Distance of each corner inside each edge after a small move, (edges, corners)."""
    moved = SOLE + move[:2] + move[2] * np.column_stack((-SOLE[:, 1], SOLE[:, 0]))
    return planes[:, 2:3] - planes[:, :2] @ moved.T


def wiggled(planes: Array, target: float) -> tuple[float, Array]:
    move = np.empty(3)
    return wiggle_sole(planes, SOLE, target, MOST_MOVE, MOST_TURN, move), move


def test_a_sole_well_inside_stays():
    margin, move = wiggled(half_planes(rectangle(0.0, 0.0, 0.5, 0.4, 0.0)), 0.02)
    assert margin == 0.02
    np.testing.assert_array_equal(move, 0.0)


def test_a_sole_at_an_edge_moves_off_it_and_no_further():
    margin, move = wiggled(half_planes(rectangle(0.05, 0.0, 0.38, 0.4, 0.0)), 0.02)
    assert margin == 0.02
    np.testing.assert_allclose(move, (0.01, 0.0, 0.0), atol=1e-9)


def test_between_two_edges_it_keeps_the_best_it_can():
    margin, move = wiggled(half_planes(rectangle(0.01, 0.0, 0.28, 0.4, 0.0)), 0.02)
    assert margin == pytest.approx(0.01, abs=2e-4)
    assert move[0] == pytest.approx(0.01, abs=3e-4)


def test_a_move_is_never_longer_than_allowed():
    _, move = wiggled(half_planes(rectangle(0.5, 0.5, 0.5, 0.4, 0.6)), 0.02)
    assert np.all(np.abs(move) <= (MOST_MOVE + 1e-9, MOST_MOVE + 1e-9, MOST_TURN + 1e-9))


@pytest.mark.parametrize("seed", range(40))
def test_the_move_is_the_least_that_keeps_the_margin(seed: int):
    generator = np.random.default_rng(seed)
    x, y = generator.uniform(-0.05, 0.05, 2)
    length, width, yaw = generator.uniform((0.3, 0.18, -0.15), (0.4, 0.3, 0.15))
    planes = half_planes(rectangle(x, y, length, width, yaw))
    margin, move = wiggled(planes, 0.02)
    assert np.min(margins(planes, move)) >= min(margin, np.min(margins(planes, np.zeros(3)))) - 1e-9
    if margin < 0.02:
        return
    # SciPy as an independent solver of the same program, in general form.
    found = minimize(
        lambda m: m[0] ** 2 + m[1] ** 2 + (ARM * m[2]) ** 2,
        move + generator.normal(0, 0.005, 3),
        method="SLSQP",
        options={"ftol": 1e-14, "maxiter": 300},
        bounds=[(-MOST_MOVE, MOST_MOVE)] * 2 + [(-MOST_TURN, MOST_TURN)],
        constraints={"type": "ineq", "fun": lambda m: (margins(planes, m) - 0.02).ravel()},
    )
    ours = move[0] ** 2 + move[1] ** 2 + (ARM * move[2]) ** 2
    assert np.all(margins(planes, move) >= 0.02 - 1e-8)
    assert ours <= found.fun + 1e-8
