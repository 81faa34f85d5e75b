"""Worlds: a course and a robot on it, which behaviors can drive, look out of, and fall in."""

from sim_envs.worlds.arena import CourseArena
from sim_envs.worlds.falls import FallDetector, FallParameters
from sim_envs.worlds.kinematic_world import KinematicWorld, KinematicWorldParameters
from sim_envs.worlds.sensor_frames import SensorFrames
from sim_envs.worlds.state_drift import StateDrift, StateDriftParameters

__all__ = [
    "CourseArena",
    "FallDetector",
    "FallParameters",
    "KinematicWorld",
    "KinematicWorldParameters",
    "SensorFrames",
    "StateDrift",
    "StateDriftParameters",
]
