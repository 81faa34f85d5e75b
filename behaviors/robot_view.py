"""The robot as all leaves of one tick see it: one snapshot of its state, and a list of the commands sent to it.

A robot estimates where it is in a frame that drifts, its odometry; leaves work in a world that stays. Whoever finds out
how the two lie to each other says so with `correct`: from then on everything that comes from the robot is moved into
the world here, and every command is moved back.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from behaviors.robot import Robot
from skills.footsteps.footstep import Footstep
from skills.geometry.camera import DepthImage
from skills.geometry.lidar import LidarScan
from skills.geometry.pose import IDENTITY, Pose
from skills.walking.walking_state import RobotState, StepEvent, WalkingPhase, WalkingStatus


@dataclass(frozen=True, slots=True, eq=False)
class Command:
    """What a node told the robot.

    Attributes:
        name: of the robot's method.
        node: path of the node.
        steps: its argument in the world; empty where it takes none.
        sent: the same in the frame of the robot's odometry, as it was sent.
    """

    name: str
    node: str
    steps: tuple[Footstep, ...] = ()
    sent: tuple[Footstep, ...] = ()


class RobotView:
    """Reads a robot at most once a tick and notes what it is told to do.

    Attributes:
        robot: the robot itself.
        time: robot time at the start of the tick [s].
        events: step events since the last tick, oldest first; drained once, so that no leaf takes them from another.
        commands: those sent this tick, in order.
        corrections: nodes that said how the estimate lies in the world this tick, and what they said.
        caller: path of the node that is ticked now.
        T_world_odometry: what takes the robot's estimates into the world.
    """

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self.time = robot.time
        self.events: tuple[StepEvent, ...] = ()
        self.commands: list[Command] = []
        self.corrections: list[tuple[str, Pose]] = []
        self.caller = ""
        self.T_world_odometry = IDENTITY
        self._estimated_state: RobotState | None = None
        self._estimated_status: WalkingStatus | None = None
        self._state: RobotState | None = None
        self._status: WalkingStatus | None = None

    def begin_tick(self) -> None:
        """Take this tick's snapshot and the events since the last one."""
        # Taken now, not when first asked for: what a leaf sees must not depend on who was asked before it.
        self._estimated_state, self._estimated_status = self.robot.state(), self.robot.status()
        self._state = self._status = None
        self.commands = []
        self.corrections = []
        self.time = self.robot.time
        events = self.robot.drain_events()
        self.events = tuple(event.moved(self.T_world_odometry) for event in events) if self._corrected else events

    def correct(self, T_world_odometry: Pose) -> None:
        """Say what takes the robot's estimates into the world from now on, this tick's snapshot included."""
        self.T_world_odometry = T_world_odometry
        self.corrections.append((self.caller, T_world_odometry))
        self._state = self._status = None

    def state(self) -> RobotState:
        """The estimated state of this tick."""
        if self._state is None:
            if self._estimated_state is None:
                self._estimated_state = self.robot.state()
            state = self._estimated_state
            self._state = state.moved(self.T_world_odometry) if self._corrected else state
        return self._state

    def status(self) -> WalkingStatus:
        """What the walking controller was doing when this tick began to look."""
        if self._status is None:
            if self._estimated_status is None:
                self._estimated_status = self.robot.status()
            status = self._estimated_status
            self._status = status.moved(self.T_world_odometry) if self._corrected else status
        return self._status

    def depth_frames(self) -> Mapping[str, int]:
        """Id of the newest image of each depth camera that has one, by the camera's name."""
        return self.robot.depth_frames()

    def depth_image(self, camera: str) -> DepthImage | None:
        """The newest depth image of a camera; None before its first."""
        image = self.robot.depth_image(camera)
        return image.moved(self.T_world_odometry) if image is not None and self._corrected else image

    def lidar_scan(self) -> LidarScan | None:
        """The newest lidar scan; None before the first."""
        scan = self.robot.lidar_scan()
        return scan.moved(self.T_world_odometry) if scan is not None and self._corrected else scan

    def send_footsteps(self, steps: tuple[Footstep, ...]) -> None:
        """Replace all queued steps; the step whose swing is under way goes on."""
        sent = steps
        if self._corrected:
            T_odometry_world = self.T_world_odometry.inverse
            sent = tuple(step.moved(T_odometry_world) for step in steps)
        self.commands.append(Command("send_footsteps", self.caller, steps, sent))
        self.robot.send_footsteps(sent)

    def pause_walking(self) -> None:
        """Finish the current step, then stand; queued steps are dropped."""
        self.commands.append(Command("pause_walking", self.caller))
        self.robot.pause_walking()

    def hold(self) -> None:
        """Let a robot that walks, or is about to, finish its step and stand."""
        status = self.status()
        if status.phase is not WalkingPhase.STANDING or status.queue:
            self.pause_walking()

    @property
    def _corrected(self) -> bool:
        """Without a correction everything passes through as it is."""
        return self.T_world_odometry is not IDENTITY
