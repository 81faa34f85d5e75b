"""The robot as all leaves of one tick see it: one snapshot of its state, and a list of the commands sent to it."""

from __future__ import annotations

from behaviors.robot import Robot
from skills.footsteps.footstep import Footstep
from skills.geometry.camera import DepthImage
from skills.geometry.lidar import LidarScan
from skills.walking.walking_state import RobotState, StepEvent, WalkingStatus

Command = tuple[str, tuple[Footstep, ...]]


class RobotView:
    """Reads a robot at most once a tick and notes what it is told to do.

    Attributes:
        robot: the robot itself.
        time: robot time at the start of the tick [s].
        events: step events since the last tick, oldest first; drained once, so that no leaf takes them from another.
        commands: names and arguments of the commands sent this tick, in order.
    """

    def __init__(self, robot: Robot) -> None:
        self.robot = robot
        self.time = robot.time
        self.events: tuple[StepEvent, ...] = ()
        self.commands: list[Command] = []
        self._state: RobotState | None = None
        self._status: WalkingStatus | None = None

    def begin_tick(self) -> None:
        """Forget the last tick's snapshot and take the events since."""
        self._state = None
        self._status = None
        self.commands = []
        self.time = self.robot.time
        self.events = self.robot.drain_events()

    def state(self) -> RobotState:
        """The estimated state of this tick."""
        if self._state is None:
            self._state = self.robot.state()
        return self._state

    def status(self) -> WalkingStatus:
        """What the walking controller was doing when this tick began to look."""
        if self._status is None:
            self._status = self.robot.status()
        return self._status

    def depth_image(self) -> DepthImage | None:
        """The newest depth image; None before the first."""
        return self.robot.depth_image()

    def lidar_scan(self) -> LidarScan | None:
        """The newest lidar scan; None before the first."""
        return self.robot.lidar_scan()

    def send_footsteps(self, steps: tuple[Footstep, ...]) -> None:
        """Replace all queued steps; the step whose swing is under way goes on."""
        self.commands.append(("send_footsteps", steps))
        self.robot.send_footsteps(steps)

    def pause_walking(self) -> None:
        """Finish the current step, then stand; queued steps are dropped."""
        self.commands.append(("pause_walking", ()))
        self.robot.pause_walking()
