"""A robot whose walk is said beforehand, and trees of the shipped leaves on it; nothing is walked, seen or searched."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from behaviors import Status, Tree, parse_tree
from behaviors.operator import ReviewParameters, SendGoal
from skills.body_path import (
    BodyPath,
    BodyPathParameters,
    Goal,
    ImpassabilityParameters,
    SubGoalParameters,
    straight_path,
)
from skills.footsteps import (
    Footstep,
    FootstepParameters,
    FootstepPlan,
    PlanOutcome,
    Side,
    Stance,
    TerrainParameters,
)
from skills.geometry import DepthImage, LidarScan, PinholeCamera, Pose, SpinningLidar
from skills.height_map import HeightMap, HeightMapParameters, ScanAccount
from skills.regions import MemoryParameters, PlanarRegion, PlanarRegions, RegionParameters, RegistrationParameters
from skills.walking import RobotState, StepEvent, WalkingPhase, WalkingStatus

PERIOD = 0.02
SWING, TRANSFER = 1.2, 0.8
PARAMETERS: Mapping[str, Any] = {
    "regions": RegionParameters(),
    "region_memory": MemoryParameters(),
    "height_map": HeightMapParameters(),
    "registration": RegistrationParameters(),
    "body_path": BodyPathParameters(),
    "sub_goal": SubGoalParameters(),
    "footsteps": FootstepParameters(),
    "terrain": TerrainParameters(),
    "impassability": ImpassabilityParameters(),
    "review": ReviewParameters(body_path=False, footsteps=False),
}
_LIDAR = SpinningLidar(3, 4, 0.5, -0.5)
_CAMERA = PinholeCamera(4, 3, 2.0, 2.0, 1.5, 1.0)
_SOLE = np.array([[0.13, 0.069], [-0.13, 0.069], [-0.13, -0.069], [0.13, -0.069]])


class WalkingRobot:
    """Is doing what it was last told: `stand`, `transfer`, `swing`, `settle` or `fall`.

    Attributes:
        time: robot time, moved by hand [s].
        frame_id: of the newest depth image; None before the first.
        scan_id: of the newest lidar scan; None before the first.
        queue: what it was sent and has not dropped.
        commands: names of the commands so far.
    """

    def __init__(self) -> None:
        self.time = 0.0
        self.frame_id: int | None = None
        self.scan_id: int | None = None
        self.queue: tuple[Footstep, ...] = ()
        self.commands: list[str] = []
        self._feet = feet_at(0.0)
        self.stand()

    def stand(self, x: float = 0.0, last: Footstep | None = None) -> None:
        """On both feet beside each other, after the step `last`."""
        self._feet = feet_at(x)
        self._say(WalkingPhase.STANDING, None, last, 0.0, 0.0)

    def transfer(self, step: Footstep) -> None:
        """Shifting weight for a step."""
        self._say(WalkingPhase.TRANSFER, step, step, 0.0, TRANSFER)

    def swing(self, step: Footstep, elapsed: float = 0.0, queue: tuple[Footstep, ...] = ()) -> None:
        """In the air with a step."""
        self._say(WalkingPhase.SWING, step, step, elapsed, SWING)
        self._status = replace(self._status, queue=queue)

    def settle(self, last: Footstep) -> None:
        """In the double support after a step that none follows."""
        self._feet = self._feet.with_sole(last.side, last.T_world_sole)
        self._say(WalkingPhase.TRANSFER, None, last, 0.0, TRANSFER)

    def fall(self) -> None:
        """Down, from whatever it was doing."""
        self._status = replace(self._status, phase=WalkingPhase.FALLEN, failure="the left sole swung into the ground")

    def disable(self) -> None:
        """Out of control of walking."""
        self._status = replace(self._status, phase=WalkingPhase.DISABLED, failure="motors off")

    def state(self) -> RobotState:
        zeros = np.zeros(23)
        return RobotState(self.time, Pose.identity(), zeros, zeros, self._feet, np.zeros(3), np.zeros(3))

    def status(self) -> WalkingStatus:
        return self._status

    def depth_frames(self) -> dict[str, int]:
        return {} if self.frame_id is None else {"front": self.frame_id}

    def depth_image(self, camera: str) -> DepthImage | None:
        if self.frame_id is None:
            return None
        T_world_camera = Pose.from_xyz_rpy((0.0, 0.0, 1.0))
        return DepthImage(np.zeros((3, 4), dtype=np.float32), _CAMERA, T_world_camera, self.time, self.frame_id)

    def lidar_scan(self) -> LidarScan | None:
        if self.scan_id is None:
            return None
        T_world_lidar = Pose.from_xyz_rpy((0.0, 0.0, 1.7))
        return LidarScan(np.zeros((3, 4), dtype=np.float32), _LIDAR, T_world_lidar, self.time, self.scan_id)

    def send_footsteps(self, steps: tuple[Footstep, ...]) -> None:
        self.queue = steps
        self.commands.append("send_footsteps")

    def pause_walking(self) -> None:
        self.queue = ()
        self.commands.append("pause_walking")

    def drain_events(self) -> tuple[StepEvent, ...]:
        return ()

    def drain_log(self) -> tuple[()]:
        return ()

    def _say(
        self, phase: WalkingPhase, step: Footstep | None, last: Footstep | None, elapsed: float, duration: float
    ) -> None:
        stance = self._feet if step is None else self._feet.with_sole(step.side, step.T_world_sole)
        self._status = WalkingStatus(
            phase=phase,
            phase_elapsed=elapsed,
            phase_duration=duration,
            current_step=step,
            queue=(),
            imminent_stance=stance,
            last_side=None if last is None else last.side,
            paused=False,
            last_sequence_id=-1 if last is None else last.sequence_id,
        )


def feet_at(x: float) -> Stance:
    """Both feet beside each other."""
    return Stance(Pose.from_xyz_rpy((x, 0.12, 0.0)), Pose.from_xyz_rpy((x, -0.12, 0.0)))


def step(sequence_id: int, *, x: float = 0.4) -> Footstep:
    """A level step; even ids are left."""
    side = Side.LEFT if sequence_id % 2 == 0 else Side.RIGHT
    pose = Pose.from_xyz_rpy((x, 0.12 * side.sign, 0.0))
    return Footstep(sequence_id, side, pose, _SOLE, SWING, TRANSFER, 0.08, np.empty((0, 3)))


def plan(first: int, count: int = 3, *, plan_id: int = 0) -> FootstepPlan:
    """So many steps from a sequence id on."""
    steps = tuple(step(first + i, x=0.4 * (i + 1)) for i in range(count))
    return FootstepPlan(plan_id, 0, PlanOutcome.ENOUGH_STEPS, "", steps, 1.0, 10)


def blocked_plan() -> FootstepPlan:
    """A plan without steps."""
    return FootstepPlan(0, 0, PlanOutcome.BLOCKED, "no way on: no footholds lead to the sub-goal", (), 0.0, 10)


def ground(time: float = 0.0) -> PlanarRegions:
    """A square metre of level ground, seen at a time."""
    hull = np.array([[0.5, 0.5], [-0.5, 0.5], [-0.5, -0.5], [0.5, -0.5]])
    return PlanarRegions((PlanarRegion(Pose.identity(), hull, (hull,), 1.0, time),), time, 0)


def height_map(heights: NDArray[np.floating] | None = None) -> HeightMap:
    """Ground of 8 x 8 m ahead of the origin, level where no other heights are given."""
    heights = (np.zeros((80, 80)) if heights is None else heights).astype(np.float32)
    filled = np.zeros(heights.shape, dtype=bool)
    variances = np.full_like(heights, 1e-4)
    return HeightMap(heights, variances, filled, 0.1, np.array((-1.0, -4.0)), 0.0, 0, 0.0, ScanAccount())


def path(length: float = 4.0, path_id: int = 0) -> BodyPath:
    """Straight ahead from the origin."""
    return straight_path(np.zeros(3), np.array((length, 0.0, 0.0)), path_id)


def goal(x: float = 4.0) -> SendGoal:
    """The operator sends the robot straight ahead."""
    return SendGoal(Goal(x, 0.0, 0.0))


def tree_of(leaf: str, robot: WalkingRobot, **inputs: Any) -> Tree:
    """One leaf as a whole tree, its inputs given from outside."""
    types = ", ".join(f"{key}: {type(value).__name__}" for key, value in inputs.items())
    ports = f"ports: {{in: {{{types}}}}}, " if inputs else ""
    tree = Tree(parse_tree(f"{{tree: t, {ports}root: {{{leaf}}}}}"), robot, parameters=dict(PARAMETERS))
    for key, value in inputs.items():
        tree.set_input(key, value)
    return tree


def status_and_reason(tree: Tree) -> tuple[Status, str]:
    """How the root stands after the next tick of the robot's clock."""
    tick(tree)
    return tree.root.status, tree.root.reason


def tick(tree: Tree, count: int = 1) -> None:
    """Tick so many times, each when it is due."""
    robot = tree.context.robot.robot
    for _ in range(count):
        robot.time = tree.next_tick_time  # type: ignore[misc]
        tree.tick()
        assert not tree.faults, tree.faults[0].traceback
