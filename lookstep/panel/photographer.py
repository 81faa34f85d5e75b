"""Moments of a run -> snapshots for the panel, some ten or twenty a second, made without copying anything."""

from __future__ import annotations

import time as wall
from collections import deque
from collections.abc import Mapping
from typing import Any, Generic, TypeVar

from behaviors import LogLine, Status, Tree
from behaviors.operator import Approve, ResetBehavior
from lookstep.configuration import FIXED_SUBJECTS
from lookstep.moment import Moment
from lookstep.pace import Pace
from lookstep.panel.snapshot import SHOWN, BoxPose, NodeState, PlanTime, Snapshot, Stage
from sim_envs.robot import RobotDescription
from skills.footsteps import FootstepPlan
from skills.geometry import LidarScan
from skills.height_map import HeightMap
from skills.regions import PlanarRegions, RegionExtraction
from skills.walking import StepEventKind

# What is large is shown anew at these periods of robot time; all else whenever it changes [s].
_PERIODS: dict[type, float] = {RegionExtraction: 1.0, PlanarRegions: 0.2, HeightMap: 1.0, LidarScan: 1.0}
Item = TypeVar("Item")
_STATES = {Status.RUNNING: "running", Status.SUCCESS: "success", Status.FAILURE: "failure", Status.INVALID: "idle"}
_LINES, _TIMES, _ERRORS = 60, 200, 200
_ERROR_PERIOD = 0.05
_RATE_WINDOW = 1.0  # wall time over which the rate is taken [s]


class Latest(Generic[Item]):
    """The last things that came.

    Args:
        most: how many are kept.

    Attributes:
        all: the things, oldest first; one object until another comes.
    """

    def __init__(self, most: int) -> None:
        self._most = most
        self.all: tuple[Item, ...] = ()

    def add(self, *things: Item) -> None:
        """Keep these as well."""
        if things:
            self.all = (*self.all, *things)[-self._most :]


