"""Walking over footsteps: balance, swing and joint motion."""

from skills.walking.control_sample import ControlSample
from skills.walking.quadratic_program import QpStatus
from skills.walking.robot_model import RobotError, RobotModel
from skills.walking.step_adjustment import StepAdjustmentParameters
from skills.walking.swing_parameters import SwingParameters
from skills.walking.walker import BodyMeasurement, Walker
from skills.walking.walker_parameters import WalkerParameters
from skills.walking.walking_parameters import WalkingParameters
from skills.walking.walking_state import (
    RobotState,
    StepEvent,
    StepEventKind,
    WalkingPhase,
    WalkingStatus,
)
from skills.walking.whole_body_parameters import WholeBodyParameters

__all__ = [
    "BodyMeasurement",
    "ControlSample",
    "QpStatus",
    "RobotError",
    "RobotModel",
    "RobotState",
    "StepAdjustmentParameters",
    "StepEvent",
    "StepEventKind",
    "SwingParameters",
    "Walker",
    "WalkerParameters",
    "WalkingParameters",
    "WalkingPhase",
    "WalkingStatus",
    "WholeBodyParameters",
]
