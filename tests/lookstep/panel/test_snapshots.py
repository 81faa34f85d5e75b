"""Snapshots: each is written by what is new, read as a whole, and told in words that no text can break out of."""

from __future__ import annotations

import pickle
from typing import Any

from behaviors import LogLine
from behaviors.operator import ReviewRequest
from lookstep.panel import words
from lookstep.panel.authority import AuthorityState
from lookstep.panel.snapshot import SnapshotReader, SnapshotWriter
from skills.body_path import BodyPath, Goal
from skills.footsteps import FootstepPlan
from skills.regions import PlanarRegions


def test_a_snapshot_shows_what_the_robot_is_about(album):
    last = album.snapshots[-1]
    assert last.value(Goal) == Goal(1.0, 0.0, 0.0)
    path, plan = last.value(BodyPath), last.value(FootstepPlan)
    assert path is not None and plan is not None and last.value(PlanarRegions) is not None
    assert {request.checkpoint for request in album.asked} == {"body_path", "footsteps"}
    commanded = [step for step in (last.status.current_step, *last.status.queue) if step is not None]
    assert commanded and {step.sequence_id for step in commanded} <= last.approved
    assert {time.kind for time in last.times} >= {"ExtractRegions", "PlanFootsteps"}
    assert last.nodes[0].path == "/lead"


def test_what_is_read_is_what_was_written_and_only_what_is_new_is_sent(album):
    writer, reader = SnapshotWriter(), SnapshotReader()
    frames = [writer.write(snapshot) for snapshot in album.snapshots]
    read = [reader.read(frame) for frame in frames]
    for snapshot, copy in zip(album.snapshots, read, strict=True):
        assert (copy.time, copy.steps, copy.approved, copy.lines) == (
            *(snapshot.time, snapshot.steps, snapshot.approved),
            snapshot.lines,
        )
        assert copy.nodes == snapshot.nodes and set(copy.values) == set(snapshot.values)
        assert (copy.state.joint_positions == snapshot.state.joint_positions).all()
    assert "stage" in pickle.loads(frames[0]) and all("stage" not in pickle.loads(frame) for frame in frames[1:])
    whole = len(SnapshotWriter().write(album.snapshots[-1]))
    assert min(map(len, frames[1:])) < 0.2 * whole


def test_a_snapshot_is_made_without_copying_what_is_large(album):
    first, second = album.snapshots[-2:]
    assert first.parameters is second.parameters and first.boxes is second.boxes and first.stage is second.stage


def test_every_word_of_a_real_moment_can_be_told(album):
    last = album.snapshots[-1]
    assert "lead" in words.tree(last) and "regions" in words.figures(last) and "%" in words.rejections(last)
    assert "Control: client 3, 1 connected" in words.headline(last, 0.0, AuthorityState(3, (), (3,)))
    assert "Nothing is heard" in words.headline(last, 5.0, AuthorityState(None, (), ()))
    for request in album.asked:
        assert str(request.item_id) in words.describe_request(request)


def test_text_of_others_stays_text():
    hostile = "<script>alert(1)</script>"
    told = words.history((LogLine(1.0, "/a/<b>", "warning", hostile),))
    assert "<script>" not in told and "<b>:" not in told and "&lt;script&gt;" in told
    request: Any = ReviewRequest("a|b*<i>", 1, object(), "/x", 0.0)
    assert "<i>" not in words.describe_request(request)
