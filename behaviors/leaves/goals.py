"""Goals that a tree gives itself, and places in turn."""

from __future__ import annotations

import numpy as np
from py_trees.common import Status

from behaviors.leaf import Leaf
from behaviors.operator import ResetBehavior, SendGoal, SendWaypoints
from behaviors.ports import Input, Output
from behaviors.registry import leaf
from skills.body_path import Goal, Waypoints
from skills.geometry.pose import wrap_angle
from skills.parameters import parameter, parameters


@parameters
class GiveGoalParameters:
    """Where to go."""

    x: float = parameter(0.0, unit="m", meaning="in the world", minimum=-1000.0, maximum=1000.0)
    y: float = parameter(0.0, unit="m", meaning="in the world", minimum=-1000.0, maximum=1000.0)
    yaw: float = parameter(0.0, unit="rad", meaning="heading at the goal, in the world", minimum=-3.15, maximum=3.15)


@leaf
class GiveGoal(Leaf):
    """Gives a goal that the tree file names, such as a waypoint."""

    Parameters = GiveGoalParameters
    ends_with = (Status.SUCCESS,)
    parameters: GiveGoalParameters
    goal = Output(Goal, "where the robot is sent")

    def tick(self) -> Status:
        """SUCCESS with the goal."""
        asked = self.parameters
        self.goal = Goal(asked.x, asked.y, asked.yaw)
        return self.succeeded(str(self.goal))


@parameters
class GiveGoalFromHereParameters:
    """How far to go from where the robot is going to stand, as it faces there."""

    forward: float = parameter(0.0, unit="m", meaning="ahead; back where negative", minimum=-100.0, maximum=100.0)
    left: float = parameter(0.0, unit="m", meaning="to the left; right where negative", minimum=-100.0, maximum=100.0)
    turn: float = parameter(0.0, unit="rad", meaning="to the left; right where negative", minimum=-3.15, maximum=3.15)


@leaf
class GiveGoalFromHere(Leaf):
    """Gives a goal by where it lies from the imminent stance, such as 2 m to the left."""

    Parameters = GiveGoalFromHereParameters
    ends_with = (Status.SUCCESS,)
    parameters: GiveGoalFromHereParameters
    goal = Output(Goal, "where the robot is sent")

    def tick(self) -> Status:
        """SUCCESS with the goal."""
        by, stance = self.parameters, self.context.robot.status().imminent_stance
        cos, sin = np.cos(stance.yaw), np.sin(stance.yaw)
        x = stance.mid_feet[0] + cos * by.forward - sin * by.left
        y = stance.mid_feet[1] + sin * by.forward + cos * by.left
        self.goal = Goal(float(x), float(y), float(wrap_angle(stance.yaw + by.turn)))
        return self.succeeded(str(self.goal))


@leaf
class FacesGoal(Leaf):
    """Succeeds when the imminent stance faces as at the goal, wherever it is."""

    goal = Input(Goal, "where the robot is sent")

    def tick(self) -> Status:
        """SUCCESS with the goal's heading."""
        turn = abs(float(wrap_angle(self.goal.yaw - self.context.robot.status().imminent_stance.yaw)))
        if turn <= self.context.parameters["sub_goal"].goal_yaw:
            return self.succeeded("the imminent stance faces as at the goal")
        return self.failed(f"{turn:.1f} rad to turn")


@leaf
class WatchWaypoints(Leaf):
    """Keeps the newest waypoints that the operator sends, until a goal, a reset or a fall ends their round."""

    ends_with = ()
    waypoints = Output(Waypoints, "places to visit in turn")

    def tick(self) -> Status:
        """RUNNING; nothing of a round is left once the robot could not walk."""
        for event in self.context.operator_events:
            if isinstance(event, SendWaypoints):
                self.waypoints = Waypoints(self.context.new_id("waypoints"), event.goals)
                self.log(f"{len(event.goals)} waypoints")
            elif isinstance(event, SendGoal | ResetBehavior):
                self.waypoints = None
        if self.context.robot.status().unable:
            self.waypoints = None
        route = self.waypoints
        return self.running("no waypoints" if route is None else f"{len(route.goals)} waypoints")
