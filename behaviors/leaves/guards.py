"""Guards: is it safe and sensible to go on, and if not, why. None of them does anything."""

from __future__ import annotations

from py_trees.common import Status

from behaviors.halt import HaltCause
from behaviors.leaf import Leaf
from behaviors.leaves.vain_attempts import VainAttempts
from behaviors.operator import ResetBehavior
from behaviors.ports import Input, OptionalInput, Output
from behaviors.registry import leaf
from skills.body_path import BodyPath, Obstacle, find_obstacle
from skills.height_map import HeightMap
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
            return self.succeeded(status.unable)
        return self.failed("the robot is on its feet")


@leaf
class RobotDisabled(Leaf):
    """Succeeds while the robot is not under control of walking."""

    def tick(self) -> Status:
        """SUCCESS where the robot is disabled."""
        status = self.context.robot.status()
        if status.phase is WalkingPhase.DISABLED:
            return self.succeeded(status.unable)
        return self.failed("the robot is under control")


@leaf
class ResetAsked(Leaf):
    """Succeeds in the tick in which the operator asks for a reset."""

    def tick(self) -> Status:
        """SUCCESS where a reset is asked for."""
        if any(isinstance(event, ResetBehavior) for event in self.context.operator_events):
            return self.succeeded("the operator asks for a reset")
        return self.failed("no reset is asked for")


@leaf
class NotPaused(Leaf):
    """Succeeds unless the operator has paused the walk."""

    def tick(self) -> Status:
        """FAILURE between a pause and the end of it."""
        if self.context.paused:
            return self.halted(HaltCause.OPERATOR, "paused by the operator", Status.FAILURE)
        return self.succeeded()


@parameters
class RobotDataParameters:
    """How old what the robot says of itself may be."""

    max_age: float = parameter(0.5, unit="s", meaning="older estimates are not walked on", minimum=0.02, maximum=60.0)


@leaf
class RobotDataFresh(Leaf):
    """Succeeds while the estimate of the robot's state is recent."""

    Parameters = RobotDataParameters
    parameters: RobotDataParameters

    def tick(self) -> Status:
        """SUCCESS while the estimate is fresh."""
        age, limit = self.context.time - self.context.robot.state().time, self.parameters.max_age
        if age > limit:
            reason = f"robot data is {age:.1f} s old, limit {limit:.1f} s"
            return self.halted(HaltCause.OLD_DATA, reason, Status.FAILURE)
        return self.succeeded()


@parameters
class FreshnessParameters:
    """How old the ground may be."""

    max_age: float = parameter(
        1.5, unit="s", meaning="older ground is not planned or walked on", minimum=0.05, maximum=60.0
    )


@leaf
class GroundFresh(Leaf):
    """Succeeds while the ground was seen recently; frames without depth make nothing fresh."""

    Parameters = FreshnessParameters
    parameters: FreshnessParameters
    ground = Input(PlanarRegions, "planar regions around the robot")

    def tick(self) -> Status:
        """SUCCESS while the ground is fresh and there is any."""
        if not self.ground.regions:
            return self.halted(HaltCause.OLD_DATA, "no regions in sight", Status.FAILURE)
        age, limit = self.context.time - self.ground.time, self.parameters.max_age
        if age > limit:
            reason = f"regions are {age:.1f} s old, limit {limit:.1f} s"
            return self.halted(HaltCause.OLD_DATA, reason, Status.FAILURE)
        return self.succeeded()


@parameters
class PathClearParameters:
    """How old the height map may be."""

    max_age: float = parameter(
        1.5, unit="s", meaning="by an older height map nobody sees what is in the way", minimum=0.05, maximum=60.0
    )


@leaf
class PathClear(Leaf):
    """Succeeds while nothing stands in the way of the body within the horizon (`impassability`).

    What has come to a place that was seen clear may go again: it says for how long that is worth waiting for, before a
    way around is planned. What was only not seen before stays: it counts when it is near, until then a way around is
    planned while the robot walks.
    """

    Parameters = PathClearParameters
    parameters: PathClearParameters
    path = Input(BodyPath, "way of the body to the goal")
    height_map = OptionalInput(HeightMap, "heights of the ground, cell by cell; without it the way counts as clear")
    obstacle = Output(Obstacle, "what stands in the way; nothing where it is clear")
    waits = Output(bool, "whether something stands in the way that may still go by itself")

    def setup(self) -> None:
        """Nothing has been looked at, and nothing was in the way."""
        self._seen: tuple[object, ...] = ()
        self._clear_map: HeightMap | None = None
        self._since: float | None = None
        self._came = False

    def tick(self) -> Status:
        """FAILURE where something stands in the way, or the map is too old to tell."""
        rules, height_map = self.context.parameters["impassability"], self.height_map
        if height_map is None or not rules.halts:
            self._seen, self.obstacle = (), None
            return self._clear()
        age, limit = self.context.time - height_map.time, self.parameters.max_age
        if age > limit:
            reason = f"the height map is {age:.1f} s old, limit {limit:.1f} s"
            return self.halted(HaltCause.OLD_DATA, reason, Status.FAILURE)
        if (height_map, self.path, rules) != self._seen:
            self._seen = (height_map, self.path, rules)
            stance = self.context.robot.status().imminent_stance
            halted = self._since is not None
            self.obstacle = find_obstacle(self.path, stance, height_map, rules, halted=halted)
        found = self.obstacle
        if found is None:
            self._clear_map = height_map
            return self._clear()
        if self._since is None:
            self._since = self.context.time
            self._came = self._clear_map is not None and found.has_come_since(self._clear_map)
        self.waits = self._came and self.context.time - self._since < rules.patience
        if not self._came and found.distance > rules.brake:
            return self.succeeded()
        reason = f"path blocked: something {found.height:.1f} m high stands {found.distance:.1f} m ahead"
        return self.halted(HaltCause.BLOCKED, reason, Status.FAILURE)

    def _clear(self) -> Status:
        self._since, self.waits = None, False
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
