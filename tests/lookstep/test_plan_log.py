"""Plan logs: what is written is what is read, planned again to the bit, listed, shown; or an error that helps."""

import dataclasses
import json
import zipfile
from collections import Counter
from pathlib import Path

import numpy as np
import pytest
from rerun.chunk import RrdReader

from lookstep.__main__ import main
from lookstep.plan_log import LoggedPlan, PlanFileError, read_plan, write_plan
from skills.body_path import SubGoalParameters, straight_path, sub_goal
from skills.footsteps import (
    FootstepParameters,
    FootstepPlan,
    PlanRequest,
    SearchLog,
    Side,
    Stance,
    TerrainParameters,
    plan_on_request,
)
from skills.footsteps.rejections import OUTSIDE, REASONS
from skills.geometry import Pose
from skills.regions import PlanarRegion, PlanarRegions


def block(x: float, y: float, z: float, pitch: float = 0.0, size: float = 0.37) -> PlanarRegion:
    half = 0.5 * size
    outline = np.array(((-half, -half), (half, -half), (half, half), (-half, half)))
    hole = 0.1 * outline[::-1]
    return PlanarRegion(Pose.from_xyz_rpy((x, y, z), (0.0, pitch, 0.0)), outline, (outline,), size**2, 1.5, (hole,))


@pytest.fixture(scope="module")
def logged() -> LoggedPlan:
    """A plan past blocks 0.29 m high, which is too high."""
    blocks = [block(0.5 + 0.37 * i, 0.37 * j, 0.1, 0.1 * (i % 2)) for i in range(4) for j in (-1, 0, 1)]
    blocks[0] = block(0.5, -0.37, 0.29)
    blocks[1] = block(0.5, 0.0, 0.29)
    ground = PlanarRegions((block(0.0, 0.0, 0.0, size=0.7), *blocks), 2.0, 7)
    stance = Stance(*(Pose.from_xyz_rpy((0.0, 0.12 * s, 0.0)) for s in (1, -1)))
    goal = sub_goal(straight_path(np.zeros(3), np.array((3.0, 0.0, 0.0))), stance, SubGoalParameters())
    request = PlanRequest(
        ground, goal, stance, Side.LEFT, 12, 40, None, FootstepParameters(heuristic_weight=1.0), TerrainParameters()
    )
    searches: list[SearchLog] = []
    plan = plan_on_request(request, logs=searches)
    assert plan.steps
    return LoggedPlan(dataclasses.replace(request, reference=plan), plan, tuple(searches), 3.25, 4.5)


@pytest.fixture
def file(logged: LoggedPlan, tmp_path: Path) -> Path:
    path = tmp_path / "0012.plan"
    write_plan(path, logged)
    return path


def test_a_plan_log_holds_what_was_put_into_it(logged: LoggedPlan, file: Path):
    read = read_plan(file)
    assert (read.time, read.compute_ms) == (3.25, 4.5)
    assert (read.request.footsteps, read.request.terrain) == (logged.request.footsteps, logged.request.terrain)
    assert same_steps(read.plan, logged.plan)
    assert dataclasses.replace(read.plan, steps=()).__repr__() == dataclasses.replace(logged.plan, steps=()).__repr__()
    for one, other in zip(read.request.ground.regions, logged.request.ground.regions, strict=True):
        assert one.T_world_region.R.tobytes() == other.T_world_region.R.tobytes()
        assert one.holes_region[0].tobytes() == other.holes_region[0].tobytes()
        assert (one.area, one.time) == (other.area, other.time)
    (search,), (wanted,) = read.searches, logged.searches
    assert search.edges.tobytes() == wanted.edges.tobytes()
    assert (search.shape, search.start, search.yaw) == (wanted.shape, wanted.start, wanted.yaw)
    assert [child.name for child in file.parent.iterdir()] == [file.name]


def same_steps(a: FootstepPlan, b: FootstepPlan) -> bool:
    return len(a.steps) == len(b.steps) and all(
        x.T_world_sole.p.tobytes() == y.T_world_sole.p.tobytes()
        and x.T_world_sole.R.tobytes() == y.T_world_sole.R.tobytes()
        and x.foothold_sole.tobytes() == y.foothold_sole.tobytes()
        and x.swing_waypoints_world.tobytes() == y.swing_waypoints_world.tobytes()
        and (x.sequence_id, x.side, x.swing_duration, x.margin) == (y.sequence_id, y.side, y.swing_duration, y.margin)
        for x, y in zip(a.steps, b.steps, strict=True)
    )


def test_a_request_that_was_read_gives_the_same_plan_to_the_bit(file: Path):
    read = read_plan(file)
    fresh = dataclasses.replace(read.request, reference=None)
    assert same_steps(plan_on_request(fresh), read.plan)


