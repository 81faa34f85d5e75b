"""MuJoCo and pinocchio read the same robot out of one MJCF file."""

from typing import Any

import mujoco
import numpy as np
import pinocchio as pin  # pyright: ignore[reportMissingImports]
import pytest
from dm_control import composer, mjcf

from sim_envs.robot import (
    Biped,
    CameraMount,
    RobotDescription,
    pelvis_pose,
    qpos_from_configuration,
    qvel_from_velocity,
)
from skills.geometry.pose import Pose

_SAMPLES = 100
_WALKING_PELVIS_HEIGHT = 0.864


@pytest.fixture(scope="module")
def models():
    description = RobotDescription()
    arena = composer.Arena()
    compiler: Any = arena.mjcf_model.compiler  # pyright: ignore[reportOptionalMemberAccess]
    compiler.boundmass = compiler.boundinertia = 0  # Composer gives the free joint's empty frame a mass.
    arena.add_free_entity(Biped(description))
    physics = mjcf.Physics.from_mjcf_model(arena.mjcf_model)
    pinocchio_model = pin.buildModelAndLegacyConstraintsFromMJCF(
        str(description.mjcf_path), pin.JointModelFreeFlyer(), "root"
    )[0]
    return physics, pinocchio_model, pinocchio_model.createData()


def _random_states(model):
    rng = np.random.default_rng(20)
    lower, upper = model.lowerPositionLimit.copy(), model.upperPositionLimit.copy()
    lower[:3], upper[:3] = -1.0, 1.0
    for _ in range(_SAMPLES):
        q = np.concatenate((rng.uniform(lower[:3], upper[:3]), np.zeros(4), rng.uniform(lower[7:], upper[7:])))
        q[3:7] = rng.standard_normal(4)
        q[3:7] /= np.linalg.norm(q[3:7])
        yield q, rng.standard_normal(model.nv)


def _local_to_world(q):
    """Maps pinocchio's velocity to MuJoCo's."""
    S = np.eye(29)
    S[:3, :3] = pelvis_pose(q).R
    return S


def _mass_matrix(physics):
    M = np.empty((29, 29))
    for j, unit in enumerate(np.eye(29)):
        mujoco.mj_mulM(physics.model.ptr, physics.data.ptr, M[j], unit)  # pyright: ignore[reportAttributeAccessIssue]
    return M


def test_joints_have_the_same_order_names_and_limits(models):
    physics, pin_model, _ = models
    mj_model = physics.model.ptr
    names = [mj_model.joint(j).name.removeprefix("atlas_class/") for j in range(1, mj_model.njnt)]
    assert names == list(pin_model.names)[2:]
    assert (pin_model.nq, pin_model.nv) == (mj_model.nq, mj_model.nv) == (30, 29)
    np.testing.assert_array_equal(mj_model.jnt_range[1:, 0], pin_model.lowerPositionLimit[7:])
    np.testing.assert_array_equal(mj_model.jnt_range[1:, 1], pin_model.upperPositionLimit[7:])
    np.testing.assert_array_equal(mj_model.jnt_actfrcrange[1:, 1], pin_model.upperEffortLimit[6:])
    np.testing.assert_array_equal(mj_model.jnt_actfrcrange[1:, 0], pin_model.lowerEffortLimit[6:])
    np.testing.assert_array_equal(mj_model.dof_damping, pin_model.damping)
    np.testing.assert_array_equal(mj_model.dof_armature, pin_model.armature)


def test_motors_drive_every_joint_in_order_with_unit_gear(models):
    mj_model = models[0].model.ptr
    np.testing.assert_array_equal(mj_model.actuator_trnid[:, 0], np.arange(1, mj_model.njnt))
    np.testing.assert_array_equal(mj_model.actuator_gear[:, 0], 1.0)


def test_robot_weighs_174_kg_in_both(models):
    physics, pin_model, _ = models
    mj_model = physics.model.ptr
    assert mj_model.body_mass.sum() == pytest.approx(pin.computeTotalMass(pin_model), abs=1e-9)
    assert mj_model.body_mass.sum() == pytest.approx(174.2, abs=0.1)


