"""A robot whose sensors break as they are told to."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, Generic, TypeVar

import numpy as np

from behaviors.faults import Fault, FaultMode, InjectedFaultError
from behaviors.robot import Robot
from skills.footsteps.footstep import Footstep
from skills.geometry.camera import DepthImage
from skills.geometry.lidar import LidarScan
from skills.geometry.pose import Pose
from skills.walking.control_sample import ControlSample
from skills.walking.walking_state import RobotState, StepEvent, WalkingPhase, WalkingStatus

T = TypeVar("T")
Frame = TypeVar("Frame", DepthImage, LidarScan)

_SAYS_SO = "an injected fault says so"
_PHASES = {FaultMode.FALLEN: WalkingPhase.FALLEN, FaultMode.DISABLED: WalkingPhase.DISABLED}


class FaultyRobot:
    """Wraps any robot; commands pass through as they are.

    Args:
        robot: whose sensors break.
        faults: those of sensors; others are not for a robot.
    """

    def __init__(self, robot: Robot, faults: Sequence[Fault]) -> None:
        self.robot = robot

        def of(name: str) -> tuple[Fault, ...]:
            return tuple(fault for fault in faults if fault.at == f"sensor:{name}")

        self._depth_faults = of("depth")
        self._depth: dict[str, _Frames[DepthImage]] = {}
        self._lidar = _Frames(of("lidar"), "scan_id", "ranges")
        self._state = _Reports(of("state"), _break_state)
        self._status = _Reports(of("status"), _break_status)

    @property
    def time(self) -> float:
        """Robot time [s]."""
        return self.robot.time

    def state(self) -> RobotState:
        """The estimate, perhaps an old or a wrong one."""
        return self._state.take(self.robot.time, self.robot.state)

    def status(self) -> WalkingStatus:
        """What the walking controller is doing, perhaps as it was or as it is not."""
        return self._status.take(self.robot.time, self.robot.status)

    def depth_frames(self) -> Mapping[str, int]:
        """Id of the newest image of each depth camera that gets through."""
        frames = self.robot.depth_frames()
        if not self._depth_faults:
            return frames
        images = {camera: self.depth_image(camera) for camera in frames}
        return {camera: image.frame_id for camera, image in images.items() if image is not None}

    def depth_image(self, camera: str) -> DepthImage | None:
        """The newest image of a camera that gets through."""
        frames = self._depth.setdefault(camera, _Frames(self._depth_faults, "frame_id", "depth"))
        return frames.take(self.robot.time, lambda: self.robot.depth_image(camera))

    def lidar_scan(self) -> LidarScan | None:
        """The newest scan that gets through."""
        return self._lidar.take(self.robot.time, self.robot.lidar_scan)

    def send_footsteps(self, steps: tuple[Footstep, ...]) -> None:
        """Replace all queued steps; the step whose swing is under way goes on."""
        self.robot.send_footsteps(steps)

    def pause_walking(self) -> None:
        """Finish the current step, then stand; queued steps are dropped."""
        self.robot.pause_walking()

    def drain_events(self) -> tuple[StepEvent, ...]:
        """Step events since the last call, oldest first."""
        return self.robot.drain_events()

    def drain_log(self) -> tuple[ControlSample, ...]:
        """Control-rate samples since the last call, oldest first."""
        return self.robot.drain_log()


def _active(faults: Sequence[Fault], time: float, mode: FaultMode) -> Fault | None:
    return next((fault for fault in faults if fault.mode is mode and fault.holds(time)), None)


class _Reports(Generic[T]):
    """Estimates of state or status, as of now, of then, or broken."""

    def __init__(self, faults: Sequence[Fault], broken: Callable[[Any, Fault], Any]) -> None:
        self._faults = faults
        self._broken = broken
        self._past: deque[tuple[float, Any]] = deque()
        self._longest = max((fault.by for fault in faults if fault.mode is FaultMode.DELAYED), default=0.0)

    def take(self, time: float, read: Callable[[], T]) -> T:
        if not self._faults:
            return read()
        if _active(self._faults, time, FaultMode.EXCEPTION):
            raise InjectedFaultError("the robot does not answer")
        if _active(self._faults, time, FaultMode.STUCK) and self._past:
            return self._past[-1][1]
        report: Any = read()
        self._past.append((time, report))
        while len(self._past) > 1 and self._past[1][0] <= time - self._longest:
            self._past.popleft()
        delayed = _active(self._faults, time, FaultMode.DELAYED)
        if delayed is not None:
            old = [past for then, past in self._past if then <= time - delayed.by + 1e-9]
            report = old[-1] if old else self._past[0][1]
        for fault in self._faults:
            if fault.holds(time):
                report = self._broken(report, fault)
        return report


def _break_state(state: RobotState, fault: Fault) -> RobotState:
    if fault.mode is FaultMode.WRONG:
        return state.moved(Pose(np.eye(3), np.array(fault.shift)))
    if fault.mode is FaultMode.NAN:
        lost = np.full(3, np.nan)
        return replace(
            state, com_world=lost, dcm_world=lost, joint_positions=np.full_like(state.joint_positions, np.nan)
        )
    return state


def _break_status(status: WalkingStatus, fault: Fault) -> WalkingStatus:
    phase = _PHASES.get(fault.mode)
    return status if phase is None else replace(status, phase=phase, failure=_SAYS_SO)


class _Frames(Generic[Frame]):
    """Images or scans, of which some do not get through, or not as they were.

    Args:
        faults: of this sensor.
        number: name of the field that counts frames.
        content: name of the field that holds the distances.
    """

    def __init__(self, faults: Sequence[Fault], number: str, content: str) -> None:
        self._faults = faults
        self._number = number
        self._content = content
        self._taken: Frame | None = None
        self._given: Frame | None = None
        self._waiting: list[tuple[float, Frame]] = []

    def take(self, time: float, read: Callable[[], Frame | None]) -> Frame | None:
        if not self._faults:
            return read()
        if _active(self._faults, time, FaultMode.EXCEPTION):
            raise InjectedFaultError("the sensor does not answer")
        frame = read()
        if frame is not None and (self._taken is None or self._count(frame) != self._count(self._taken)):
            self._taken = frame
            self._arrive(time, frame)
        due = [waiting for waiting in self._waiting if waiting[0] <= time + 1e-9]
        if due:
            self._given = due[-1][1]
            self._waiting = [waiting for waiting in self._waiting if waiting[0] > time + 1e-9]
        return self._given

    def _arrive(self, time: float, frame: Frame) -> None:
        """A new frame is there: lose it, break it, let it wait, or hand it on."""
        lost = _active(self._faults, time, FaultMode.INTERMITTENT)
        if _active(self._faults, time, FaultMode.OFF) or (
            lost is not None and self._chance(lost, frame).random() < lost.share
        ):
            return
        if _active(self._faults, time, FaultMode.STUCK) and self._given is not None:
            frame = replace(frame, **{self._content: getattr(self._given, self._content)})
        wrong = _active(self._faults, time, FaultMode.WRONG)
        if wrong is not None:
            frame = replace(frame, **{self._content: getattr(frame, self._content) * np.float32(wrong.scale)})
        nan = _active(self._faults, time, FaultMode.NAN)
        if nan is not None:
            values = getattr(frame, self._content).copy()
            values[self._chance(nan, frame).random(values.shape) < nan.share] = np.nan
            frame = replace(frame, **{self._content: values})
        delayed = _active(self._faults, time, FaultMode.DELAYED)
        self._waiting.append((time + (delayed.by if delayed is not None else 0.0), frame))

    def _chance(self, fault: Fault, frame: Frame) -> np.random.Generator:
        """A frame's own generator, so that its fate does not depend on which frames were looked at before."""
        return np.random.default_rng((fault.seed, self._count(frame)))

    def _count(self, frame: Frame) -> int:
        return getattr(frame, self._number)
