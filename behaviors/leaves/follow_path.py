"""From a goal to a body path, and along it from sub-goal to sub-goal."""

from __future__ import annotations

import numpy as np
from py_trees.common import Status

from behaviors.decorators import TIME_TOLERANCE
from behaviors.halt import HaltCause
from behaviors.leaf import Call, Leaf, SkillLeaf, SkillParameters
from behaviors.leaves.vain_attempts import VainAttempts
from behaviors.operator import SendGoal
from behaviors.ports import Input, OptionalInput, Output
from behaviors.registry import leaf
from skills.body_path import (
    BodyPath,
    Goal,
    PathEnd,
    PathPlan,
    PathRequest,
    SubGoal,
    Waypoints,
    goal_reached,
    plan_body_path,
    sub_goal,
)
from skills.height_map import HeightMap
from skills.parameters import parameter, parameters


@leaf
class WaitForGoal(Leaf):
    """Waits until the operator sends a newer goal, or gives the next waypoint; a robot that cannot walk takes none."""

    ends_with = (Status.SUCCESS,)
    waypoints = OptionalInput(Waypoints, "places to visit in turn; without them it waits for each goal")
    goal = Output(Goal, "where the robot is sent")

    def setup(self) -> None:
        """No waypoint has been given."""
        self._route_id, self._given = -1, 0

    def start(self) -> None:
        """An old goal does not count: whoever asks again waits for a new one."""
        self.goal = None

    def tick(self) -> Status:
        """SUCCESS when a goal arrives."""
        goals = [event.goal for event in self.context.operator_events if isinstance(event, SendGoal)]
        if not goals:
            return self._next_waypoint()
        status = self.context.robot.status()
        if status.unable:
            # Else it would walk off by itself once it stands again.
            self.log(f"goal refused: {status.unable}", level="warning")
            return self.running("waits for a goal that comes when the robot is on its feet")
        self.goal = goals[-1]
        self.log(f"new goal: {goals[-1]}")
        return self.succeeded()

    def _next_waypoint(self) -> Status:
        route = self.waypoints
        if route is None or self.context.robot.status().unable:
            return self.running("waits for a goal")
        if route.route_id != self._route_id:
            self._route_id, self._given = route.route_id, 0
        if self._given == len(route.goals):
            return self.running(f"all {len(route.goals)} waypoints are visited; waits for a goal")
        self.goal = route.goals[self._given]
        self._given += 1
        self.log(f"waypoint {self._given} of {len(route.goals)}: x {self.goal.x:.2f} m, y {self.goal.y:.2f} m")
        return self.succeeded()


@leaf
class WatchGoal(Leaf):
    """Takes each new goal that the operator sends, for as long as it is ticked: the robot need not stop for it."""

    ends_with = ()
    goal = Output(Goal, "where the robot is sent")

    def tick(self) -> Status:
        """RUNNING; each goal that is sent replaces the one before."""
        goals = [event.goal for event in self.context.operator_events if isinstance(event, SendGoal)]
        if goals and goals[-1] != self.goal:
            self.goal = goals[-1]
            self.log(f"new goal: {goals[-1]}")
        return self.running("takes new goals")


@parameters
class PlanBodyPathParameters(SkillParameters):
    """How long a path may take, and how often it is planned."""

    latency: float = parameter(0.1, unit="s", meaning="robot time until a path is delivered", minimum=0.0, maximum=60.0)
    period: float = parameter(
        0.0,
        unit="s",
        meaning="a path that leads to the goal is looked at again after this time; 0: plans anew at once",
        minimum=0.0,
        maximum=3600.0,
    )


@leaf
class PlanBodyPath(SkillLeaf):
    """Plans the way of the body over the height map, from the imminent stance to the goal.

    With a period, the path that the robot is on is kept until it is blocked or another is clearly cheaper.
    """

    Parameters = PlanBodyPathParameters
    parameters: PlanBodyPathParameters
    goal = Input(Goal, "where the robot is sent")
    height_map = Input(HeightMap, "heights of the ground, cell by cell")
    path = Output(BodyPath, "way of the body to the goal, or as far as it is known")

    def setup(self) -> None:
        """No path has been planned yet."""
        self._planned_at = -float("inf")

    def request(self) -> Call | Status:
        """From where the feet will stand."""
        period, path = self.parameters.period, self.path
        walked = path if period > 0.0 and path is not None and path.leads_to(self.goal) else None
        if walked is not None and self.context.time < self._planned_at + period - TIME_TOLERANCE:
            return self.running(f"plans again every {period:g} s")
        self._planned_at = self.context.time
        stance = self.context.robot.status().imminent_stance
        request = PathRequest(
            height_map=self.height_map,
            start=np.array((stance.mid_feet[0], stance.mid_feet[1], stance.yaw)),
            goal=self.goal,
            parameters=self.context.parameters["body_path"],
            walked=walked,
            path_id=self.context.new_id("path"),
        )
        return self.call(plan_body_path, request)

    def receive(self, result: PathPlan) -> Status:
        """Hand the path on; where planning failed the one before stays."""
        if result.path is None:
            return self.failed(result.failure)
        self.path = result.path
        kept = ", as before" if result.kept else ""
        return self.succeeded(f"{result.path.length:.1f} m, {result.path.end.value}{kept}")


@leaf
class FindSubGoal(Leaf):
    """Projects the imminent stance onto the path and looks ahead along it; fails where the path ends short of the goal.

    Such an end is no place to stop at until the robot is there: the path may still grow.
    """

    path = Input(BodyPath, "way of the body to the goal")
    sub_goal = Output(SubGoal, "where the next steps should lead")
    vain = Output(VainAttempts, "attempts in a row that found no step: at such an end each is one")

    def tick(self) -> Status:
        """SUCCESS with a sub-goal."""
        stance, path = self.context.robot.status().imminent_stance, self.path
        parameters = self.context.parameters["sub_goal"]
        if path.end is not PathEnd.GOAL and path.length - path.project(stance.mid_feet) <= parameters.goal_distance:
            reason = f"the path ends here, {path.end.value}"
            x, y, _ = path.waypoints_world[-1].tolist()
            self.vain = VainAttempts.after(self.vain, (x, y), reason)
            if path.end is PathEnd.BORDER:
                return self.failed(reason)
            return self.halted(HaltCause.BLOCKED, reason, Status.FAILURE)
        self.sub_goal = sub_goal(path, stance, parameters)
        return self.succeeded()


@leaf
class GoalReached(Leaf):
    """Succeeds when the imminent stance is at the goal, in position and heading; the end of a path alone is none."""

    goal = Input(Goal, "where the robot is sent")
    path = Input(BodyPath, "way of the body to the goal")

    def tick(self) -> Status:
        """SUCCESS at the goal."""
        stance = self.context.robot.status().imminent_stance
        if goal_reached(self.goal, stance, self.context.parameters["sub_goal"]):
            return self.succeeded("the imminent stance is at the goal")
        rest = self.path.length - self.path.project(stance.mid_feet)
        return self.failed(f"{rest:.1f} m to go on the path")
