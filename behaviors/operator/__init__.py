"""The operator's port: events that anyone may send to a running tree, and the inbox that takes them from any thread."""

from behaviors.operator.event import EVENTS, OperatorEvent, OperatorEventError, read_event
from behaviors.operator.events import (
    Approve,
    MoveCarrot,
    PauseWalk,
    Reject,
    ResetBehavior,
    ResumeWalk,
    SendGoal,
    SendWaypoints,
    StopNow,
)
from behaviors.operator.inbox import OperatorInbox
from behaviors.operator.parameter_events import ChangeParameter, SwitchImpassability, SwitchReview
from behaviors.operator.review import ReviewParameters, ReviewRequest
from behaviors.operator.world_events import MoveBox

__all__ = [
    "EVENTS",
    "Approve",
    "ChangeParameter",
    "MoveBox",
    "MoveCarrot",
    "OperatorEvent",
    "OperatorEventError",
    "OperatorInbox",
    "PauseWalk",
    "Reject",
    "ResetBehavior",
    "ResumeWalk",
    "ReviewParameters",
    "ReviewRequest",
    "SendGoal",
    "SendWaypoints",
    "StopNow",
    "SwitchImpassability",
    "SwitchReview",
    "read_event",
]
