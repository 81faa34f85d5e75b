"""Leaves: where a tree senses, computes and acts.

A leaf is a small class with declared ports and parameters and four hooks. `LeafNode` is the node of the tree that owns
it: it waits for missing inputs, calls the hooks, and makes sure that `stop` is called exactly once where a running leaf
is preempted, and never otherwise.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any, ClassVar

from py_trees.common import Status

from behaviors.blackboard import Slot
from behaviors.context import Context
from behaviors.executor import Job
from behaviors.halt import Halt, HaltCause
from behaviors.node import Node, NoParameters
from behaviors.ports import declared_inputs, declared_outputs
from skills.parameters import parameter, parameters


class Leaf:
    """Something a robot does or finds out; subclasses override the hooks.

    Attributes:
        Parameters: class of the leaf's parameters, decorated with `@parameters`.
        ends_with: the statuses that it can end with, for the check of what can be reached.
        parameters: the leaf's parameters, in range; may change between ticks.
        context: the robot, the clock and the executor.
        node_path: path of the node that owns the leaf.
        reason: why not now, or how it ended, for the operator; emptied before each tick.
        ports: what the ports are wired to, by port name.
        inhibitors: how many inhibitors hold back what this leaf gives; 0 for none.
    """

    Parameters: ClassVar[type] = NoParameters
    ends_with: ClassVar[tuple[Status, ...]] = (Status.SUCCESS, Status.FAILURE)
    parameters: Any

    def __init__(self, path: str, context: Context, parameters: Any, ports: dict[str, Slot]) -> None:
        self.node_path = path
        self.context = context
        self.parameters = parameters
        self.ports = ports
        self.reason = ""
        self.inhibitors = 0

    @classmethod
    def least_duration(cls, parameters: Any) -> float:
        """The least robot time from start to success [s]; 0 where it may succeed in the tick in which it starts."""
        return 0.0

    def setup(self) -> None:
        """Called once before the first tick of the tree."""

    def start(self) -> None:
        """Called before the first `tick` of each activation."""

    def tick(self) -> Status:
        """Do a little and say how it stands; must not block."""
        raise NotImplementedError

    def stop(self) -> None:
        """Called once when the leaf is preempted while it runs; not when it ends by itself."""

    def succeeded(self, reason: str = "") -> Status:
        """SUCCESS, and how."""
        self.reason = reason
        return Status.SUCCESS

    def running(self, reason: str = "") -> Status:
        """RUNNING, and what it waits for."""
        self.reason = reason
        return Status.RUNNING

    def failed(self, reason: str) -> Status:
        """FAILURE, and why."""
        self.reason = reason
        return Status.FAILURE

    def halted(self, cause: HaltCause, reason: str, status: Status = Status.RUNNING) -> Status:
        """A status with which the robot is held, and why; for the operator and the judge."""
        self.context.halts.append(Halt(cause, reason, self.node_path))
        self.reason = reason
        return status

    def log(self, text: str, *, level: str = "info") -> None:
        """Write one line for the operator under the leaf's path."""
        self.context.log(text, path=self.node_path, level=level)


@dataclasses.dataclass(frozen=True, slots=True)
class Call:
    """A pure function of immutable arguments, to be computed by the executor.

    Attributes:
        function: what to compute.
        arguments: its positional arguments.
        budget: robot time until a lockstep result is delivered; the leaf's latency where None [s].
        deadline: robot time at which the result is needed, for the record; None where there is none [s].
    """

    function: Callable[..., Any]
    arguments: tuple[Any, ...]
    budget: float | None = None
    deadline: float | None = None


@parameters
class SkillParameters:
    """What every computing leaf has; a leaf's own `Parameters` extend this class."""

    latency: float = parameter(
        0.2,
        unit="s",
        meaning="robot time until the result is delivered; a computation that takes longer misses its deadline",
        minimum=0.0,
        maximum=60.0,
    )


