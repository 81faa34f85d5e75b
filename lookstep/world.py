"""A course and a configuration -> the simulated world in which a robot walks, and what an operator does to it."""

from __future__ import annotations

from behaviors import Context
from behaviors.operator import MoveBox
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


def change_world(world: SimulatedWorld, context: Context) -> None:
    """Do what the operator did to the world in the tick that has just ended; what cannot be is told in the log."""
    for event in context.operator_events:
        if isinstance(event, MoveBox):
            try:
                world.move_box(event.box, event.T_world_box)
            except ValueError as error:
                context.log(f'"{event.name}" is refused: {error}', level="warning")


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
