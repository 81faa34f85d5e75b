"""A course and a configuration -> the simulated world in which a robot walks."""

from __future__ import annotations

from lookstep.configuration import Configuration
from sim_envs.courses import Course
from sim_envs.worlds import KinematicWorld


def build_world(course: Course, configuration: Configuration, seed: int = 0) -> KinematicWorld:
    """Put the configured robot at the start of a course; the seed is that of the sensor noise."""
    return KinematicWorld(
        course,
        seed=seed,
        parameters=configuration.world,
        robot=configuration.robot,
        walking=configuration.walking,
        camera=configuration.camera,
        noise=configuration.noise,
        lidar=configuration.lidar,
        lidar_noise=configuration.lidar_noise,
        falls=configuration.falls,
        drift=configuration.drift,
    )