def test_mass_matrix_bias_and_kinematics_agree_in_random_states(models):
    physics, pin_model, pin_data = models
    mj_data = physics.data.ptr
    for q, v in _random_states(pin_model):
        mj_data.qpos[:] = qpos_from_configuration(q)
        mj_data.qvel[:] = qvel_from_velocity(q, v)
        physics.forward()
        M_mj = _mass_matrix(physics)

        S = _local_to_world(q)
        M = np.triu(pin.crba(pin_model, pin_data, q))
        M = M + np.triu(M, 1).T
        np.testing.assert_allclose(M, S.T @ M_mj @ S, atol=1e-9)

        # At zero MuJoCo acceleration the linear acceleration in the pelvis frame is -w x v.
        a = np.zeros(29)
        a[:3] = -np.cross(v[3:6], v[:3])
        np.testing.assert_allclose(pin.rnea(pin_model, pin_data, q, v, a), S.T @ mj_data.qfrc_bias, atol=1e-8)

        np.testing.assert_allclose(pin.centerOfMass(pin_model, pin_data, q), mj_data.subtree_com[0], atol=1e-12)
        pin.updateFramePlacements(pin_model, pin_data)
        for side in ("left", "right"):
            site = mj_data.site(f"atlas_class/{side}_sole")
            T_world_sole = pin_data.oMf[pin_model.getFrameId(f"{side}_sole")]
            np.testing.assert_allclose(T_world_sole.translation, site.xpos, atol=1e-12)
            np.testing.assert_allclose(T_world_sole.rotation, site.xmat.reshape(3, 3), atol=1e-12)


def test_foot_boxes_have_the_sole_as_their_lower_face(models):
    physics = models[0]
    mj_model, mj_data = physics.model.ptr, physics.data.ptr
    physics.reset()
    physics.forward()
    description = RobotDescription()
    for side in ("left", "right"):
        site, box = mj_data.site(f"atlas_class/{side}_sole"), f"atlas_class/{side}_foot_collision"
        half = mj_model.geom(box).size
        np.testing.assert_allclose(2.0 * half[:2], (description.sole_length, description.sole_width), atol=1e-12)
        np.testing.assert_allclose(mj_data.geom(box).xpos - site.xpos, (0.0, 0.0, half[2]), atol=1e-12)


def test_depth_camera_looks_47_degrees_below_the_horizon_from_above_one_metre(models):
    physics = models[0]
    mj_data = physics.data.ptr
    description = RobotDescription()
    physics.reset()
    mj_data.qpos[2] = _WALKING_PELVIS_HEIGHT
    physics.forward()
    camera, body = mj_data.camera("atlas_class/front"), mj_data.body("atlas_class/torso")
    T_world_camera = Pose(body.xmat.reshape(3, 3), body.xpos) @ description.cameras[0].T_body_camera
    np.testing.assert_allclose(camera.xpos, T_world_camera.p, atol=1e-12)
    # MuJoCo: x right, y up, -z forward.
    np.testing.assert_allclose(camera.xmat.reshape(3, 3) * (1, -1, -1), T_world_camera.R, atol=1e-12)
    assert T_world_camera.p[2] >= 1.05
    assert np.rad2deg(np.arcsin(-T_world_camera.R[2, 2])) == pytest.approx(47.0)
    assert T_world_camera.R[2, 0] == pytest.approx(0.0, abs=1e-12)
    assert T_world_camera.R[2, 1] < 0.0


def test_shapes_are_either_seen_or_touch(models):
    mj_model = models[0].model.ptr
    touches = mj_model.geom_contype > 0
    np.testing.assert_array_equal(mj_model.geom_group[touches], 3)
    np.testing.assert_array_equal(mj_model.geom_group[~touches], 2)


def test_a_camera_on_an_unknown_body_is_refused_by_name():
    with pytest.raises(ValueError, match=r"camera front: got 'neck'"):
        Biped(RobotDescription(cameras=(CameraMount(body="neck"),)))


@pytest.mark.parametrize("cameras", [(), (CameraMount(), CameraMount(yaw_deg=180.0))])
def test_no_camera_and_two_of_one_name_are_refused(cameras):
    with pytest.raises(ValueError, match="needs at least one, each once"):
        Biped(RobotDescription(cameras=cameras))
