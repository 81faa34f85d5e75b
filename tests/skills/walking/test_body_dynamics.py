"""Every rigid-body term against finite differences, or against another algorithm for the same quantity."""

import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports]
import pytest

from skills.footsteps.footstep import Side
from skills.geometry.pose import Array
from skills.walking import RobotModel
from skills.walking.body_dynamics import BodyDynamics

STEP = 1e-6
SEEDS = range(3)


def random_state(model: RobotModel, seed: int) -> tuple[Array, Array]:
    rng = np.random.default_rng(seed)
    q = model.neutral_configuration()
    q[:3] = rng.uniform(-1.0, 1.0, 3)
    q[3:7] = rng.normal(size=4)
    q[3:7] /= np.linalg.norm(q[3:7])
    q[7:] = rng.uniform(model.lower_limits, model.upper_limits)
    return q, rng.normal(size=model.pin_model.nv)


def in_state(model: RobotModel, q: Array, v: Array) -> BodyDynamics:
    body = BodyDynamics(model)
    body.update(q, v)
    return body


@pytest.fixture(params=SEEDS)
def body(request: pytest.FixtureRequest, model: RobotModel) -> BodyDynamics:
    return in_state(model, *random_state(model, request.param))


def moved(body: BodyDynamics, time: float) -> BodyDynamics:
    """The same body a little later (or earlier) on a motion without joint accelerations."""
    q = pin.integrate(body.model.pin_model, body.q, body.v * time)
    return in_state(body.model, q, body.v)


def test_velocities_are_the_rates_of_positions(body: BodyDynamics) -> None:
    before, behind = moved(body, -STEP), moved(body, STEP)
    np.testing.assert_allclose((behind.com - before.com) / (2 * STEP), body.com_velocity, atol=1e-7)
    for side in Side:
        sole, a, b = body.sole(side), before.sole(side), behind.sole(side)
        velocity = body.sole_velocity(side)
        np.testing.assert_allclose(sole.R.T @ (b.p - a.p) / (2 * STEP), velocity[:3], atol=1e-7)
        np.testing.assert_allclose(pin.log3(a.R.T @ b.R) / (2 * STEP), velocity[3:], atol=1e-7)
    turned = pin.log3(before.R_world_torso.T @ behind.R_world_torso) / (2 * STEP)
    np.testing.assert_allclose(turned, body.torso_jacobian @ body.v, atol=1e-7)
    turned = pin.log3(before.R_world_pelvis.T @ behind.R_world_pelvis) / (2 * STEP)
    np.testing.assert_allclose(turned, body.v[3:6], atol=1e-7)


def test_drifts_are_the_rates_of_velocities_without_acceleration(body: BodyDynamics) -> None:
    before, behind = moved(body, -STEP), moved(body, STEP)
    np.testing.assert_allclose(
        (behind.momentum - before.momentum) / (2 * STEP), body.momentum_drift, rtol=1e-6, atol=1e-5
    )
    for side in Side:
        rate = (behind.sole_velocity(side) - before.sole_velocity(side)) / (2 * STEP)
        np.testing.assert_allclose(rate, body.sole_drifts[side], atol=1e-6)
    rate = (behind.torso_jacobian - before.torso_jacobian) @ body.v / (2 * STEP)
    np.testing.assert_allclose(rate, body.torso_drift, atol=1e-6)


def test_momentum_is_what_all_bodies_carry(body: BodyDynamics) -> None:
    model = body.model.pin_model
    data = model.createData()
    pin.forwardKinematics(model, data, body.q, body.v)
    linear, angular = np.zeros(3), np.zeros(3)
    for inertia, placement, velocity in zip(model.inertias[1:], data.oMi[1:], data.v[1:], strict=True):
        com = placement * inertia.lever
        com_velocity = placement.rotation @ (velocity.linear + np.cross(velocity.angular, inertia.lever))
        linear += inertia.mass * com_velocity
        angular += placement.rotation @ inertia.inertia @ velocity.angular
        angular += np.cross(com - body.com, inertia.mass * com_velocity)
    np.testing.assert_allclose(body.momentum, np.concatenate((linear, angular)), atol=1e-9)
    np.testing.assert_allclose(body.momentum[:3], body.model.mass * body.com_velocity, atol=1e-9)


def test_mass_matrix_and_bias_are_those_of_inverse_dynamics(body: BodyDynamics) -> None:
    model, data = body.model.pin_model, body.model.pin_model.createData()
    damping = model.damping * body.v
    np.testing.assert_allclose(body.bias - damping, pin.rnea(model, data, body.q, body.v, 0.0 * body.v), atol=1e-9)
    np.testing.assert_array_equal(body.mass_matrix, body.mass_matrix.T)
    for column, direction in enumerate(np.eye(model.nv)):
        forces = pin.rnea(model, data, body.q, body.v, direction) + damping - body.bias
        np.testing.assert_allclose(body.mass_matrix[:, column], forces, atol=1e-9)


def test_an_update_leaves_nothing_of_the_state_before(model: RobotModel) -> None:
    body = BodyDynamics(model)
    body.update(*random_state(model, 1))
    kept = body.mass_matrix.copy(), body.mass_matrix
    body.update(*random_state(model, 2))
    np.testing.assert_array_equal(*kept)
    fresh = in_state(model, *random_state(model, 2))
    for name in ("mass_matrix", "bias", "com", "momentum_matrix", "momentum_drift", "torso_drift"):
        np.testing.assert_array_equal(getattr(body, name), getattr(fresh, name))
