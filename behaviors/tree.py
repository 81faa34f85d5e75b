"""A tree that runs: ticked at a fixed rate of the robot's clock, stopped safely by the first fault, and traced.

```python
spec = load_tree("trees/look_and_step.yaml")
tree = Tree(spec, robot)
while tree.outcome is Outcome.RUNNING:
    world.advance(tree.next_tick_time - robot.time)
    tree.tick()
tree.shutdown()
```
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from enum import Enum
from typing import Any

from py_trees.common import Status

from behaviors.blackboard import Blackboard
from behaviors.builder import Layers, SettingError, Settings, build_node, replaced
from behaviors.context import Context, Fault, LogLine, NodeFaultError
from behaviors.executor import Executor, JobRecord
from behaviors.leaf import LeafNode
from behaviors.node import Node
from behaviors.operator import OperatorEvent, OperatorInbox, StopNow
from behaviors.operator.parameter_events import parameter_change
from behaviors.robot import Robot
from behaviors.robot_view import RobotView
from behaviors.safe_stop import SafeStop
from behaviors.spec import TreeSpec
from behaviors.timetable import Timetable
from behaviors.trace import Happened, ParameterChange, Trace
from skills.parameters import ParameterError
from strict_yaml import nearest

DEFAULT_RATE = 50.0


class Outcome(Enum):
    """How a run stands, or how it ended."""

    RUNNING = "running"
    SUCCESS = "success"
    FAILURE = "failure"
    ERROR = "error"
    STOPPED = "stopped"


@dataclass(frozen=True, slots=True)
class Transition:
    """A node whose status changed in a tick.

    Attributes:
        path: the node.
        before, after: its status.
        reason: what the node says about it; may be empty.
    """

    path: str
    before: Status
    after: Status
    reason: str


class Tree:
    """A tree joined to a robot.

    Attributes:
        spec: the tree as its file describes it.
        context: what its leaves share.
        blackboard: values by key.
        root, safe_stop: the nodes; safe stop is None where the file has none.
        nodes: all nodes, parents before children, the safe stop's last.
        outcome: how the run stands.
        reason: why it ended; empty while it runs.
        trace: hash and file of the run.
        inbox: takes events of the operator from any thread; the next tick takes them out.
        layers: where the parameters of nodes come from.
        transitions: statuses that the last tick changed, in the order of `nodes`.
        timetable: when ticks are due, and how late the last one was.
    """

    def __init__(
        self,
        spec: TreeSpec,
        robot: Robot,
        *,
        rate: float = DEFAULT_RATE,
        executor: Executor | None = None,
        parameters: dict[str, Any] | None = None,
        fixed: Collection[str] = (),
        defaults: Settings | None = None,
        settings: Settings | None = None,
        trace: Trace | None = None,
        inbox: OperatorInbox | None = None,
    ) -> None:
        """Build the nodes; nothing is ticked yet.

        Args:
            spec: the tree.
            robot: whom it moves.
            rate: ticks per second of robot time [1/s].
            executor: computes for the leaves; one in lockstep where None.
            parameters: of the skills, by subject.
            fixed: subjects that are taken when a run begins, so that a later change would have no effect.
            defaults: parameters of nodes by kind, below those that the file gives.
            settings: parameters of nodes by path, above those that the file gives.
            trace: takes the ticks; one without a file where None.
            inbox: takes events of the operator; one of its own where None.

        Raises:
            SettingError: where settings name a node or parameter that is not there.
            ParameterError: where a setting is out of range.
        """
        self.timetable = Timetable(rate)
        self.context = Context(RobotView(robot), executor or Executor(), dict(parameters or {}))
        self.trace = trace or Trace()
        self.inbox = inbox or OperatorInbox()
        self._fixed = fixed
        self.transitions: tuple[Transition, ...] = ()
        self._delivered: tuple[str, ...] = ()
        self._pending_inputs: list[tuple[str, Any]] = []
        self._inputs: tuple[tuple[str, Any], ...] = ()
        self._changes: list[ParameterChange] = []
        self._ticks = 0
        self._build(spec, Layers(defaults or {}, settings or {}))

    def _build(self, spec: TreeSpec, layers: Layers) -> None:
        """Make the nodes and the blackboard; all that a run has besides stays as it is."""
        layers.check_targets(spec)
        self.spec = spec
        self.layers = layers
        self.blackboard = Blackboard()
        for key, declared in spec.keys.items():
            self.blackboard.slot(key, declared)
        self.root = build_node(spec.root, self.context, self.blackboard, spec, layers)
        stop = spec.safe_stop
        self.safe_stop = None if stop is None else build_node(stop, self.context, self.blackboard, spec, layers)
        self.nodes: tuple[Node, ...] = self.root.nodes + (() if self.safe_stop is None else self.safe_stop.nodes)
        self.outcome = Outcome.RUNNING
        self.reason = ""
        self._slots = self.blackboard.slots
        self._nodes_by_path = {node.path: node for node in self.nodes}
        self._statuses = [node.status for node in self.nodes]
        self._is_set_up = False
        self._stop = SafeStop(self.safe_stop, self.context)
        self._is_traced = False

    def reload(self, spec: TreeSpec) -> None:
        """Let another tree take over between two ticks: what runs is stopped, once, and the new one begins.

        Settings of nodes that it has not are dropped; what was changed live is forgotten. The trace goes on.

        Raises:
            SettingError, ParameterError: where a setting does not fit any more; the old tree stays.
        """
        paths = {node.path for node in spec}
        settings = {path: values for path, values in self.layers.settings.items() if path in paths}
        layers = Layers(self.layers.defaults, settings)
        for node in spec:
            layers.parameters(node)
        self.root.stop(Status.INVALID)
        if self.safe_stop is not None:
            self.safe_stop.stop(Status.INVALID)
        self._build(spec, layers)

    @property
    def pending_events(self) -> tuple[OperatorEvent, ...]:
        """What the operator did that the next tick will see."""
        return self.inbox.waiting

    @property
    def next_tick_time(self) -> float:
        """Robot time at which the next tick is due [s]."""
        return self.timetable.next_time(self.context.robot.robot.time)

    @property
    def faults(self) -> tuple[Fault, ...]:
        """All exceptions so far."""
        return tuple(self.context.faults)

    def node(self, path: str) -> Node:
        """The node of a path.

        Raises:
            LookupError: where there is none.
        """
        if path not in self._nodes_by_path:
            raise LookupError(f'no node "{path}"{nearest(path, self._nodes_by_path)}')
        return self._nodes_by_path[path]

    def set_input(self, key: str, value: Any) -> None:
        """Put a value that comes from outside on the blackboard at the next tick; None takes it away.

        Raises:
            SettingError: where the tree has no such input.
            PortTypeError: where the value is not of the input's type.
        """
        if key not in self.spec.inputs:
            raise SettingError(f'tree "{self.spec.name}" has no input "{key}"{nearest(key, self.spec.inputs)}')
        self.blackboard.slot(key, None).check(value)
        self._pending_inputs.append((key, value))

    def send(self, event: OperatorEvent) -> None:
        """Let an operator's event take effect at the next tick; from any thread."""
        self.inbox.put(event)

    def set_parameter(self, target: str, key: str, value: Any) -> None:
        """Change one parameter between two ticks.

        Args:
            target: a node's path, or a subject of the skills' parameters.
            key: the parameter.
            value: what it shall be.

        Raises:
            SettingError: where target or key are unknown, or cannot change while the robot walks.
            ParameterError: where the value is out of range.
        """
        subjects = self.context.parameters
        if target in self._fixed:
            raise SettingError(f"{target} is taken when a run begins; it cannot change while the robot walks")
        if target in subjects:
            subjects[target] = replaced(subjects[target], {key: value}, target)
        elif target in self._nodes_by_path:
            node = self._nodes_by_path[target]
            node.set_parameters(replaced(node.parameters, {key: value}, target))
        else:
            raise SettingError(f'no node or subject "{target}"{nearest(target, (*subjects, *self._nodes_by_path))}')
        self._changes.append(ParameterChange(target, key, value))

    def setup(self) -> None:
        """Call the setup hook of every leaf, once; the first tick does it where nobody did before.

        What a hook raises is recorded, and handled by the next tick.
        """
        if self._is_set_up:
            return
        self._is_set_up = True
        for node in self.nodes:
            if isinstance(node, LeafNode):
                node.run_setup()

    def tick(self) -> None:
        """Tick the tree now; after a fault the safe stop, and after the end nothing but the trace."""
        try:
            self._begin_tick()
            self.setup()
            if self.outcome is Outcome.RUNNING and not self.context.faults:
                if any(isinstance(event, StopNow) for event in self.context.operator_events):
                    self._end(Outcome.STOPPED, "stopped by the operator")
                else:
                    self.root.tick_once()
        except NodeFaultError:
            pass
        except Exception as error:
            self.context.record_fault(f"/{self.spec.name}", "tick", error)
        if self.outcome in (Outcome.ERROR, Outcome.STOPPED):
            self._stop.tick()
        elif self.outcome is Outcome.RUNNING:
            self._conclude()
        self._find_transitions()
        self._record_trace()

    def drain_jobs(self) -> tuple[JobRecord, ...]:
        """Accounts of the computations that ended since the last call."""
        return self.context.executor.drain_records()

    def drain_log(self) -> tuple[LogLine, ...]:
        """Lines of the log since the last call."""
        lines, self.context.log_lines = tuple(self.context.log_lines), []
        return lines

    def shutdown(self) -> None:
        """Stop what runs, once, and end the workers and the trace's file."""
        self.root.stop(Status.INVALID)
        if self.safe_stop is not None:
            self.safe_stop.stop(Status.INVALID)
        self.context.executor.shutdown()
        self.trace.close()

    def _begin_tick(self) -> None:
        context = self.context
        context.tick = self._ticks
        self._ticks += 1
        context.robot.begin_tick()
        context.time = context.robot.time
        self.timetable.tick_at(context.time)
        self._take_events()
        self._inputs, self._pending_inputs = tuple(self._pending_inputs), []
        for key, value in self._inputs:
            self.blackboard.slot(key, None).write(value)
        delivered = context.executor.deliver(context.time)
        self._delivered = tuple(job.path for job in delivered)
        for job in delivered:
            if job.digest is not None:
                self.trace.prime(job.result, job.digest)

    def _take_events(self) -> None:
        """What came from the operator: changes of parameters are made, and the rest is shown to the leaves."""
        shown = []
        for event in self.inbox.drain(self.context.time):
            change = parameter_change(event)
            if change is None:
                shown.append(event)
                continue
            try:
                self.set_parameter(*change)
            except (SettingError, ParameterError) as error:
                self.context.log(f'"{event.name}" is refused: {error}', level="warning")
        self.context.begin_tick(tuple(shown))

    def _end(self, outcome: Outcome, reason: str) -> None:
        """Stop what runs, for another reason than that the root is done."""
        self.outcome, self.reason = outcome, reason
        self.root.stop(Status.INVALID)

    def _conclude(self) -> None:
        """End the run where the root is done, or where anything raised in this tick."""
        if self.context.faults:
            self._end(Outcome.ERROR, str(self.context.faults[0]))
            self._stop.tick()
        elif self.root.status is not Status.RUNNING:
            self.outcome = Outcome.SUCCESS if self.root.status is Status.SUCCESS else Outcome.FAILURE
            self.reason = self.root.reason

    def _find_transitions(self) -> None:
        transitions = []
        for index, node in enumerate(self.nodes):
            before = self._statuses[index]
            if node.status is not before:
                transitions.append(Transition(node.path, before, node.status, node.reason))
                self._statuses[index] = node.status
        self.transitions = tuple(transitions)

    def _record_trace(self) -> None:
        changes, self._changes = tuple(self._changes), []
        context = self.context
        happened = Happened(context.operator_events, changes, self._inputs, self._delivered)
        try:
            if not self._is_traced:
                self._is_traced = True
                self.trace.begin(self.spec, 1.0 / self.timetable.period, self.nodes, self._slots)
            self.trace.record(context.tick, context.time, self.nodes, self._slots, context.robot, happened)
        except Exception as error:
            context.record_fault(f"/{self.spec.name}", "trace", error)
            if self.outcome is not Outcome.ERROR:
                self._conclude()
