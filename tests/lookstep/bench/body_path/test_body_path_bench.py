"""The judge of walls knows a touch from none, and the command writes what it has found."""

from __future__ import annotations

import json

import numpy as np
import pytest

from lookstep.__main__ import main
from lookstep.bench.body_path import report
from lookstep.bench.body_path.random_maps import random_map
from lookstep.bench.body_path.wall_check import touches
from skills.body_path import BodyPath

SQUARE = np.array([[[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]])


def straight(x: float, y: float, to_x: float, to_y: float) -> BodyPath:
    yaw = np.arctan2(to_y - y, to_x - x)
    return BodyPath(np.array(((x, y, yaw), (to_x, to_y, yaw))))


@pytest.mark.parametrize("turn", [0.0, 0.4, 1.2, 2.9])
@pytest.mark.parametrize(
    ("path", "touched"),
    [
        ((-1.0, -0.41, 2.0, -0.41), False),
        ((-1.0, -0.39, 2.0, -0.39), True),
        ((-1.0, 1.41, 2.0, 1.41), False),
        ((-1.0, 0.5, -0.21, 0.5), False),
        ((-1.0, 0.5, -0.19, 0.5), True),
        ((0.4, 0.4, 0.6, 0.6), True),
    ],
)
def test_a_body_touches_an_obstacle_or_does_not_however_both_are_turned(path, touched, turn):
    R = np.array(((np.cos(turn), -np.sin(turn)), (np.sin(turn), np.cos(turn))))
    ends = R @ np.array(path).reshape(2, 2).T
    turned = straight(*ends[:, 0], *ends[:, 1])
    assert touches(turned, SQUARE @ R.T, 0.4, 0.8) is touched


def test_the_same_seed_gives_the_same_map_whose_obstacles_stand_where_they_are_said():
    scene, again = random_map(5), random_map(5)
    np.testing.assert_array_equal(scene.height_map.heights, again.height_map.heights)
    middles = scene.height_map.nearest(scene.obstacles.mean(axis=1))
    assert np.nanmin(middles) > 0.5


def test_the_command_writes_times_costs_and_what_touched(tmp_path, monkeypatch, capsys):
    monkeypatch.setattr(report, "QUICK", report.Extent(1, 0.01, 2))
    file = tmp_path / "figures.json"
    assert main(["bench", "body_path", "--quick", "--planners", "RRTConnect", "--json", str(file)]) == 0
    figures = json.loads(file.read_text())
    assert 0.0 < figures["plan_ms"]["median"] <= figures["plan_ms"]["p99"]
    assert figures["cost_over_best"]["median"] >= 1.0
    assert figures["planners"]["RRTConnect"]["solved"] == 1
    assert figures["walls"] == {"maps": 2, "touched": 0, "seeds": [], "short": 0}
    assert "RRTConnect" in capsys.readouterr().out


def test_an_unknown_planner_is_refused(capsys):
    assert main(["bench", "body_path", "--planners", "RTT"]) == 2
    assert "unknown RTT (planners: RRTstar" in capsys.readouterr().err