def test_the_search_is_logged_whole(logged: LoggedPlan):
    (search,) = logged.searches
    assert np.count_nonzero(search.expanded) == logged.plan.expansions
    rejected = Counter(REASONS[reason] for reason in search.edges["reason"][~(search.expanded | search.opened)])
    counted = dict(logged.plan.rejections)
    ground = {reason for reason in counted if REASONS.index(reason) >= REASONS.index("no ground")} - {REASONS[OUTSIDE]}
    assert {"step too high", "no ground"} <= ground
    assert {reason: rejected[reason] for reason in ground} == {reason: counted[reason] for reason in ground}


def test_logging_a_search_does_not_change_its_plan(logged: LoggedPlan):
    fresh = dataclasses.replace(logged.request, reference=None)
    assert same_steps(plan_on_request(fresh), logged.plan)


def test_each_step_of_a_plan_was_opened_by_the_search(logged: LoggedPlan):
    (search,) = logged.searches
    places, left = search.places(search.edges["node"][search.opened])
    for step in logged.plan.steps:
        near = np.hypot(*(places[:, :2] - step.T_world_sole.p[:2]).T) < 1.5 * logged.request.footsteps.wiggle_move
        assert np.any(near & (left == (step.side is Side.LEFT)))


def test_a_file_of_another_version_or_kind_is_refused(file: Path, tmp_path: Path):
    with np.load(file) as loaded:
        arrays = dict(loaded)
    header = json.loads(bytes(arrays["header"]))
    for change, message in (
        ({"version": 99}, "version 99"),
        ({"format": "cake"}, 'is a "cake"'),
        ({"plan": 3}, "damaged"),
    ):
        arrays["header"] = np.frombuffer(json.dumps({**header, **change}).encode(), dtype=np.uint8)
        other = tmp_path / "other.plan"
        with other.open("wb") as stream:
            np.savez_compressed(stream, **arrays)
        with pytest.raises(PlanFileError, match=message):
            read_plan(other)


def test_parameters_of_another_version_are_taken_or_left_out(logged: LoggedPlan, file: Path, tmp_path: Path):
    with np.load(file) as loaded:
        arrays = dict(loaded)
    header = json.loads(bytes(arrays["header"]))
    header["footsteps"] |= {"levitation": 3.0, "reach": 0.5}
    del header["footsteps"]["share"]
    arrays["header"] = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
    with file.open("wb") as stream:
        np.savez_compressed(stream, **arrays)
    assert read_plan(file).request.footsteps == dataclasses.replace(logged.request.footsteps, reach=0.5)


@pytest.mark.parametrize("kind", ["missing", "folder", "text", "cut", "empty"])
def test_what_is_no_plan_log_ends_with_2_and_says_so(kind: str, file: Path, tmp_path: Path, capsys):
    bad = {
        "missing": tmp_path / "none.plan", "folder": tmp_path, "text": tmp_path / "text.plan",
        "cut": tmp_path / "cut.plan", "empty": tmp_path / "empty.plan",
    }[kind]  # fmt: skip
    if kind == "text":
        bad.write_text("left, right, left")
    elif kind == "cut":
        bad.write_bytes(file.read_bytes()[:-500])
    elif kind == "empty":
        bad.write_bytes(b"")
    assert main(["plan", str(bad)]) == 2
    assert str(bad) in capsys.readouterr().err


def test_plan_shows_the_search_and_plans_again(file: Path, tmp_path: Path, capsys):
    record = tmp_path / "both.rrd"
    assert main(["plan", str(file), "--set", "footsteps.max_step_height=0.3", "--record", str(record)]) == 0
    printed = capsys.readouterr().out
    assert "as logged" in printed and "planned again" in printed
    line = next(line for line in printed.splitlines() if line.startswith("step too high"))
    assert "%" in line and line.rstrip().endswith("-")
    entities = {str(path) for chunk in RrdReader(record).stream() for path in [chunk.entity_path]}
    for result in ("as_logged", "planned_again"):
        assert f"/{result}/search_left_first/expanded" in entities
    assert "/as_logged/search_left_first/rejected/step_too_high" in entities
    assert "/planned_again/search_left_first/rejected/step_too_high" not in entities


def test_only_what_a_plan_depends_on_can_be_set(file: Path, capsys):
    assert main(["plan", str(file), "--set", "walking.height=1"]) == 2
    assert "footsteps.KEY=VALUE" in capsys.readouterr().err
    assert main(["plan", str(file), "--set", "footsteps.max_step_hight=1"]) == 2
    assert "max_step_height" in capsys.readouterr().err


def test_plans_lists_the_logs_of_a_folder(file: Path, tmp_path: Path, capsys):
    assert main(["plans", str(tmp_path), "--json", str(tmp_path / "list.json")]) == 0
    assert "0012.plan" in capsys.readouterr().out
    (row,) = json.loads((tmp_path / "list.json").read_text())["plans"]
    assert (row["file"], row["first"], row["time s"], row["ms"]) == ("0012.plan", "left", 3.25, 4.5)
    assert main(["plans", str(tmp_path / "none")]) == 2


def test_a_plan_log_is_compact(file: Path, logged: LoggedPlan):
    assert len(logged.searches[0].edges) > 1000
    assert file.stat().st_size < 6 * len(logged.searches[0].edges) + 20_000
    assert zipfile.is_zipfile(file)
