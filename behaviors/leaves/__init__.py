"""The leaves of look-and-step: thin, each calls one skill or one command of the robot."""

from behaviors.leaves.follow_path import FindSubGoal, GoalReached, PlanBodyPath, WaitForGoal, WatchGoal
from behaviors.leaves.goals import FacesGoal, GiveGoal, GiveGoalFromHere, WatchWaypoints
from behaviors.leaves.guards import (
    GroundFresh,
    NotPaused,
    NoWayOn,
    PathClear,
    ResetAsked,
    RobotDataFresh,
    RobotDisabled,
    RobotFallen,
)
from behaviors.leaves.height_map import UpdateHeightMap
from behaviors.leaves.look import ExtractRegions, RememberGround
from behaviors.leaves.plan_steps import PlanFootsteps
from behaviors.leaves.review import ReviewBodyPath, ReviewFootsteps
from behaviors.leaves.steer import FaceGoal, WatchCarrot
from behaviors.leaves.walk import PauseWalking, SendFootsteps, WaitForQueue, WaitForSwing, WaitUntilStanding

__all__ = [
    "ExtractRegions",
    "FaceGoal",
    "FacesGoal",
    "FindSubGoal",
    "GiveGoal",
    "GiveGoalFromHere",
    "GoalReached",
    "GroundFresh",
    "NoWayOn",
    "NotPaused",
    "PathClear",
    "PauseWalking",
    "PlanBodyPath",
    "PlanFootsteps",
    "RememberGround",
    "ResetAsked",
    "ReviewBodyPath",
    "ReviewFootsteps",
    "RobotDataFresh",
    "RobotDisabled",
    "RobotFallen",
    "SendFootsteps",
    "UpdateHeightMap",
    "WaitForGoal",
    "WaitForQueue",
    "WaitForSwing",
    "WaitUntilStanding",
    "WatchCarrot",
    "WatchGoal",
    "WatchWaypoints",
]
