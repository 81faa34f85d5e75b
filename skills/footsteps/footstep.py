"""Footsteps and plans of them, as planners make them and walking controllers take them."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from enum import Enum

import numpy as np

from skills.geometry.pose import Array, Pose, readonly, wrap_angle


class Side(Enum):
    """A leg."""

    LEFT = "left"
    RIGHT = "right"

    @property
    def opposite(self) -> Side:
        """The other leg."""
        return Side.RIGHT if self is Side.LEFT else Side.LEFT

    @property
    def sign(self) -> float:
        """+1 for left, -1 for right: the sign of y in the body's frame."""
        return 1.0 if self is Side.LEFT else -1.0


@dataclass(frozen=True, slots=True, eq=False)
class Stance:
    """Both feet on the ground.

    Attributes:
        T_world_left, T_world_right: sole frames, origin at the sole's centre, x forward, z along the surface normal.
    """

    T_world_left: Pose
    T_world_right: Pose

    def sole(self, side: Side) -> Pose:
        """Sole frame of one foot in the world."""
        return self.T_world_left if side is Side.LEFT else self.T_world_right

    def with_sole(self, side: Side, T_world_sole: Pose) -> Stance:
        """The same stance with one foot elsewhere."""
        if side is Side.LEFT:
            return Stance(T_world_sole, self.T_world_right)
        return Stance(self.T_world_left, T_world_sole)

    def moved(self, T: Pose) -> Stance:
        """The same stance seen from another frame."""
        return Stance(T @ self.T_world_left, T @ self.T_world_right)

    @property
    def mid_feet(self) -> Array:
        """Point midway between the soles, (3,) in the world [m]."""
        return 0.5 * (self.T_world_left.p + self.T_world_right.p)

    @property
    def yaw(self) -> float:
        """Mean heading of the feet [rad]."""
        left, right = self.T_world_left.yaw, self.T_world_right.yaw
        return wrap_angle(left + 0.5 * wrap_angle(right - left))


@dataclass(frozen=True, slots=True, eq=False)
class Footstep:
    """A foothold for one foot and the way there.

    Attributes:
        sequence_id: place of the step in the walk; a newer plan's step takes the place of the queued one with its id.
        side: which foot lands here.
        T_world_sole: sole frame, x forward, z along the surface normal.
        foothold_sole: usable part of the sole, (N, 2) convex polygon, counter-clockwise [m].
        swing_duration, transfer_duration: time in the air, and in double support before it [s].
        swing_height: how far the sole rises above the higher end of its way [m].
        swing_waypoints_world: sole positions to pass on the way, (K, 3), may be empty [m].
        landing_region_sole: where the sole's centre may land instead on ground as good, (N, 2) convex polygon in the
            sole's plane, counter-clockwise, at most 8 corners; empty where it must land as planned [m].
        margin: distance of the whole sole from the edges of its region, no more than was wanted; negative over one [m].
    """

    sequence_id: int
    side: Side
    T_world_sole: Pose
    foothold_sole: Array
    swing_duration: float
    transfer_duration: float
    swing_height: float
    swing_waypoints_world: Array
    landing_region_sole: Array = field(default_factory=lambda: np.zeros((0, 2)))
    margin: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "foothold_sole", readonly(self.foothold_sole, (None, 2)))
        object.__setattr__(self, "landing_region_sole", readonly(self.landing_region_sole, (None, 2)))
        waypoints = np.asarray(self.swing_waypoints_world, dtype=np.float64).reshape(-1, 3)
        object.__setattr__(self, "swing_waypoints_world", readonly(waypoints))

    def moved(self, T: Pose) -> Footstep:
        """The same step seen from another frame."""
        return replace(self, T_world_sole=T @ self.T_world_sole, swing_waypoints_world=T @ self.swing_waypoints_world)


class PlanOutcome(Enum):
    """How a footstep search ended."""

    GOAL_REACHED = "goal_reached"
    ENOUGH_STEPS = "enough_steps"
    PARTIAL = "partial"
    BLOCKED = "blocked"

    @property
    def executable(self) -> bool:
        """Whether the plan's steps may be walked."""
        return self is not PlanOutcome.BLOCKED


@dataclass(frozen=True, slots=True, eq=False)
class FootstepPlan:
    """The answer of a footstep planner.

    Attributes:
        plan_id: unique over a run.
        frame_id: newest depth image behind the regions that it was planned on.
        outcome: how the search ended.
        reason: one sentence for the operator; says why, where the outcome is not what was asked for.
        steps: the steps in order; empty when blocked.
        cost: sum of the edge costs.
        expansions: nodes the search expanded.
        rejections: number of rejected edges by reason, for the operator.
        kept_steps: how many of the first steps are those of the plan before.
    """

    plan_id: int
    frame_id: int
    outcome: PlanOutcome
    reason: str
    steps: tuple[Footstep, ...]
    cost: float
    expansions: int
    rejections: tuple[tuple[str, int], ...] = ()
    kept_steps: int = 0
