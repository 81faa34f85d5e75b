"""What the panel's process may say: every event of the operator, a few words on the simulation, and nothing else."""

from __future__ import annotations

import json

import pytest

from behaviors.operator import (
    Approve,
    ChangeParameter,
    MoveBox,
    MoveCarrot,
    PauseWalk,
    Reject,
    ResetBehavior,
    ResumeWalk,
    SendGoal,
    SendWaypoints,
    StopNow,
    SwitchImpassability,
    SwitchReview,
)
from lookstep.panel.messages import (
    LARGEST,
    Beat,
    MessageError,
    Ready,
    Sent,
    SetHalted,
    SetSpeed,
    StepOnce,
    Told,
    read_message,
    write_message,
)
from skills.body_path import Goal

GOAL = Goal(4.0, -0.5, 1.5)
EVENTS = (
    *(SendGoal(GOAL), MoveCarrot(GOAL), SendWaypoints((GOAL, GOAL)), Approve("footsteps", 3), Reject("body_path", 0)),
    *(
        PauseWalk(),
        ResumeWalk(),
        ResetBehavior(),
        StopNow(),
        SwitchImpassability(False),
        SwitchReview("footsteps", True),
    ),
    *(ChangeParameter("footsteps", "reach", 0.4), MoveBox("block", (1.0, 0.0, 0.2), (1.0, 0.0, 0.0, 0.0))),
)
MESSAGES = (Ready("http://127.0.0.1:1/"), Beat(True), Told("a line"), SetSpeed(0.5), SetHalted(True), StepOnce())


@pytest.mark.parametrize("message", (*MESSAGES, *map(Sent, EVENTS)), ids=repr)
def test_what_is_written_is_read_again(message):
    assert read_message(write_message(message)) == message


@pytest.mark.parametrize(
    "data",
    (
        *(b"", b"\xff\xfe", b"{", b"[]", b"null", b"3", b'{"do": "fly"}', b'{"do": ["event"]}', b"[" * 60000),
        *(
            b'{"do": "event", "name": "goal", "value": %s}' % value
            for value in (b"[1,2]", b"[NaN,0,0]", b"[1e999,0,0]")
        ),
        b'{"do": "event", "name": "goal", "value": [1' + b"0" * 400 + b", 0, 0]}",
        *(b'{"do": "event", "name": "approve", "value": %s}' % value for value in (b'["x y", 1]', b'["a", -1]', b"{}")),
        b'{"do": "event", "name": "parameter", "value": ["a", "b", ' + b"[" * 900 + b"]" * 900 + b"]}",
        b'{"do": "event", "name": "parameter", "value": ["footsteps", "reach", {"a": 1}]}',
        b'{"do": "event", "name": "box", "value": ["a", [0, 0, 0], [2, 0, 0, 0]]}',
        b'{"do": "event", "name": "__class__", "value": null}',
        *(b'{"do": "speed", "value": %s}' % value for value in (b"0", b"-1", b"1e9", b"NaN", b"true", b'"1"')),
        *(b'{"do": "halt", "value": %s}' % value for value in (b"1", b"null", b'"yes"')),
        json.dumps({"do": "tell", "value": "x" * 10_000}).encode(),
        b" " * (LARGEST + 1),
    ),
    ids=lambda data: repr(data[:60]),
)
def test_what_makes_no_sense_is_refused_with_a_short_reason(data):
    with pytest.raises(MessageError) as error:
        read_message(data)
    assert 0 < len(str(error.value)) < 400
