"""What the panel is shown of one moment: frozen, made of references to values that nobody changes any more."""

from __future__ import annotations

import dataclasses
import pickle
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from behaviors import LogLine
from behaviors.operator import ReviewRequest
from lookstep.pace import PaceState
from sim_envs.courses import Box
from sim_envs.robot import RobotDescription
from skills.body_path import BodyPath, Goal, SubGoal
from skills.footsteps import FootstepPlan
from skills.geometry import LidarScan
from skills.height_map import HeightMap
from skills.regions import GroundUpdate, PlanarRegions, RegionExtraction
from skills.walking import ControlSample, RobotState, WalkingStatus

BoxPose = tuple[tuple[float, ...], tuple[float, ...]]

# Types of port values that are shown; of each the newest, whichever port it is on.
SHOWN = (Goal, BodyPath, SubGoal, FootstepPlan, PlanarRegions, GroundUpdate, HeightMap, RegionExtraction)


@dataclass(frozen=True, slots=True, eq=False)
class Stage:
    """What stays as it is during a run.

    Attributes:
        title: what runs, in one line.
        robot: its table.
        joint_names: in the order of joint positions.
        boxes: of the course; empty where there is no simulation.
        simulated: whether a simulation can be paced and its boxes moved.
        fixed: subjects of parameters that cannot change now.
        depths: of each node in the tree by path.
        kinds: of each node by path.
        plan_log: folder of the log of plans; empty where none is kept.
        start: x, y, yaw at which the robot began.
    """

    title: str
    robot: RobotDescription
    joint_names: tuple[str, ...]
    boxes: tuple[Box, ...]
    simulated: bool
    fixed: tuple[str, ...]
    depths: Mapping[str, int]
    kinds: Mapping[str, str]
    plan_log: str
    start: tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class NodeState:
    """A node of the tree after a tick.

    Attributes:
        path: the node.
        status: "running", "success", "failure" or "idle".
        reason: what it says.
        visited: whether the last tick came to it.
    """

    path: str
    status: str
    reason: str
    visited: bool


@dataclass(frozen=True, slots=True)
class PlanTime:
    """How long a computation took.

    Attributes:
        kind: of the leaf.
        time: robot time at its end [s].
        used, budget: compute time, and what it may be [s].
        margin: robot time left before the step lands for which it was made; None where there was none [s].
    """

    kind: str
    time: float
    used: float
    budget: float
    margin: float | None


@dataclass(frozen=True, slots=True, eq=False)
class Snapshot:
    """One moment.

    Attributes:
        stage: what stays as it is.
        time: robot time [s].
        rate: robot time per wall time, of late.
        pace: how the simulation is paced.
        state, status: the robot's estimate of its state, and what its controller does.
        balance: newest line of the control-rate log; None before the first.
        boxes: poses of the course's boxes.
        values: newest port value of each type that is shown, by the name of the type.
        scan: newest lidar scan.
        reviews: what waits for approval.
        halts: why the robot is held, in words.
        paused: whether the operator has paused the walk.
        nodes: all nodes of the tree.
        parameters: typed parameters, by subject and by path of node.
        approved: sequence ids of steps in plans that an operator approved.
        times: the last computations.
        dcm_errors: (time, error) of late [s, m].
        steps: steps completed.
        lines: the last lines for the operator.
        link_lost: whether the operator's link is lost.
        outcome: how the run stands, in words; empty while it goes on.
    """

    stage: Stage
    time: float
    rate: float
    pace: PaceState
    state: RobotState
    status: WalkingStatus
    balance: ControlSample | None
    boxes: Mapping[str, BoxPose]
    values: Mapping[str, Any]
    scan: LidarScan | None
    reviews: tuple[ReviewRequest, ...]
    halts: tuple[str, ...]
    paused: bool
    nodes: tuple[NodeState, ...]
    parameters: Mapping[str, Any]
    approved: frozenset[int]
    times: tuple[PlanTime, ...]
    dcm_errors: tuple[tuple[float, float], ...]
    steps: int
    lines: tuple[LogLine, ...]
    link_lost: bool
    outcome: str

    def value(self, kind: type) -> Any:
        """The newest port value of a type; None where there is none."""
        return self.values.get(kind.__name__)


class SnapshotWriter:
    """Writes snapshots as bytes, each by what is new since the one before."""

    def __init__(self) -> None:
        self._sent: dict[str, Any] = {}

    def write(self, snapshot: Snapshot) -> bytes:
        """What `SnapshotReader` makes the same snapshot from, after all that were written before."""
        parts = _parts(snapshot)
        new = {key: part for key, part in parts.items() if key not in self._sent or self._sent[key] is not part}
        self._sent.update(new)
        return pickle.dumps(new, protocol=5)


class SnapshotReader:
    """Reads what a `SnapshotWriter` wrote, without leaving anything out."""

    def __init__(self) -> None:
        self._parts: dict[str, Any] = {}

    def read(self, data: bytes) -> Snapshot:
        """The snapshot; equal values of two snapshots are one object."""
        self._parts.update(pickle.loads(data))
        fields = {key: part for key, part in self._parts.items() if not key.startswith(_VALUE)}
        values = {key.removeprefix(_VALUE): part for key, part in self._parts.items() if key.startswith(_VALUE)}
        return Snapshot(**fields, values={key: part for key, part in values.items() if part is not None})


_VALUE = "values."


def _parts(snapshot: Snapshot) -> dict[str, Any]:
    """Fields by name, and each port value by itself; a type without a value says so."""
    parts = {field.name: getattr(snapshot, field.name) for field in dataclasses.fields(snapshot)}
    values = parts.pop("values")
    return parts | {f"{_VALUE}{kind.__name__}": values.get(kind.__name__) for kind in SHOWN}
