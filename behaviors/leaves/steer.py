"""Ways of the body that look at no map: straight with a heading of their own, or behind whatever the operator moves."""

from __future__ import annotations

import numpy as np
from py_trees.common import Status

from behaviors.leaf import Leaf
from behaviors.operator import MoveCarrot
from behaviors.ports import Input, Output
from behaviors.registry import leaf
from skills.body_path import BodyPath, Goal, Trail, facing_path, goal_reached
from skills.parameters import parameter, parameters


@parameters
class FaceGoalParameters:
    """How far to turn at a time."""

    most_turn: float = parameter(
        0.7, unit="rad", meaning="turn that the path asks for at once", minimum=0.1, maximum=3.15
    )


@leaf
class FaceGoal(Leaf):
    """Leads straight to the goal while the robot faces as it will there: sideways, backward, turning in place.

    The way begins where the robot was when it was given the goal; a robot that strays comes back to it.
    """

    Parameters = FaceGoalParameters
    parameters: FaceGoalParameters
    ends_with = (Status.SUCCESS,)
    goal = Input(Goal, "where the robot is sent")
    path = Output(BodyPath, "way of the body to the goal")

    def setup(self) -> None:
        """It has led nowhere yet."""
        self._led_to: Goal | None = None
        self._from = np.zeros(2)

    def tick(self) -> Status:
        """SUCCESS with a path, whose heading is as far from that of the feet as may be asked for at once."""
        stance = self.context.robot.status().imminent_stance
        if self.goal != self._led_to:
            self._led_to, self._from = self.goal, stance.mid_feet[:2]
        start = np.array((*self._from, stance.yaw))
        most, path_id = self.parameters.most_turn, self.context.new_id("path")
        self.path = facing_path(start, self.goal.xyyaw_world, most, path_id)
        return self.succeeded(f"{self.path.length:.1f} m to the goal")


@parameters
class WatchCarrotParameters:
    """When following begins, and when it is over."""

    lead: float = parameter(
        0.6, unit="m", meaning="distance of the carrot at which the robot sets out", minimum=0.0, maximum=10.0
    )

    patience: float = parameter(
        0.0,
        unit="s",
        meaning="ends when the robot is where the carrot has rested for so long; 0: never",
        minimum=0.0,
        maximum=3600.0,
    )


@leaf
class WatchCarrot(Leaf):
    """Gives the newest place that the operator holds out to the robot, and the way on which it came there."""

    Parameters = WatchCarrotParameters
    parameters: WatchCarrotParameters
    ends_with = (Status.SUCCESS,)
    goal = Output(Goal, "where the carrot is")
    path = Output(BodyPath, "where it has been, as far as the robot has still to go")

    def start(self) -> None:
        """A carrot of before does not count."""
        self.goal = None
        self.path = None
        self._trail: Trail | None = None
        self._moved = self.context.time

    def tick(self) -> Status:
        """RUNNING while it moves; each event of the operator moves it."""
        stance = self.context.robot.status().imminent_stance
        carrots = [event.goal for event in self.context.operator_events if isinstance(event, MoveCarrot)]
        if carrots:
            trail = self._trail or Trail(np.array((*stance.mid_feet[:2], stance.yaw))[None])
            for carrot in carrots:
                trail = trail.to(carrot)
            self._trail = trail.behind(stance.mid_feet)
            self.goal, self._moved = carrots[-1], self.context.time
            away = np.hypot(*(stance.mid_feet[:2] - carrots[-1].xyyaw_world[:2]))
            # Small steps beside a carrot that has hardly moved lead away from the ground that is known at the start.
            if self.path is not None or away >= self.parameters.lead:
                self.path = self._trail.path(self.context.new_id("path"))
        carrot = self.goal
        if carrot is None:
            return self.running("waits for a carrot")
        rested = self.context.time - self._moved
        if 0.0 < self.parameters.patience <= rested and goal_reached(
            carrot, stance, self.context.parameters["sub_goal"]
        ):
            return self.succeeded(f"the carrot has rested for {rested:.1f} s, and the robot is there")
        return self.running(f"x {carrot.x:.2f} m, y {carrot.y:.2f} m")
