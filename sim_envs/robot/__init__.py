"""Robots: each one MJCF file for MuJoCo and pinocchio, and a table of what else to know."""

from sim_envs.robot.biped import Biped
from sim_envs.robot.configuration import (
    configuration_from_qpos,
    pelvis_pose,
    qpos_from_configuration,
    qvel_from_velocity,
    velocity_from_qvel,
)
from sim_envs.robot.robot_description import SHIPPED_ROBOTS, CameraMount, RobotDescription

__all__ = [
    "SHIPPED_ROBOTS",
    "Biped",
    "CameraMount",
    "RobotDescription",
    "configuration_from_qpos",
    "pelvis_pose",
    "qpos_from_configuration",
    "qvel_from_velocity",
    "velocity_from_qvel",
]
