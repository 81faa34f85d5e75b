"""The robot as behaviors see it, and what only a simulated world can do besides.

Both are structural protocols: a simulation or a real robot satisfies them without importing this module.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Protocol

from skills.footsteps.footstep import Footstep
from skills.geometry.camera import DepthImage
from skills.geometry.lidar import LidarScan
from skills.geometry.pose import Pose
from skills.walking.control_sample import ControlSample
from skills.walking.walking_state import RobotState, StepEvent, WalkingStatus


class Robot(Protocol):
    """A biped that walks over footsteps and looks at the ground."""

    @property
    def time(self) -> float:
        """Robot time, the only clock of a behavior [s]."""
        ...

    def state(self) -> RobotState:
        """The newest estimate of the robot's state."""
        ...

    def status(self) -> WalkingStatus:
        """What the walking controller is doing."""
        ...

    def depth_frames(self) -> Mapping[str, int]:
        """Id of the newest image of each depth camera, by the camera's name; without those that have none yet."""
        ...

    def depth_image(self, camera: str) -> DepthImage | None:
        """The newest depth image of a camera; None before its first."""
        ...

    def lidar_scan(self) -> LidarScan | None:
        """The newest lidar scan; None before the first."""
        ...

    def send_footsteps(self, steps: tuple[Footstep, ...]) -> None:
        """Replace all queued steps; the step whose swing is under way goes on."""
        ...

    def pause_walking(self) -> None:
        """Finish the current step, then stand; queued steps are dropped."""
        ...

    def drain_events(self) -> tuple[StepEvent, ...]:
        """Step events since the last call, oldest first."""
        ...

    def drain_log(self) -> tuple[ControlSample, ...]:
        """Control-rate samples since the last call, oldest first."""
        ...


class World(Protocol):
    """What a simulation offers beyond its robot."""

    def advance(self, duration: float) -> None:
        """Let robot time run on [s]."""
        ...

    def true_state(self) -> RobotState:
        """The state without estimation error, for the judge and the recording."""
        ...

    def box_poses(self) -> dict[str, tuple[tuple[float, ...], tuple[float, ...]]]:
        """Position (3) [m] and quaternion wxyz (4) of every object of the course by name."""
        ...

    def move_box(self, name: str, T_world_box: Pose) -> None:
        """Put an object of the course elsewhere.

        Raises:
            ValueError: where there is none of this name.
        """
        ...
