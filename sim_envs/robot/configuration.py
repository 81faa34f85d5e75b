"""The border between pinocchio's coordinates, which the skills use, and MuJoCo's, which the simulation uses.

A configuration is q = (position 3, quaternion xyzw 4, joints); MuJoCo's qpos has the quaternion as wxyz. A velocity is
v = (linear, angular, joints) with both parts in the pelvis frame; MuJoCo's qvel has the linear part in the world. The
joints have the same order in both because both read it from one MJCF file.
"""

import numpy as np

from skills.geometry.pose import Array, Pose

_XYZW_TO_WXYZ = np.array([0, 1, 2, 6, 3, 4, 5])


def qpos_from_configuration(q: Array) -> Array:
    """MuJoCo's qpos (7 + n) of a pinocchio configuration (7 + n)."""
    qpos = np.array(q, dtype=np.float64)
    qpos[:7] = q[_XYZW_TO_WXYZ]
    return qpos


def qvel_from_velocity(q: Array, v: Array) -> Array:
    """MuJoCo's qvel (6 + n) of a pinocchio velocity (6 + n) at a pinocchio configuration (7 + n)."""
    qvel = np.array(v, dtype=np.float64)
    qvel[:3] = pelvis_pose(q).R @ v[:3]
    return qvel


def pelvis_pose(q: Array) -> Pose:
    """T_world_pelvis of a pinocchio configuration."""
    return Pose.from_quaternion_xyzw(q[3:7], q[:3])
