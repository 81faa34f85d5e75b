"""From a goal to a body path, and along it from sub-goal to sub-goal."""

from __future__ import annotations

import numpy as np
from py_trees.common import Status

from behaviors.leaf import Call, Leaf, SkillLeaf
from behaviors.operator import SendGoal
from behaviors.ports import Input, Output
from behaviors.registry import leaf
from skills.body_path import BodyPath, Goal, SubGoal, goal_reached, straight_path, sub_goal
from skills.walking import WalkingPhase


@leaf
class WaitForGoal(Leaf):
    """Waits until the operator sends a goal that is newer than the last one; a fallen robot takes none."""

    ends_with = (Status.SUCCESS,)
    goal = Output(Goal, "where the robot is sent")

    def start(self) -> None:
        """An old goal does not count: whoever asks again waits for a new one."""
        self.goal = None

    def tick(self) -> Status:
        """SUCCESS when a goal arrives."""
        goals = [event.goal for event in self.context.operator_events if isinstance(event, SendGoal)]
        if not goals:
            return self.running("waits for a goal")
        status = self.context.robot.status()
        if status.phase is WalkingPhase.FALLEN:
            # Else it would walk off by itself once it stands again.
            self.log(f"goal refused: the robot has fallen: {status.failure}", level="warning")
            return self.running("waits for a goal that comes when the robot is on its feet")
        self.goal = goals[-1]
        self.log(f"new goal: x {goals[-1].x:.2f} m, y {goals[-1].y:.2f} m, yaw {goals[-1].yaw:.2f} rad")
        return self.succeeded()


@leaf
class PlanBodyPath(SkillLeaf):
    """Plans the way of the body from the imminent stance to the goal."""

    goal = Input(Goal, "where the robot is sent")
    path = Output(BodyPath, "way of the body to the goal")

    def request(self) -> Call | Status:
        """From where the feet will stand."""
        stance = self.context.robot.status().imminent_stance
        start = np.array((stance.mid_feet[0], stance.mid_feet[1], stance.yaw))
        return self.call(straight_path, start, self.goal.xyyaw_world, self.context.new_id("path"))

    def receive(self, result: BodyPath) -> Status:
        """Hand the path on."""
        self.path = result
        return self.succeeded(f"{result.length:.1f} m to the goal")


@leaf
class FindSubGoal(Leaf):
    """Projects the imminent stance onto the path and looks ahead along it."""

    ends_with = (Status.SUCCESS,)
    path = Input(BodyPath, "way of the body to the goal")
    sub_goal = Output(SubGoal, "where the next steps should lead")

    def tick(self) -> Status:
        """SUCCESS with a sub-goal."""
        stance = self.context.robot.status().imminent_stance
        self.sub_goal = sub_goal(self.path, stance, self.context.parameters["sub_goal"])
        return self.succeeded()


@leaf
class GoalReached(Leaf):
    """Succeeds when the imminent stance is at the end of the path, in position and heading."""

    path = Input(BodyPath, "way of the body to the goal")

    def tick(self) -> Status:
        """SUCCESS at the goal."""
        stance = self.context.robot.status().imminent_stance
        if goal_reached(self.path, stance, self.context.parameters["sub_goal"]):
            return self.succeeded("the imminent stance is at the goal")
        rest = self.path.length - self.path.project(stance.mid_feet)
        return self.failed(f"{rest:.1f} m to go")
