"""The way of the body from start to goal, and the sub-goals along it."""

from skills.body_path.body_path import BodyPath, PathEnd
from skills.body_path.facing_path import facing_path
from skills.body_path.goal import Goal, Waypoints
from skills.body_path.impassability import ImpassabilityParameters, Obstacle, find_obstacle
from skills.body_path.path_parameters import BodyPathParameters
from skills.body_path.path_planner import PathPlan, PathRequest, plan_body_path
from skills.body_path.straight_path import straight_path
from skills.body_path.sub_goal import SubGoal, SubGoalParameters, goal_reached, sub_goal
from skills.body_path.trail import Trail

__all__ = [
    "BodyPath",
    "BodyPathParameters",
    "Goal",
    "ImpassabilityParameters",
    "Obstacle",
    "PathEnd",
    "PathPlan",
    "PathRequest",
    "SubGoal",
    "SubGoalParameters",
    "Trail",
    "Waypoints",
    "facing_path",
    "find_obstacle",
    "goal_reached",
    "plan_body_path",
    "straight_path",
    "sub_goal",
]
