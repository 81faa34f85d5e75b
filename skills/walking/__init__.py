"""Walking over footsteps: balance, swing and joint motion."""

from skills.walking.kinematic_walker import KinematicWalker, WalkerOutput
from skills.walking.robot_model import RobotModel
from skills.walking.walking_parameters import WalkingParameters
from skills.walking.walking_state import (
    ControlSample,
    RobotState,
    StepEvent,
    StepEventKind,
    WalkingPhase,
    WalkingStatus,
)

__all__ = [
    "ControlSample",
    "KinematicWalker",
    "RobotModel",
    "RobotState",
    "StepEvent",
    "StepEventKind",
    "WalkerOutput",
    "WalkingParameters",
    "WalkingPhase",
    "WalkingStatus",
]