class SkillLeaf(Leaf):
    """A leaf that computes for longer than a tick: submits when it starts, polls, cancels when it is preempted.

    Attributes:
        slower_by: robot time by which results come later than they would; of an injected fault [s].
    """

    Parameters: ClassVar[type] = SkillParameters

    def __init__(self, path: str, context: Context, parameters: Any, ports: dict[str, Slot]) -> None:
        super().__init__(path, context, parameters, ports)
        self.slower_by = 0.0
        self._job: Job | None = None

    @classmethod
    def least_duration(cls, parameters: Any) -> float:
        """The latency [s]."""
        return parameters.latency

    def request(self) -> Call | Status:
        """What to compute from the inputs as they are now; or a status with a reason, where not now.

        RUNNING asks again at the next tick.
        """
        raise NotImplementedError

    def receive(self, result: Any) -> Status:
        """Hand the result on."""
        raise NotImplementedError

    def call(
        self,
        function: Callable[..., Any],
        *arguments: Any,
        budget: float | None = None,
        deadline: float | None = None,
    ) -> Call:
        """A call of `function(*arguments)`; budget and deadline as in `Call`."""
        return Call(function, arguments, budget, deadline)

    def tick(self) -> Status:
        """Submit, then wait for the result.

        Raises:
            Exception: what the function raised.
        """
        if self._job is None:
            call = self.request()
            if isinstance(call, Status):
                return call
            self._job = self._submit(call)
        job = self._job
        if not job.done:
            return self.running("computing")
        self._job = None
        if job.error is not None:
            raise job.error
        return self.receive(job.result)

    def stop(self) -> None:
        """Drop the computation; its result never arrives."""
        if self._job is not None:
            self.context.executor.cancel(self._job, self.context.time)
            self._job = None

    def _submit(self, call: Call) -> Job:
        budget = self.parameters.latency if call.budget is None else call.budget
        return self.context.executor.submit(
            call.function,
            call.arguments,
            path=self.node_path,
            time=self.context.time,
            budget=budget,
            deadline=call.deadline,
            late=self.slower_by,
        )


class LeafNode(Node):
    """The node of a leaf.

    Attributes:
        leaf: the leaf itself.
        active: whether the leaf has started and neither ended nor been stopped.
    """

    def __init__(self, path: str, context: Context, leaf: Leaf) -> None:
        super().__init__(path, context, leaf.parameters)
        self.leaf = leaf
        self.active = False
        self.kind = type(leaf).__name__
        inputs = declared_inputs(type(leaf))
        self._required: tuple[tuple[Any, Slot], ...] = tuple(
            (port, leaf.ports[name]) for name, port in inputs.items() if port.required
        )

    def run_setup(self) -> None:
        """Call the leaf's setup hook; what it raises is recorded as a fault."""
        try:
            self.leaf.setup()
        except Exception as error:
            self.context.record_fault(self.path, "setup", error)

    def update(self) -> Status:
        """Wait for inputs, start where it does not run, then tick."""
        leaf = self.leaf
        for port, slot in self._required:
            if slot.value is None:
                self._halt()
                self.reason = f'waits for {port.name}: nothing on "{slot.key}"'
                return port.when_missing
        leaf.reason = ""
        self.context.robot.caller = self.path
        if not self.active:
            try:
                leaf.start()
            except Exception as error:
                raise self._fault("start", error) from error
            self.active = True
        status = leaf.tick()
        self.reason = leaf.reason
        if status is not Status.RUNNING:
            if status is not Status.SUCCESS and status is not Status.FAILURE:
                raise TypeError(f"tick() returned {status!r}, needs SUCCESS, FAILURE or RUNNING")
            self.active = False
        return status

    def terminate(self, new_status: Status) -> None:
        """Stop the leaf where it runs."""
        self._halt()

    def replace_leaf(self, leaf: Leaf) -> None:
        """Let another leaf stand in before the first tick; it does not wait for inputs."""
        self.leaf = leaf
        self._required = ()

    def set_parameters(self, parameters: Any) -> None:
        """Replace the parameters of node and leaf between two ticks."""
        self.parameters = self.leaf.parameters = parameters

    def _halt(self) -> None:
        if not self.active:
            return
        self.active = False
        self.context.robot.caller = self.path
        try:
            self.leaf.stop()
        except Exception as error:
            # Others must be stopped as well: the tree looks for recorded faults when the tick is over.
            self.context.record_fault(self.path, "stop", error)
        # Also where a leaf's own hook has forgotten it, or did not come so far.
        self.context.executor.cancel_all(self.path, self.context.time)


def declared_ports(cls: type[Leaf]) -> dict[str, Any]:
    """Inputs, then outputs of a leaf class by name."""
    return {**declared_inputs(cls), **declared_outputs(cls)}
