"""Leaves that need nothing but the clock."""

from __future__ import annotations

from py_trees.common import Status

from behaviors.decorators import TIME_TOLERANCE
from behaviors.leaf import Leaf
from behaviors.registry import leaf
from skills.parameters import parameter, parameters


@leaf
class Succeed(Leaf):
    """Succeeds."""

    ends_with = (Status.SUCCESS,)

    def tick(self) -> Status:
        """SUCCESS."""
        return self.succeeded()


@leaf
class Fail(Leaf):
    """Fails."""

    ends_with = (Status.FAILURE,)

    def tick(self) -> Status:
        """FAILURE."""
        return self.failed("always fails")


@parameters
class WaitParameters:
    """How long to wait."""

    duration: float = parameter(1.0, unit="s", meaning="robot time to wait", minimum=0.0, maximum=86400.0)


@leaf
class Wait(Leaf):
    """Waits for some time on the robot's clock."""

    Parameters = WaitParameters
    ends_with = (Status.SUCCESS,)
    parameters: WaitParameters

    @classmethod
    def least_duration(cls, parameters: WaitParameters) -> float:
        """The time to wait [s]."""
        return parameters.duration

    def start(self) -> None:
        """The time runs from here."""
        self._started = self.context.time

    def tick(self) -> Status:
        """RUNNING until the time is over."""
        if self.context.time - self._started < self.parameters.duration - TIME_TOLERANCE:
            return self.running(f"waits for {self.parameters.duration:g} s")
        return self.succeeded()
