"""A simulated world: a course, a robot on it that walks over footsteps, and the sensors that it looks with.

The robot's body is one of two, with the same walking controller: under physics torques move it, and in the kinematic
world the accelerations that the controller commands come true. Falls are called by the true ground in both.
"""

# mujoco keeps its types in binary modules without stubs.
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from dataclasses import replace
from enum import Enum
from typing import Any

import mujoco
import numpy as np
from dm_control import mjcf

from sim_envs.courses import Course, Ground
from sim_envs.robot import Biped, RobotDescription
from sim_envs.sensors import (
    DepthCameraParameters,
    DepthNoise,
    Lidar,
    LidarNoise,
    LidarParameters,
    own_body,
)
from sim_envs.worlds.arena import CourseArena
from sim_envs.worlds.box_motion import BoxMotions
from sim_envs.worlds.depth_cameras import DepthCameras
from sim_envs.worlds.falls import FallDetector, FallParameters
from sim_envs.worlds.kinematic_body import KinematicBody, KinematicParameters
from sim_envs.worlds.physics_body import PhysicsBody, PhysicsParameters
from sim_envs.worlds.sensor_frames import SensorFrames
from sim_envs.worlds.state_drift import StateDrift, StateDriftParameters
from skills.footsteps.footstep import Footstep, Side, Stance
from skills.geometry.camera import DepthImage
from skills.geometry.lidar import LidarScan
from skills.geometry.pose import Array, Pose
from skills.parameters import parameter, parameters
from skills.walking import RobotError, RobotModel, Walker, WalkerParameters
from skills.walking.control_sample import ControlSample
from skills.walking.walking_state import RobotState, StepEvent, WalkingStatus

_TRAVEL = 0.15  # A robot whose steps lead no farther goes nowhere [m].
_ROUNDING = 1e-9  # Robot time is a sum of floats; what is due this soon is due now [s].


class WorldKind(Enum):
    """How the robot's body moves."""

    PHYSICS = "physics"
    KINEMATIC = "kinematic"


@parameters
class WorldParameters:
    """Where the robot starts."""

    stance_width: float = parameter(
        0.24, unit="m", minimum=0.15, maximum=0.6, meaning="distance between the soles' centres at the start"
    )


