"""A robot that does what a recording did, whatever the tree says: its sensors show again what they showed then.

It wraps the robot of a simulated world that is built as it was for the recording. A command that equals the recorded
one is passed on when it comes; one that does not is noted and dropped, and what the tree leaves out is made up for at
the end of the tick. So the world moves as it did, and every image is rendered as it was.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from behaviors.canonical import encode
from behaviors.robot import Robot
from behaviors.values import from_json
from skills.footsteps.footstep import Footstep
from skills.geometry.camera import DepthImage
from skills.geometry.lidar import LidarScan
from skills.walking.control_sample import ControlSample
from skills.walking.walking_state import RobotState, StepEvent, WalkingStatus


class FollowingRobot:
    """Follows the commands of a recording.

    Attributes:
        robot: the robot that is moved.
        departed: whether the tree has said something else than the recording, ever.
    """

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self.departed = False
        self._due: list[tuple[str, tuple[Footstep, ...]]] = []

    def expect(self, commands: Sequence[dict[str, Any]]) -> None:
        """Say what the recording commands in the tick that begins, as its line has it."""
        self._due = [(command["name"], from_json(command.get("sent", command["value"]))) for command in commands]

    def catch_up(self) -> None:
        """At the end of a tick: do what the tree has left out."""
        self.departed = self.departed or bool(self._due)
        for name, steps in self._due:
            self._do(name, steps)
        self._due = []

    @property
    def time(self) -> float:
        """Robot time [s]."""
        return self.robot.time

    def state(self) -> RobotState:
        """The newest estimate of the robot's state."""
        return self.robot.state()

    def status(self) -> WalkingStatus:
        """What the walking controller is doing."""
        return self.robot.status()

    def depth_frames(self) -> Mapping[str, int]:
        """Id of the newest image of each depth camera that has one, by the camera's name."""
        return self.robot.depth_frames()

    def depth_image(self, camera: str) -> DepthImage | None:
        """The newest depth image of a camera; None before its first."""
        return self.robot.depth_image(camera)

    def lidar_scan(self) -> LidarScan | None:
        """The newest lidar scan; None before the first."""
        return self.robot.lidar_scan()

    def drain_events(self) -> tuple[StepEvent, ...]:
        """Step events since the last call, oldest first."""
        return self.robot.drain_events()

    def drain_log(self) -> tuple[ControlSample, ...]:
        """Control-rate samples since the last call, oldest first."""
        return self.robot.drain_log()

    def send_footsteps(self, steps: tuple[Footstep, ...]) -> None:
        """Pass on what the recording sent as well."""
        self._follow("send_footsteps", steps)

    def pause_walking(self) -> None:
        """Pass on where the recording paused as well."""
        self._follow("pause_walking", ())

    def _follow(self, name: str, steps: tuple[Footstep, ...]) -> None:
        if self._due and self._due[0][0] == name and encode(self._due[0][1]) == encode(steps):
            self._do(*self._due.pop(0))
        else:
            self.departed = True

    def _do(self, name: str, steps: tuple[Footstep, ...]) -> None:
        if name == "send_footsteps":
            self.robot.send_footsteps(steps)
        else:
            self.robot.pause_walking()
