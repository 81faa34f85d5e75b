"""Goals that a tree gives itself, and goals that move."""

from __future__ import annotations

from py_trees.common import Status

from behaviors.leaf import Leaf
from behaviors.operator import MoveCarrot, ResetBehavior, SendGoal, SendWaypoints
from behaviors.ports import Output
from behaviors.registry import leaf
from skills.body_path import Goal, Waypoints
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
        return self.succeeded(f"x {asked.x:.2f} m, y {asked.y:.2f} m, yaw {asked.yaw:.2f} rad")


@leaf
class WatchCarrot(Leaf):
    """Gives the newest place that the operator holds out to the robot, for as long as it is ticked."""

    ends_with = ()
    goal = Output(Goal, "where the carrot is")

    def start(self) -> None:
        """A carrot of before does not count."""
        self.goal = None

    def tick(self) -> Status:
        """RUNNING; each event of the operator moves it."""
        carrots = [event.goal for event in self.context.operator_events if isinstance(event, MoveCarrot)]
        if carrots:
            self.goal = carrots[-1]
        carrot = self.goal
        return self.running("waits for a carrot" if carrot is None else f"x {carrot.x:.2f} m, y {carrot.y:.2f} m")


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
