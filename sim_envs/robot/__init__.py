"""The robot: an Atlas-class biped as one MJCF file for MuJoCo and pinocchio, and a table of what else to know."""

from sim_envs.robot.biped import Biped
from sim_envs.robot.configuration import pelvis_pose, qpos_from_configuration, qvel_from_velocity
from sim_envs.robot.robot_description import RobotDescription

__all__ = ["Biped", "RobotDescription", "pelvis_pose", "qpos_from_configuration", "qvel_from_velocity"]
