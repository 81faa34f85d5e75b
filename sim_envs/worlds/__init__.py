"""Worlds: a course and a robot on it, which behaviors can drive, look out of, and fall in."""

from sim_envs.worlds.arena import CourseArena
from sim_envs.worlds.depth_cameras import DepthCameras
from sim_envs.worlds.falls import FallDetector, FallParameters
from sim_envs.worlds.kinematic_body import KinematicBody, KinematicParameters
from sim_envs.worlds.physics_body import PhysicsBody, PhysicsParameters
from sim_envs.worlds.sensor_frames import SensorFrames
from sim_envs.worlds.simulated_world import SimulatedWorld, WorldKind, WorldParameters
from sim_envs.worlds.state_drift import StateDrift, StateDriftParameters

__all__ = [
    "CourseArena",
    "DepthCameras",
    "FallDetector",
    "FallParameters",
    "KinematicBody",
    "KinematicParameters",
    "PhysicsBody",
    "PhysicsParameters",
    "SensorFrames",
    "SimulatedWorld",
    "StateDrift",
    "StateDriftParameters",
    "WorldKind",
    "WorldParameters",
]
