"""A lost link is noticed on the robot's clock, once, and what follows is what the configuration says."""

from __future__ import annotations

import pytest

from behaviors.operator import PauseWalk, ResetBehavior, StopNow
from lookstep.operator_link import OperatorLink, OperatorLinkParameters


def changes(heard_until: float, parameters: OperatorLinkParameters, end: float = 10.0, back: float = 99.0):
    link, found = OperatorLink(), []
    for tick in range(round(50 * end)):
        time = tick / 50.0
        change = link.watch(time, heard=time <= heard_until or time >= back, parameters=parameters)
        if change is not None:
            found.append((time, change))
    return found


@pytest.mark.parametrize(
    ("when_lost", "event"), (("hold", PauseWalk()), ("go_on", None), ("reset", ResetBehavior()), ("stop", StopNow()))
)
def test_a_lost_link_does_what_the_configuration_says_once(when_lost, event):
    ((time, change),) = changes(2.0, OperatorLinkParameters(when_lost=when_lost, patience=1.5))
    assert 3.5 < time < 3.55
    assert change.event == event and "lost" in change.text


def test_a_robot_that_nobody_led_misses_nobody():
    assert changes(-1.0, OperatorLinkParameters()) == []


def test_an_operator_who_comes_back_is_told_of_and_nothing_resumes_by_itself():
    lost, back = changes(1.0, OperatorLinkParameters(patience=1.0), back=5.0)
    assert lost[1].event == PauseWalk()
    assert back[0] == pytest.approx(5.0) and back[1].event is None


def test_a_reload_of_the_page_is_no_loss():
    assert changes(1.0, OperatorLinkParameters(patience=3.0), back=3.5) == []