class Photographer:
    """Keeps what a snapshot shows of the past, and makes one when asked.

    Args:
        title: what runs, in one line.
        robot: its table.
        pace: of the simulation.
        plan_log: folder of the log of plans; empty where none is kept.
    """

    def __init__(self, title: str, robot: RobotDescription, pace: Pace, plan_log: str = "") -> None:
        self._title, self._robot, self._pace, self._plan_log = title, robot, pace, plan_log
        self._lines: Latest[LogLine] = Latest(_LINES)
        self._times: Latest[PlanTime] = Latest(_TIMES)
        self._errors: Latest[tuple[float, float]] = Latest(_ERRORS)
        self._clock: deque[tuple[float, float]] = deque()
        self._steps = 0
        self._approved: frozenset[int] = frozenset()
        self._shown: dict[type, Any] = {}
        self._next: dict[type, float] = {}
        self._parameters: Mapping[str, Any] = {}
        self._boxes: Mapping[str, BoxPose] = {}
        self._stage: Stage | None = None
        self._spec: Any = None
        self._balance: Any = None

    def notice(self, moment: Moment) -> None:
        """Once a tick: take note of what a snapshot shows of the past."""
        self._lines.add(*moment.log)
        self._steps += sum(event.kind is StepEventKind.COMPLETED for event in moment.events)
        for job in moment.jobs:
            if job.compute_seconds is not None:
                kind = moment.tree.node(job.path).kind
                self._times.add(PlanTime(kind, job.ended, job.compute_seconds, job.budget, job.deadline_margin))
        if moment.samples:
            self._balance = moment.samples[-1]
            if not self._errors.all or moment.time >= self._errors.all[-1][0] + _ERROR_PERIOD:
                self._errors.add((moment.time, max(sample.dcm_error for sample in moment.samples)))
        for event in moment.tree.context.operator_events:
            if isinstance(event, Approve):
                plan = self._shown.get(FootstepPlan)
                if plan is not None and event.checkpoint == "footsteps" and plan.plan_id == event.item_id:
                    self._approved |= {step.sequence_id for step in plan.steps}
            elif isinstance(event, ResetBehavior):
                self._approved = frozenset()
        self._find_values(moment)
        now = wall.monotonic()
        self._clock.append((now, moment.time))
        while now - self._clock[0][0] > _RATE_WINDOW and len(self._clock) > 2:
            self._clock.popleft()

    def take(self, moment: Moment, *, link_lost: bool, outcome: str = "") -> Snapshot:
        """The moment as a snapshot."""
        tree, robot = moment.tree, moment.tree.context.robot
        return Snapshot(
            stage=self._stage_of(moment),
            time=moment.time,
            rate=self._rate(),
            pace=self._pace.state,
            state=robot.state(),
            status=robot.status(),
            balance=None if self._balance is None else self._balance.moved(robot.T_world_odometry),
            boxes=self._boxes_of(moment),
            values={kind.__name__: value for kind, value in self._shown.items() if kind in SHOWN},
            scan=self._shown.get(LidarScan),
            reviews=tuple(tree.context.reviews),
            halts=tuple(halt.reason for halt in tree.context.halts),
            paused=tree.context.paused,
            nodes=tuple(
                NodeState(node.path, _STATES[node.status], node.reason, node.ticked_at == tree.context.tick)
                for node in tree.nodes
            ),
            parameters=self._parameters_of(tree),
            approved=self._approved,
            times=self._times.all,
            dcm_errors=self._errors.all,
            steps=self._steps,
            lines=self._lines.all,
            link_lost=link_lost,
            outcome=outcome,
        )

    def _find_values(self, moment: Moment) -> None:
        """The newest value of each type that is shown; a type whose ports are all empty has none."""
        found: dict[type, list[Any]] = {kind: [] for kind in SHOWN}
        for value in moment.tree.blackboard.values().values():
            if type(value) in found:
                found[type(value)].append(value)
        for kind, values in found.items():
            kept = self._shown.get(kind)
            others = [value for value in values if value is not kept]
            if not values:
                self._shown.pop(kind, None)
            elif others and moment.time >= self._next.get(kind, 0.0):
                self._show(kind, others[-1], moment.time)
        if moment.time >= self._next.get(LidarScan, 0.0):
            self._show(LidarScan, moment.tree.context.robot.lidar_scan(), moment.time)

    def _show(self, kind: type, value: Any, time: float) -> None:
        self._shown[kind] = value
        self._next[kind] = time + _PERIODS.get(kind, 0.0)

    def _stage_of(self, moment: Moment) -> Stage:
        tree, world = moment.tree, moment.world
        if self._stage is None or self._spec is not tree.spec:
            self._spec = tree.spec
            self._stage = Stage(
                title=self._title,
                robot=self._robot,
                joint_names=world.joint_names,
                boxes=world.course.boxes,
                simulated=True,
                fixed=FIXED_SUBJECTS,
                depths={node.path: node.path.count("/") - 1 for node in tree.nodes},
                kinds={node.path: node.kind for node in tree.nodes},
                plan_log=self._plan_log,
                start=world.course.start,
            )
        return self._stage

    def _parameters_of(self, tree: Tree) -> Mapping[str, Any]:
        """One object until one of them changes."""
        now = {**tree.context.parameters}
        now |= {node.path: node.parameters for node in tree.nodes}
        if any(self._parameters.get(key) is not value for key, value in now.items()):
            self._parameters = now
        return self._parameters

    def _boxes_of(self, moment: Moment) -> Mapping[str, BoxPose]:
        """One object until one of them moves."""
        now = moment.world.box_poses()
        if now != self._boxes:
            self._boxes = now
        return self._boxes

    def _rate(self) -> float:
        (wall_then, then), (wall_now, now) = self._clock[0], self._clock[-1]
        return (now - then) / (wall_now - wall_then) if wall_now > wall_then else 0.0
