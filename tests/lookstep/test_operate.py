"""`lookstep operate`: no address that others reach without a token; moved blocks are moved again in a replay."""

from __future__ import annotations

from pathlib import Path

import pytest

from behaviors import OperatorInbox
from behaviors.operator import MoveBox
from lookstep.__main__ import main
from lookstep.options import RunOptions
from lookstep.replay import ReplayOptions, replay
from lookstep.walk import walk


@pytest.mark.parametrize("host", ("0.0.0.0", "192.168.1.5", "example.org", "::"))
def test_an_address_that_others_reach_needs_a_token(host, capsys):
    assert main(["operate", "--host", host]) == 2
    assert "give --token-file FILE" in capsys.readouterr().err


@pytest.mark.parametrize("token", ("short", "x" * 15, "with spaces and more", "semi;colon;semi;colon"))
def test_a_token_that_can_be_guessed_or_breaks_a_header_is_refused(token, tmp_path, capsys):
    file = tmp_path / "token"
    file.write_text(token)
    assert main(["operate", "--host", "0.0.0.0", "--token-file", str(file)]) == 2
    assert "needs at least 16 letters and digits" in capsys.readouterr().err


class Hand:
    """Moves a box in a tick, and one that is not there."""

    def __init__(self, inbox: OperatorInbox) -> None:
        self.inbox = inbox
        self.poses: dict = {}
        self.said: list[str] = []

    def observe(self, moment) -> None:
        self.poses = moment.world.box_poses()
        self.said += [line.text for line in moment.log]
        if moment.tree.context.tick == 5:
            self.inbox.put(MoveBox("no_such_box", (0.0, 0.0, 0.0), (1.0, 0.0, 0.0, 0.0)))
            (x, y, z), name = min((position, name) for name, (position, _) in self.poses.items() if position[0] > 1.0)
            self.inbox.put(MoveBox(name, (x, y, z + 0.1), (1.0, 0.0, 0.0, 0.0)))


def test_a_moved_block_is_moved_again_in_a_replay_and_one_that_is_not_there_is_told(tmp_path: Path, monkeypatch):
    inbox = OperatorInbox()
    hand = Hand(inbox)
    options = RunOptions(
        tree="lead",
        course="uneven_flat",
        world="kinematic",
        preset="fast",
        time_limit=0.6,
        operated=True,
        assignments=("camera.resolution=0.3125",),
        out=tmp_path,
    )
    walk(options, hand, inbox=inbox)
    refusal = "\"box\" is refused: got box 'no_such_box', uneven_flat has"
    assert any(text.startswith(refusal) for text in hand.said)
    assert replay(tmp_path, ReplayOptions()).diff.identical
    monkeypatch.setattr("lookstep.replay.change_world", lambda world, context: None)
    assert not replay(tmp_path, ReplayOptions()).diff.identical