class SimulatedWorld:
    """A robot on a course.

    Args:
        course: the ground; the robot starts at its start.
        kind: how its body moves.
        seed: of the noise.

    Raises:
        RobotError: where there is no such robot, or no ground under a foot at the start.
    """

    def __init__(
        self,
        course: Course,
        kind: WorldKind = WorldKind.KINEMATIC,
        *,
        seed: int = 0,
        parameters: WorldParameters | None = None,
        physics: PhysicsParameters | None = None,
        kinematic: KinematicParameters | None = None,
        robot: RobotDescription | None = None,
        walker: WalkerParameters | None = None,
        camera: DepthCameraParameters | None = None,
        noise: DepthNoise | None = None,
        lidar: LidarParameters | None = None,
        lidar_noise: LidarNoise | None = None,
        falls: FallParameters | None = None,
        drift: StateDriftParameters | None = None,
    ) -> None:
        self.course = course
        self.kind = kind
        self.parameters = parameters or WorldParameters()
        self.robot = robot or RobotDescription()
        self._box_poses = {box.name: box.T_world_box for box in course.boxes}
        self._told_box_poses = {box.name: _as_tuples(box.T_world_box) for box in course.boxes}
        self._ground: Ground | None = None
        self._motions = BoxMotions(course.events)

        self._arena, self._biped = CourseArena(course), Biped(self.robot)
        self._arena.add_free_entity(self._biped)
        self.physics = mjcf.Physics.from_mjcf_model(self._arena.mjcf_model)
        body = own_body(self.model, self._index(self._biped.pelvis))
        mounts = list(zip(self.robot.cameras, map(self._index, self._biped.camera_bodies), strict=True))
        self._cameras = DepthCameras(
            self.model, mounts, camera or DepthCameraParameters(), noise or DepthNoise(), seed=seed, body=body
        )
        self._lidar = Lidar(self.model, lidar or LidarParameters(), lidar_noise or LidarNoise(), seed=seed, body=body)
        self._scans = SensorFrames(self._lidar, self._index(self._biped.lidar_body), self.robot.T_body_lidar)

        self._true_state: RobotState | None = None
        model = self._model = RobotModel(
            self.robot.mjcf_path, self.robot.sole_length, self.robot.sole_width, self.robot.torso_body
        )
        physics, kinematic = physics or PhysicsParameters(), kinematic or KinematicParameters()
        walker = walker or WalkerParameters()
        if kind is WorldKind.KINEMATIC:
            whole_body = replace(walker.whole_body, stance_stiffness=kinematic.stance_stiffness)
            walker = replace(walker, whole_body=whole_body)
        self._walker = Walker(model, self._start_stance(), walker)
        self._body = self._make_body(model, physics, kinematic, seed)
        self._falls = FallDetector(falls or FallParameters(), self.robot)
        self._drift = StateDrift(drift or StateDriftParameters())
        self._asked_time = 0.0
        self._place_shapes()
        self._look()

    @property
    def time(self) -> float:
        """Robot time [s]."""
        return self._body.time

    @property
    def model(self) -> mujoco.MjModel:
        """The compiled model, for renderers."""
        return self.physics.model.ptr

    @property
    def joint_names(self) -> tuple[str, ...]:
        """The robot's joints, in the order of torques and joint positions."""
        return self._model.joint_names

    @property
    def ground(self) -> Ground:
        """The true ground, its boxes where they are now."""
        if self._ground is None:
            self._ground = Ground(self.course.boxes, tuple(self._box_poses.values()))
        return self._ground

    @property
    def depth_cameras(self) -> DepthCameras:
        """The simulated depth cameras."""
        return self._cameras

    @property
    def lidar(self) -> Lidar:
        """The simulated lidar."""
        return self._lidar

    def state(self) -> RobotState:
        """The robot's estimate of its state."""
        return self._drift.estimated_state(self.true_state())

    def true_state(self) -> RobotState:
        """The state without estimation error."""
        if self._true_state is None:
            self._true_state = self._model.state(self.time, *self._body.true_configuration(), self._walker.omega)
        return self._true_state

    def status(self) -> WalkingStatus:
        """What the walking controller is doing; fallen, and why, once it or the world calls it a fall."""
        return self._drift.estimated_status(self._walker.status())

    def depth_frames(self) -> dict[str, int]:
        """Id of the newest image of each depth camera that has one."""
        return self._cameras.frames()

    def depth_image(self, camera: str) -> DepthImage | None:
        """The newest image of a depth camera, rendered when it is first asked for; None before its first."""
        return self._cameras.newest(camera)

    def lidar_scan(self) -> LidarScan | None:
        """The newest lidar scan, rendered when it is first asked for."""
        return self._scans.newest()

    def send_footsteps(self, steps: tuple[Footstep, ...]) -> None:
        """Replace all queued steps; a robot that has fallen takes none.

        Raises:
            ValueError: where the steps cannot follow the current one; the queue stays as it was.
        """
        self._walker.send(tuple(self._drift.true_step(step) for step in steps))

    def pause_walking(self) -> None:
        """Finish the current step, then stand; queued steps are dropped."""
        self._walker.pause()

    def drain_events(self) -> tuple[StepEvent, ...]:
        """Step events since the last call, oldest first."""
        return tuple(self._drift.estimated_event(event) for event in self._walker.drain_events())

    def drain_log(self) -> tuple[ControlSample, ...]:
        """Control-rate samples since the last call, oldest first."""
        return tuple(self._drift.estimated_sample(sample) for sample in self._walker.drain_log())

    def advance(self, duration: float) -> None:
        """Let robot time run on, by whole control steps; what is left of the duration counts next time [s]."""
        self._asked_time += duration
        while self._body.next_time <= self._asked_time + _ROUNDING:
            self._control_step()
        self._place_shapes()

    def push(self, force_world: Array) -> None:
        """Push the pelvis with a force (3,) [N] until told otherwise; zero ends it.

        Raises:
            ValueError: in the kinematic world, which knows no forces.
        """
        if self.kind is not WorldKind.PHYSICS:
            raise ValueError(f"the {self.kind.value} world knows no forces, only {WorldKind.PHYSICS.value} does")
        pelvis = self._index(self._biped.pelvis)
        self.physics.data.ptr.xfrc_applied[pelvis, :3] = force_world

    def box_poses(self) -> dict[str, tuple[tuple[float, ...], tuple[float, ...]]]:
        """Position (3) [m] and quaternion wxyz (4) of every box of the course by name."""
        return dict(self._told_box_poses)

    def move_box(self, name: str, T_world_box: Pose) -> None:
        """Put a box elsewhere; the sensors see it there from the next control step on.

        Raises:
            ValueError: where the course has no such box.
        """
        if name not in self._box_poses:
            raise ValueError(f"got box {name!r}, {self.course.name} has {', '.join(self._box_poses)}")
        self._box_poses[name] = T_world_box
        self._told_box_poses[name] = _as_tuples(T_world_box)
        self._ground = None
        self._arena.move_box(self.physics, name, T_world_box)

    def geom_poses(self) -> tuple[Array, Array]:
        """Copies of all shapes' positions (G, 3) [m] and rotations (G, 3, 3) in the world, for renderers."""
        data = self.physics.data.ptr
        return data.geom_xpos.copy(), data.geom_xmat.reshape(-1, 3, 3).copy()

    def _control_step(self) -> None:
        before = self.time
        for name, T_world_box in self._motions.advance(self._body.next_time, self._pelvis, self._box_poses).items():
            self.move_box(name, T_world_box)
        self._body.advance()
        self._true_state = None
        self._drift.advance(self.time, self.time - before, self._pelvis)
        self._check_fall()
        if self._cameras.due(self.time) or self._scans.due(self.time):
            self._place_shapes()
            self._look()

    def _check_fall(self) -> None:
        if not self._walker.fallen and self._falls.due(self.time):
            failure = self._falls.check(self.true_state(), self._walker.status(), self.ground)
            if failure:
                self._walker.fall(failure)

    @property
    def _pelvis(self) -> Array:
        return self.physics.data.ptr.qpos[:3]

    def _start_stance(self) -> Stance:
        """Both feet beside each other on the ground at the course's start."""
        x, y, yaw = self.course.start
        middle = Pose.from_xyz_rpy((x, y, 0.0), (0.0, 0.0, yaw))
        soles = []
        for side in Side:
            p = middle @ np.array((0.0, 0.5 * side.sign * self.parameters.stance_width, 0.0))
            height = self.ground.ground_height(p[None, :2])[0]
            if np.isinf(height):
                raise RobotError(
                    f"course {self.course.name}: there is no ground under the {side.value} foot at the start"
                )
            soles.append(Pose.from_xyz_rpy((p[0], p[1], height), (0.0, 0.0, yaw)))
        return Stance(*soles)

    def _make_body(
        self, model: RobotModel, physics: PhysicsParameters, kinematic: KinematicParameters, seed: int
    ) -> PhysicsBody | KinematicBody:
        data = self.physics.data.ptr
        if self.kind is WorldKind.PHYSICS:
            prefix = f"{self._biped.mjcf_model.model}/"
            return PhysicsBody(self.model, data, self._walker, physics, prefix, seed, self.robot.torso_body)
        return KinematicBody(data, self._walker, model, kinematic, self.robot, lambda: self.ground)

    def _place_shapes(self) -> None:
        mujoco.mj_kinematics(self.model, self.physics.data.ptr)
        mujoco.mj_camlight(self.model, self.physics.data.ptr)

    def _look(self) -> None:
        data, T_estimate_world = self.physics.data.ptr, self._drift.T_estimate_world
        self._cameras.advance(self.time, data, T_estimate_world, self._travel_yaw())
        self._scans.advance(self.time, data, T_estimate_world)

    def _travel_yaw(self) -> float:
        """Where the steps that were sent lead, to the left of where the robot faces [rad]; 0 where nowhere."""
        status = self._walker.status()
        stance = status.imminent_stance
        for step in status.queue:
            stance = stance.with_sole(step.side, step.T_world_sole)
        way = stance.mid_feet[:2] - self._pelvis[:2]
        if np.hypot(*way) < _TRAVEL:
            return 0.0
        return float(np.arctan2(way[1], way[0])) - status.imminent_stance.yaw

    def _index(self, body: mjcf.Element) -> int:
        bound: Any = self.physics.bind(body)
        return int(bound.element_id)


def _as_tuples(T: Pose) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Position and quaternion wxyz of a pose."""
    return tuple(T.p.tolist()), tuple(T.quaternion_wxyz.tolist())
