"""Guards: is it safe and sensible to go on, and if not, why."""

from __future__ import annotations

from py_trees.common import Status

from behaviors.halt import HaltCause
from behaviors.leaf import Leaf
from behaviors.leaves.vain_attempts import VainAttempts
from behaviors.ports import Input, OptionalInput
from behaviors.registry import leaf
from skills.parameters import parameter, parameters
from skills.regions import PlanarRegions
from skills.walking import WalkingPhase


@leaf
class RobotFallen(Leaf):
    """Succeeds while the robot is not on its feet."""

    def tick(self) -> Status:
        """SUCCESS where the robot has fallen."""
        status = self.context.robot.status()
        if status.phase is WalkingPhase.FALLEN:
            return self.succeeded(f"the robot has fallen: {status.failure}")
        return self.failed("the robot is on its feet")


@parameters
class FreshnessParameters:
    """How old the ground may be."""

    max_age: float = parameter(1.5, unit="s", meaning="older ground is not planned on", minimum=0.05, maximum=60.0)


@leaf
class GroundFresh(Leaf):
    """Succeeds while the newest look at the ground is recent."""

    Parameters = FreshnessParameters
    ground = Input(PlanarRegions, "planar regions around the robot")

    def tick(self) -> Status:
        """SUCCESS while the ground is fresh and there is any."""
        age = self.context.time - self.ground.time
        limit = self.parameters.max_age
        if age > limit:
            return self.failed(f"regions are {age:.1f} s old, limit {limit:.1f} s")
        if not self.ground.regions:
            return self.failed("no regions in sight")
        return self.succeeded()


@parameters
class NoWayOnParameters:
    """When to give up."""

    attempts: int = parameter(
        20, unit="1", meaning="attempts in a row that must have found no step", minimum=1, maximum=1_000_000
    )


@leaf
class NoWayOn(Leaf):
    """Succeeds when so many attempts in a row to plan the next steps were in vain: the way is blocked."""

    Parameters = NoWayOnParameters
    parameters: NoWayOnParameters
    vain = OptionalInput(VainAttempts, "attempts in a row that found no step")

    def tick(self) -> Status:
        """SUCCESS where the robot should give up."""
        vain, limit = self.vain, self.parameters.attempts
        if vain is None or vain.count < limit:
            return self.failed(f"{0 if vain is None else vain.count} of {limit} attempts in a row were in vain")
        reason = f"blocked: {vain.count} attempts to plan a step were in vain, the last: {vain.reason}"
        return self.halted(HaltCause.BLOCKED, reason, Status.SUCCESS)
