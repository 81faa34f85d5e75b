"""The page on how it walks: its links lead somewhere, its times and limits are the code's, it explains every figure."""

from __future__ import annotations

import dataclasses
import json
import re
from pathlib import Path

import pytest

import lookstep
from behaviors import load_tree
from lookstep.configuration import load_configuration
from lookstep.summary import Summary
from sim_envs.judge import PauseCause

ROOT = Path(__file__).parents[2]
PAGES = sorted((ROOT / "docs").glob("*.md"))
PAGE = (ROOT / "docs" / "how_it_walks.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_every_link_leads_to_a_file(page):
    targets = re.findall(r"\]\(([^)#:]+)\)", page.read_text(encoding="utf-8"))
    assert [target for target in targets if not (page.parent / target).exists()] == []


def test_things_happen_when_the_page_says(tmp_path):
    """From lift-off to lift-off of the second step of a walk."""
    assignments = ("camera.resolution=0.3125",)
    lookstep.run(course="flat", time_limit=5.2, assignments=assignments, out=tmp_path)
    ticks = [json.loads(line) for line in (tmp_path / "trace.jsonl").read_text().splitlines()[1:]]
    lift_off, next_lift_off = (time_of(ticks, "started", step) for step in (1, 2))
    happened = [0.0, next_lift_off - lift_off, time_of(ticks, "completed", 1) - lift_off]
    for tick in ticks:
        if lift_off < tick["time"] < next_lift_off:
            changes = {path.rpartition("/")[2]: status for path, status in tick.get("status", {}).items()}
            expected = {("wait_for_swing", "SUCCESS"), ("plan_footsteps", "RUNNING"), ("plan_footsteps", "SUCCESS")}
            happened += [tick["time"] - lift_off for _ in expected & changes.items()]
            sent = [command for command in tick.get("commands", []) if command["name"] == "send_footsteps"]
            assert not sent or changes["plan_footsteps"] == "SUCCESS"
    told = [float(time) for time in re.findall(r"^\| (\d\.\d\d) \|", PAGE, re.MULTILINE)]
    # A foot lands when the ground comes, up to two ticks after its time.
    assert sorted(happened) == pytest.approx(told, abs=0.021)


def test_every_key_of_the_summary_is_explained():
    table = PAGE[PAGE.index("## What `summary.json` says") :]
    explained = set(re.findall(r"`(\w+)`", table))
    assert {field.name for field in dataclasses.fields(Summary)} <= explained


def test_causes_of_pauses_that_the_page_names_exist():
    assert {"dcm_hold", "no_plan"} <= {cause.value for cause in PauseCause}


def test_limits_of_a_fall_are_the_shipped_ones():
    configuration = load_configuration()
    falls, walking = configuration.falls, configuration.walking
    for text in (
        f"more than {100 * falls.dcm_margin:.0f} cm outside the hull",
        f"more than {100 * falls.swing_penetration:.0f} cm deep",
        f"less than {100 * falls.support_share:.0f} % of a stance sole has ground within "
        f"{100 * falls.support_tolerance:.0f} cm",
        f"every {falls.standing_check_period:g} s",
        f"more than {100 * walking.fall_distance:.0f} cm off its plan",
    ):
        assert text in PAGE


def test_the_camera_and_the_look_ahead_are_the_shipped_ones():
    configuration = load_configuration()
    camera, sub_goal, (mount,) = configuration.camera, configuration.sub_goal, configuration.robot.cameras
    flowing = " ".join(PAGE.split())
    for text in (
        f"{camera.rate:.0f} frames a second from the {mount.body}, {mount.pitch_deg:.0f} degrees below",
        f"{camera.width} x {camera.height} pixels, {camera.horizontal_fov_deg:.0f} x {camera.vertical_fov_deg:.0f}",
        f"{sub_goal.ahead:g} m ahead along the body path, {sub_goal.ahead_in_curve:g} m in tight curves",
    ):
        assert text in flowing


def test_the_node_that_the_page_sets_exists():
    tree = load_tree(ROOT / "trees" / "look_and_step.yaml")
    ((path, key),) = re.findall(r"--set (/[\w/]+)\.(\w+)=", PAGE)
    (node,) = [node for node in tree if node.path == path]
    assert key in {field.name for field in dataclasses.fields(node.parameters)}


def time_of(ticks: list[dict], kind: str, step: int) -> float:
    """Robot time of a step's event."""
    (time,) = [t["time"] for t in ticks if {"kind": kind, "step": step} in t.get("events", [])]
    return time
