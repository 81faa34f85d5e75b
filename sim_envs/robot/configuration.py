"""The border between pinocchio's coordinates, which the skills use, and MuJoCo's, which the simulation uses.

A configuration is q = (position 3, quaternion xyzw 4, joints); MuJoCo's qpos has the quaternion as wxyz. A velocity is
v = (linear, angular, joints) with both parts in the pelvis frame; MuJoCo's qvel has the linear part in the world. The
joints have the same order in both because both read it from one MJCF file.
"""

import numpy as np

from skills.geometry.pose import Array, Pose

_XYZW_TO_WXYZ = np.array([0, 1, 2, 6, 3, 4, 5])
_WXYZ_TO_XYZW = np.array([0, 1, 2, 4, 5, 6, 3])


def qpos_from_configuration(q: Array) -> Array:
    """MuJoCo's qpos (7 + n) of a pinocchio configuration (7 + n)."""
    qpos = np.array(q, dtype=np.float64)
    qpos[:7] = q[_XYZW_TO_WXYZ]
    return qpos


def configuration_from_qpos(qpos: Array) -> Array:
    """Pinocchio's configuration (7 + n) of MuJoCo's qpos (7 + n)."""
    q = np.array(qpos, dtype=np.float64)
    q[:7] = qpos[_WXYZ_TO_XYZW]
    return q


def velocity_from_qvel(q: Array, qvel: Array) -> Array:
    """Pinocchio's velocity (6 + n) at a pinocchio configuration (7 + n) of MuJoCo's qvel (6 + n)."""
    v = np.array(qvel, dtype=np.float64)
    v[:3] = pelvis_pose(q).R.T @ qvel[:3]
    return v


def qvel_from_velocity(q: Array, v: Array) -> Array:
    """MuJoCo's qvel (6 + n) of a pinocchio velocity (6 + n) at a pinocchio configuration (7 + n)."""
    qvel = np.array(v, dtype=np.float64)
    qvel[:3] = pelvis_pose(q).R @ v[:3]
    return qvel


def pelvis_pose(q: Array) -> Pose:
    """T_world_pelvis of a pinocchio configuration."""
    return Pose.from_quaternion_xyzw(q[3:7], q[:3])
