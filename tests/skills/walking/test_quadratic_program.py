"""OSQP behind our interface, on programs whose solutions are known by hand."""

import numpy as np
import pytest

from skills.geometry.pose import Array
from skills.walking.quadratic_program import OsqpSolver, QpSolution, QpStatus

FREE = np.full(3, np.inf)
P_PATTERN = np.array([[1, 1, 0], [1, 1, 0], [0, 0, 1]], dtype=bool)
A_PATTERN = np.array([[1, 1, 1], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=bool)


def solver(tolerance: float = 1e-9, iterations: int = 2000) -> OsqpSolver:
    return OsqpSolver(P_PATTERN, A_PATTERN, tolerance, iterations, 5)


def projection(point: Array, total: tuple[float, float], lower: Array, upper: Array) -> tuple[Array, ...]:
    """The point nearest to another whose sum and coordinates are bounded."""
    A = np.vstack((np.ones(3), np.eye(3)))
    return np.eye(3), -point, A, np.append(total[0], lower), np.append(total[1], upper)


def test_a_free_program_has_the_solution_of_its_linear_equations() -> None:
    P = np.array([[4.0, 1.0, 0.0], [1.0, 3.0, 0.0], [0.0, 0.0, 2.0]])
    q = np.array((1.0, -2.0, 3.0))
    A = np.vstack((np.ones(3), np.eye(3)))
    solution = solver().solve(P, q, A, np.full(4, -np.inf), np.full(4, np.inf))
    assert solution.status is QpStatus.SOLVED
    np.testing.assert_allclose(solution.x, np.linalg.solve(P, -q), atol=1e-7)


def test_values_may_change_in_the_fixed_pattern_from_one_program_to_the_next() -> None:
    reused, point = solver(), np.array((1.0, 2.0, -0.5))
    first = reused.solve(*projection(point, (3.0, 3.0), -FREE, FREE))
    np.testing.assert_allclose(first.x, point + (3.0 - point.sum()) / 3.0, atol=1e-7)
    second = reused.solve(*projection(point, (-np.inf, np.inf), np.zeros(3), np.full(3, 1.5)))
    np.testing.assert_allclose(second.x, np.clip(point, 0.0, 1.5), atol=1e-7)
    # minimize |x - point|^2 with 2 x_1 + x_2 + 0 x_3 = 0: other values of A, a zero among them.
    A = np.vstack(((2.0, 1.0, 0.0), np.eye(3)))
    third = reused.solve(np.eye(3), -point, A, np.append(0.0, -FREE), np.append(0.0, FREE))
    normal = np.array((2.0, 1.0, 0.0))
    np.testing.assert_allclose(third.x, point - (normal @ point / 5.0) * normal, atol=1e-7)
    assert {first.status, second.status, third.status} == {QpStatus.SOLVED}


def test_a_program_without_a_solution_fails_and_the_next_one_is_solved_all_the_same() -> None:
    reused, point = solver(), np.array((1.0, 2.0, -0.5))
    contradiction = projection(point, (10.0, 10.0), np.zeros(3), np.ones(3))
    assert reused.solve(*contradiction).status is QpStatus.FAILED
    after = reused.solve(*projection(point, (3.0, 3.0), -FREE, FREE))
    assert after.status is QpStatus.SOLVED
    np.testing.assert_allclose(after.x, point + (3.0 - point.sum()) / 3.0, atol=1e-6)


@pytest.mark.parametrize("bad", (np.nan, np.inf))
def test_numbers_that_are_none_fail_and_do_no_lasting_harm(bad: float) -> None:
    reused = solver()
    P, q, A, lower, upper = projection(np.array((1.0, bad, -0.5)), (3.0, 3.0), -FREE, FREE)
    assert reused.solve(P, q, A, lower, upper).status is QpStatus.FAILED
    point = np.array((1.0, 2.0, -0.5))
    after = reused.solve(*projection(point, (3.0, 3.0), -FREE, FREE))
    assert after.status is QpStatus.SOLVED
    np.testing.assert_allclose(after.x, point + (3.0 - point.sum()) / 3.0, atol=1e-6)


def test_the_iteration_cap_gives_the_best_iterate_and_says_so() -> None:
    solution = solver(tolerance=1e-9, iterations=5).solve(
        *projection(np.array((1.0, 2.0, -0.5)), (3.0, 3.0), np.zeros(3), np.full(3, 1.5))
    )
    assert solution.status is QpStatus.INACCURATE
    assert solution.iterations == 5
    assert np.all(np.isfinite(solution.x))


def test_the_same_programs_in_the_same_order_give_the_same_bits() -> None:
    def solutions() -> list[QpSolution]:
        reused, rng = solver(tolerance=1e-3), np.random.default_rng(6)
        return [
            reused.solve(*projection(rng.normal(size=3), (0.5, 0.5), np.full(3, -0.3), np.full(3, 0.4)))
            for _ in range(20)
        ]

    for first, second in zip(solutions(), solutions(), strict=True):
        np.testing.assert_array_equal(first.x, second.x)
        assert first.iterations == second.iterations
