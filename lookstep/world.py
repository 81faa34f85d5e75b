"""A course and a configuration -> the simulated world in which a robot walks."""

from __future__ import annotations

from lookstep.configuration import Configuration
from lookstep.errors import UserError
from sim_envs.courses import Course
from sim_envs.worlds import SimulatedWorld, WorldKind
from skills.walking import RobotError


def build_world(course: Course, configuration: Configuration, kind: str, seed: int = 0) -> SimulatedWorld:
    """Put the configured robot at the start of a course; the seed is that of all noise.

    Raises:
        UserError: where the configuration makes no robot that stands there.
    """
    try:
        return _world(course, configuration, kind, seed)
    except RobotError as error:
        raise UserError(f"robot: {error}") from error


def _world(course: Course, configuration: Configuration, kind: str, seed: int) -> SimulatedWorld:
    return SimulatedWorld(
        course,
        WorldKind(kind),
        seed=seed,
        parameters=configuration.world,
        physics=configuration.physics,
        kinematic=configuration.kinematic,
        robot=configuration.robot,
        walker=configuration.walker,
        camera=configuration.camera,
        noise=configuration.noise,
        lidar=configuration.lidar,
        lidar_noise=configuration.lidar_noise,
        falls=configuration.falls,
        drift=configuration.drift,
    )
