"""One trial: the robot walks over known footsteps in a simulated world, and either stands at the end or does not."""

from __future__ import annotations

import dataclasses
import tempfile
import time as clock
import xml.etree.ElementTree as ElementTree
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from lookstep.bench.walking.known_walks import KnownWalk
from lookstep.bench.walking.pushes import Push, force_at
from lookstep.configuration import Configuration
from lookstep.world import build_world
from sim_envs.robot import RobotDescription
from sim_envs.worlds import SimulatedWorld
from skills.walking import StepEventKind, WalkingPhase

_PERIOD = 0.02  # Pushes and events are looked at this often [s].
_SETTLE = 1.5  # A walk counts when the robot then stands for this long [s].
_SLOWEST = 1.6  # times the nominal time
_MARGIN = 8.0  # [s]


@dataclass(frozen=True, slots=True, eq=False)
class Trial:
    """What is tried.

    Attributes:
        case: the case it belongs to.
        seed: of the noise.
        walk: course and steps; without steps the robot stands.
        pushes: at the pelvis.
        physics: settings of physics that differ from the configuration's, which the robot does not know.
        ankle_limit: most negative angle of the ankles' pitch; None for the robot's own [rad].
        world: its kind.
    """

    case: str
    seed: int
    walk: KnownWalk
    pushes: tuple[Push, ...] = ()
    physics: Mapping[str, float] = field(default_factory=dict)
    ankle_limit: float | None = None
    world: str = "physics"


@dataclass(frozen=True, slots=True)
class TrialResult:
    """How a trial went.

    Attributes:
        case, seed: of the trial.
        failure: why it failed, one sentence; empty where the robot made all steps and then stood.
        steps: number of landed steps.
        landing_errors: horizontal distance of each landed sole from its foothold [m].
        dcm_error: largest distance of the DCM from its plan [m].
        duration: robot time [s].
        compute: time of the thread [s].
    """

    case: str
    seed: int
    failure: str
    steps: int
    landing_errors: tuple[float, ...]
    dcm_error: float
    duration: float
    compute: float

    @property
    def ok(self) -> bool:
        """Whether the robot made all steps and then stood."""
        return not self.failure


def run_trial(trial: Trial, configuration: Configuration) -> TrialResult:
    """Walk until the robot stands behind its last step, falls, or takes far too long."""
    with tempfile.TemporaryDirectory() as folder:
        configuration = dataclasses.replace(
            configuration, physics=dataclasses.replace(configuration.physics, **trial.physics)
        )
        if trial.ankle_limit is not None:
            path = Path(folder) / "limited.xml"
            write_limited_robot(path, configuration.robot, trial.ankle_limit)
            configuration = dataclasses.replace(
                configuration, robot=dataclasses.replace(configuration.robot, mjcf=str(path))
            )
        world = build_world(trial.walk.course, configuration, trial.world, trial.seed)
    return _walk(trial, world)


def _walk(trial: Trial, world: SimulatedWorld) -> TrialResult:
    steps = trial.walk.steps
    last = steps[-1].sequence_id if steps else -1
    limit = _SLOWEST * trial.walk.duration + _MARGIN + max((push.start for push in trial.pushes), default=0.0)
    landings: dict[int, float] = {}
    errors: list[float] = []
    dcm_error, rests, failure = 0.0, 0.0, ""
    started = clock.thread_time()
    if steps:
        world.send_footsteps(steps)
    while not failure and rests < _SETTLE:
        if trial.pushes:
            world.push(force_at(trial.pushes, world.time, landings))
        world.advance(_PERIOD)
        for event in world.drain_events():
            if event.kind is StepEventKind.COMPLETED:
                landings[event.step.sequence_id] = event.time
                off = event.T_world_sole.p - event.step.T_world_sole.p
                errors.append(float(np.hypot(off[0], off[1])))
        dcm_error = max(dcm_error, *(sample.dcm_error for sample in world.drain_log()))
        status = world.status()
        pushed = all(world.time > push.began(landings) + push.duration for push in trial.pushes)
        arrived = status.phase is WalkingPhase.STANDING and (last < 0 or last in landings)
        rests = rests + _PERIOD if arrived and pushed else 0.0
        if status.phase is WalkingPhase.FALLEN:
            failure = status.failure
        elif world.time > limit:
            failure = f"not there after {world.time:.0f} s: {status.phase.value}, step {status.last_sequence_id}"
    return TrialResult(
        case=trial.case,
        seed=trial.seed,
        failure=failure,
        steps=len(landings),
        landing_errors=tuple(errors),
        dcm_error=dcm_error,
        duration=world.time,
        compute=clock.thread_time() - started,
    )


def write_limited_robot(path: Path, robot: RobotDescription, limit: float) -> None:
    """Write the robot's MJCF file with another lower limit of its ankles' pitch [rad].

    Raises:
        ValueError: where its joints have other names.
    """
    tree = ElementTree.parse(robot.mjcf_path)
    joints = [joint for joint in tree.iter("joint") if joint.get("name", "").endswith("_ankle_pitch")]
    if not joints:
        raise ValueError(f"{robot.mjcf_path}: has no joint *_ankle_pitch whose limit could be changed")
    for joint in joints:
        joint.set("range", f"{limit} {joint.get('range', '0 0').split()[1]}")
    tree.write(path)
