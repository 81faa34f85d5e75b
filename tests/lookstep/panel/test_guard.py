"""Messages of clients: values of widgets from who holds control, a cry for control from anybody, and nothing else."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import pytest

from lookstep.panel.authority import Authority
from lookstep.panel.guard import Guard


@dataclass
class GuiUpdateMessage:
    uuid: str
    updates: Any


@dataclass
class ScenePointerMessage:
    ray: tuple[float, ...] = ()


@dataclass
class ShareUrlRequest:
    pass


@dataclass
class ViewerCameraMessage:
    position: tuple[float, ...] = ()


@dataclass
class Clock:
    now: float = 0.0
    said: list[str] = field(default_factory=list)


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def guard(clock) -> Guard:
    authority = Authority()
    for client in (0, 1):
        authority.connect(client)
    guard = Guard(authority, clock.said.append, now=lambda: clock.now)
    guard.open_to_all("ask")
    return guard


PRESS = GuiUpdateMessage("approve", {"value": True})


def test_only_who_holds_control_is_let_in(guard, clock):
    assert guard.lets_in(0, PRESS) and guard.lets_in(0, ScenePointerMessage())
    assert not guard.lets_in(1, PRESS) and not guard.lets_in(1, ScenePointerMessage())
    assert clock.said == ["client 1 is refused: it does not hold control"]
    assert guard.lets_in(1, GuiUpdateMessage("ask", {"value": True})) and guard.lets_in(1, ViewerCameraMessage())


@pytest.mark.parametrize(
    "updates",
    (
        *({"removed": True}, {"update_cb": []}, {"value": True, "removed": True}, {}, None, [], {"value": None}),
        *({"value": {"a": 1}}, {"value": "x" * 5000}, {"value": [[1]]}, {"value": list(range(99))}, {"value": b"x"}),
    ),
    ids=lambda updates: repr(updates)[:30],
)
def test_nothing_but_a_plain_value_changes_a_widget(guard, updates):
    assert not guard.lets_in(0, GuiUpdateMessage("approve", updates))


def test_no_tunnel_to_the_outside_is_opened(guard):
    assert not guard.lets_in(0, ShareUrlRequest())


def test_a_flood_is_cut_off_for_the_second_and_for_its_client_alone(guard, clock):
    taken = [guard.lets_in(0, PRESS) for _ in range(1000)]
    assert 0 < sum(taken) < 300
    assert guard.lets_in(1, ViewerCameraMessage())
    assert len(clock.said) == 1
    clock.now = 1.5
    assert guard.lets_in(0, PRESS)
