import numpy as np

from skills.walking.uniform_spline import UniformSpline, controls_of_motion, minimum_jerk, minimum_jerk_at


def test_derivatives_match_differences_and_acceleration_is_continuous() -> None:
    spline = UniformSpline(0.5, 0.2, np.random.default_rng(0).normal(size=(9, 2)))
    h = 1e-5
    for t in np.linspace(0.52, 1.65, 40):
        _, velocity, acceleration = spline.motion(t)
        ahead, behind = spline.motion(t + h), spline.motion(t - h)
        np.testing.assert_allclose((ahead[0] - behind[0]) / (2 * h), velocity, atol=1e-5)
        np.testing.assert_allclose((ahead[1] - behind[1]) / (2 * h), acceleration, atol=5e-3)
    for knot in (0.7, 0.9, 1.1):
        np.testing.assert_allclose(spline.motion(knot - 1e-9)[2], spline.motion(knot + 1e-9)[2], atol=1e-4)
    times = np.linspace(0.0, 2.0, 50)
    np.testing.assert_allclose(spline.values(times), [spline.value(t) for t in times], atol=1e-12)


def test_it_starts_in_a_given_motion() -> None:
    motion = np.array([1.0]), np.array([0.3]), np.array([-2.0])
    controls = np.vstack((controls_of_motion(*motion, 0.1), [[2.0], [3.0]]))
    np.testing.assert_allclose(UniformSpline(0.0, 0.1, controls).motion(0.0), motion, atol=1e-12)


def test_it_stays_within_its_controls() -> None:
    controls = np.random.default_rng(1).normal(size=(20, 1))
    values = UniformSpline(0.0, 1.0, controls).values(np.linspace(0.0, 17.0, 500))
    assert controls.min() <= values.min() <= values.max() <= controls.max()


def test_minimum_jerk_rests_at_both_ends() -> None:
    x = np.array((-1.0, 0.0, 1e-3, 0.5, 1.0 - 1e-3, 1.0, 2.0))
    np.testing.assert_allclose(minimum_jerk(x), (0.0, 0.0, 0.0, 0.5, 1.0, 1.0, 1.0), atol=1e-7)
    np.testing.assert_allclose([minimum_jerk_at(float(v)) for v in x], minimum_jerk(x))
