import numpy as np
import pytest

from skills.geometry.pose import Array
from skills.walking.dcm_plan import DcmPlan, plan_from_present

OMEGA = 2.96


def advance_exactly(omega: float, com: Array, dcm: Array, cop: Array, duration: float) -> tuple[Array, Array]:
    """CoM and DCM after a time under a constant CoP, each (2,) [m]."""
    grow, decay = np.exp(omega * duration), np.exp(-omega * duration)
    offset = dcm - cop
    return cop + 0.5 * offset * (grow - decay) + (com - cop) * decay, cop + offset * grow


def random_plan(seed: int) -> tuple[DcmPlan, list[float], np.ndarray]:
    rng = np.random.default_rng(seed)
    durations = list(rng.uniform(0.1, 1.2, 6))
    cops = np.cumsum(rng.uniform(-0.2, 0.3, (7, 2)), axis=0)
    return DcmPlan(OMEGA, durations, list(cops)), durations, cops


@pytest.mark.parametrize("seed", range(5))
def test_the_planned_dcm_obeys_its_dynamics(seed: int) -> None:
    plan, _, _ = random_plan(seed)
    h = 1e-5
    for t in np.linspace(0.01, plan.duration - 0.01, 97):
        dcm, cop = plan.reference(t)
        velocity = (plan.reference(t + h)[0] - plan.reference(t - h)[0]) / (2 * h)
        np.testing.assert_allclose(velocity, OMEGA * (dcm - cop), atol=2e-4)


@pytest.mark.parametrize("seed", range(5))
def test_the_plan_is_continuous_and_ends_at_rest(seed: int) -> None:
    plan, durations, cops = random_plan(seed)
    for end, cop in zip(np.cumsum(durations), cops[1:], strict=True):
        before, after = plan.reference(end - 1e-9), plan.reference(end + 1e-9)
        np.testing.assert_allclose(before[0], after[0], atol=1e-7)
        np.testing.assert_allclose(after[1], cop, atol=1e-7)
    for t in (plan.duration, plan.duration + 500.0):
        np.testing.assert_array_equal(plan.reference(t), (cops[-1], cops[-1]))


def test_going_forward_from_the_planned_start_reaches_the_planned_end() -> None:
    plan, _, cops = random_plan(7)
    dcm, h = plan.reference(0.0)[0], 1e-4
    for t in np.arange(0.0, 2.0, h):
        _, dcm = advance_exactly(OMEGA, dcm, dcm, plan.reference(t + h / 2)[1], h)
    np.testing.assert_allclose(dcm, plan.reference(2.0)[0], atol=1e-5)
    assert np.linalg.norm(dcm - cops[-1]) > 0.1


def test_the_com_follows_the_dcm() -> None:
    plan, _, _ = random_plan(3)
    com, h = np.array((0.1, -0.2)), 1e-4
    times = np.arange(0.0, plan.duration + 1.0, h)
    closed = plan.com(times, com)
    rate = np.gradient(closed, h, axis=0)[1:-1]
    dcms = np.array([plan.reference(t)[0] for t in times[1:-1]])
    np.testing.assert_allclose(closed[0], com, atol=1e-12)
    np.testing.assert_allclose(rate, OMEGA * (dcms - closed[1:-1]), atol=2e-3)


def test_exact_motion_matches_many_small_steps() -> None:
    com, dcm, cop = np.array((0.1, 0.0)), np.array((0.15, 0.02)), np.array((0.05, 0.05))
    after = advance_exactly(OMEGA, com, dcm, cop, 0.3)
    n = 100_000
    for _ in range(n):
        com, dcm = com + OMEGA * (dcm - com) * 0.3 / n, dcm + OMEGA * (dcm - cop) * 0.3 / n
    np.testing.assert_allclose(after, (com, dcm), atol=1e-5)


def test_a_new_plan_starts_at_the_present_where_support_allows() -> None:
    dcm, cop = np.array((0.05, 0.03)), np.array((0.0, 0.01))
    ends = [np.array((0.1, 0.1)), np.array((0.12, 0.1)), np.array((0.2, 0.0))]
    free = plan_from_present(OMEGA, dcm, cop, [0.4, 1.2, 0.8], ends, lambda point: point, 0.08)
    np.testing.assert_allclose(free.reference(0.0), (dcm, cop), atol=1e-12)
    narrow = plan_from_present(OMEGA, dcm, cop, [0.4, 1.2, 0.8], ends, lambda point: np.clip(point, 0.0, 0.02), 0.08)
    np.testing.assert_allclose(narrow.reference(0.2)[1], np.clip(narrow.reference(0.2)[1], 0.0, 0.02))
    assert np.linalg.norm(narrow.reference(0.0)[0] - dcm) > 1e-3
