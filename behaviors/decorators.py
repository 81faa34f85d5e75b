"""Decorators: change when one child is ticked, or what its status means. All times are the robot's."""

from __future__ import annotations

from typing import ClassVar

from py_trees.common import Status

from behaviors.context import Context
from behaviors.node import Node
from skills.parameters import parameter, parameters

# Robot times are multiples of the control period up to rounding; a timer due at a tick must not slip to the next.
TIME_TOLERANCE = 1e-9


class Decorator(Node):
    """A node with one child and, where `slots` says so, a condition that is ticked before it.

    Attributes:
        child: what is decorated.
    """

    slots: ClassVar[tuple[str, ...]] = ("child",)

    def __init__(self, path: str, context: Context, parameters: object, children: tuple[Node, ...]) -> None:
        super().__init__(path, context, parameters, children)
        self.child = children[-1]

    def _tick_child(self) -> Status:
        self.child.tick_once()
        self.reason = self.child.reason
        return self.child.status


class Subtree(Decorator):
    """A tree used as a node of another; its status is that of its root."""

    kind = "subtree"

    def update(self) -> Status:
        """The child's status."""
        return self._tick_child()


class Inverter(Decorator):
    """Success becomes failure and failure success."""

    kind = "inverter"

    def update(self) -> Status:
        """The other of SUCCESS and FAILURE, or RUNNING."""
        status = self._tick_child()
        if status is Status.RUNNING:
            return status
        return Status.FAILURE if status is Status.SUCCESS else Status.SUCCESS


class ForceSuccess(Decorator):
    """Failure becomes success."""

    kind = "force_success"

    def update(self) -> Status:
        """SUCCESS, or RUNNING."""
        return Status.RUNNING if self._tick_child() is Status.RUNNING else Status.SUCCESS


class ForceFailure(Decorator):
    """Success becomes failure."""

    kind = "force_failure"

    def update(self) -> Status:
        """FAILURE, or RUNNING."""
        return Status.RUNNING if self._tick_child() is Status.RUNNING else Status.FAILURE


@parameters
class RetryParameters:
    """How often and how soon to try again."""

    attempts: int = parameter(
        3, unit="1", meaning="attempts before it fails; 0 stands for no limit", minimum=0, maximum=1_000_000
    )
    pause: float = parameter(0.0, unit="s", meaning="time between attempts", minimum=0.0, maximum=3600.0)


class Retry(Decorator):
    """Tries a failing child again, at most one attempt a tick."""

    kind = "retry"
    Parameters: ClassVar[type] = RetryParameters
    parameters: RetryParameters

    def initialise(self) -> None:
        """No attempt has failed."""
        self._failures = 0
        self._resume_at = -float("inf")

    def update(self) -> Status:
        """RUNNING until the child succeeds or has failed too often."""
        if self.context.time < self._resume_at - TIME_TOLERANCE:
            self.reason = f"tries again {self.parameters.pause:g} s after it failed: {self.child.reason}"
            return Status.RUNNING
        status = self._tick_child()
        if status is not Status.FAILURE:
            return status
        self._failures += 1
        self._resume_at = self.context.time + self.parameters.pause
        return Status.FAILURE if self._failures == self.parameters.attempts else Status.RUNNING


@parameters
class RepeatParameters:
    """How often to repeat."""

    times: int = parameter(
        0, unit="1", meaning="successes before it succeeds; 0 stands for no limit", minimum=0, maximum=1_000_000
    )


class Repeat(Decorator):
    """Repeats a child that succeeds, at most once a tick; fails when it fails."""

    kind = "repeat"
    Parameters: ClassVar[type] = RepeatParameters
    parameters: RepeatParameters

    def initialise(self) -> None:
        """Nothing was done."""
        self._successes = 0

    def update(self) -> Status:
        """RUNNING until the child has succeeded often enough, or fails."""
        status = self._tick_child()
        if status is not Status.SUCCESS:
            return status
        self._successes += 1
        return Status.SUCCESS if self._successes == self.parameters.times else Status.RUNNING


class LoopForever(Decorator):
    """Repeats its child, whether it succeeds or fails, at most once a tick."""

    kind = "loop_forever"

    def update(self) -> Status:
        """RUNNING."""
        self._tick_child()
        return Status.RUNNING


@parameters
class TimeoutParameters:
    """How long a child may take."""

    after: float = parameter(1.0, unit="s", meaning="robot time the child may take", minimum=0.0, maximum=86400.0)


class Timeout(Decorator):
    """Stops its child and fails when it takes too long on the robot's clock."""

    kind = "timeout"
    Parameters: ClassVar[type] = TimeoutParameters
    parameters: TimeoutParameters

    def initialise(self) -> None:
        """The time runs from here."""
        self._started = self.context.time

    def update(self) -> Status:
        """The child's status, but FAILURE where it still runs when the time is over."""
        status = self._tick_child()
        is_over = self.context.time - self._started >= self.parameters.after - TIME_TOLERANCE
        if status is Status.RUNNING and is_over:
            self.child.stop(Status.INVALID)
            self.reason = f"took longer than {self.parameters.after:g} s"
            return Status.FAILURE
        return status


@parameters
class RateLimitParameters:
    """How often a child may start."""

    period: float = parameter(
        0.1, unit="s", meaning="least robot time from one start to the next", minimum=0.0, maximum=3600.0
    )


class RateLimit(Decorator):
    """Lets its child start at most once a period; while it runs it is ticked at every tick."""

    kind = "rate_limit"
    Parameters: ClassVar[type] = RateLimitParameters
    parameters: RateLimitParameters

    def __init__(self, path: str, context: Context, parameters: object, children: tuple[Node, ...]) -> None:
        super().__init__(path, context, parameters, children)
        self._due = -float("inf")

    def update(self) -> Status:
        """The child's status when it was its turn, else RUNNING."""
        if self.child.status is not Status.RUNNING:
            if self.context.time < self._due - TIME_TOLERANCE:
                self.reason = f"starts every {self.parameters.period:g} s"
                return Status.RUNNING
            # Counting on from the last due time keeps the mean rate where the period is no multiple of the tick.
            late = self.context.time - self._due >= self.parameters.period
            self._due = (self.context.time if late else self._due) + self.parameters.period
        return self._tick_child()


class RunWhile(Decorator):
    """Ticks its child only while a condition succeeds, which it asks at every tick; else it stops the child."""

    kind = "run_while"
    slots = ("condition", "child")

    def update(self) -> Status:
        """The child's status while the condition succeeds, else the condition's."""
        condition = self.children[0]
        condition.tick_once()
        if condition.status is not Status.SUCCESS:
            self._stop_from(1)
            self.reason = condition.reason
            return condition.status
        return self._tick_child()
