"""What the command line says, and with which exit status."""

import json

import pytest

from lookstep.__main__ import main
from lookstep.commands import COMMANDS
from strict_yaml import shipped


@pytest.mark.parametrize("command", COMMANDS, ids=lambda command: command.NAME)
def test_every_command_explains_itself_with_an_example(command, capsys):
    with pytest.raises(SystemExit) as end:
        main([command.NAME, "--help"])
    assert end.value.code == 0
    assert command.EXAMPLE in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--tree", "look_and_stp"], '--tree: unknown tree "look_and_stp"; did you mean "look_and_step"?'),
        (["--course", "rogh"], 'unknown course "rogh"; did you mean "rough"?'),
        (["--set", "footsteps.reech=0.5"], 'unknown key "reech"; did you mean "reach"?'),
        (["--set", "footsteps.reach=9"], "footsteps.reach: got 9, allowed: 0.1 .. 1 m"),
        (["--set", "footsteps.reach=far"], 'footsteps.reach: got "far", needs a number'),
        (["--set", "fotsteps.reach=1"], 'unknown subject "fotsteps"; did you mean "footsteps"?'),
        (["--set", "reach"], "needs the form subject.key=value"),
        (["--set", "course.tilted_shar=1.0"], "tilted_shar"),
        (["--set", "/look_and_step/wal.latency=1"], 'no node "/look_and_step/wal"'),
        (["--preset", "papr"], 'unknown preset "papr"; did you mean "paper"?'),
        (["--speed", "-1"], "--speed: got -1.0, needs a positive number"),
        (["--seed", "-1"], "--seed: got -1"),
        (["--time-limit", "0"], "--time-limit: got 0.0"),
    ],
)
def test_bad_input_is_named_with_what_is_allowed_and_exits_with_2(arguments, message, capsys, tmp_path):
    out = tmp_path / "out"
    assert main(["run", *arguments, "--out", str(out)]) == 2
    assert message in capsys.readouterr().err
    assert not out.exists()


def test_goal_that_is_no_goal_is_refused(capsys):
    with pytest.raises(SystemExit) as end:
        main(["run", "--goal", "1,2"])
    assert end.value.code == 2
    assert "needs X,Y,YAW" in capsys.readouterr().err


def test_check_tells_every_problem_of_a_tree_with_its_place(tmp_path, capsys):
    tree = tmp_path / "mine.yaml"
    tree.write_text("tree: mine\nroot:\n  sequence:\n    - PlanFootstep\n    - RobotFallen: {patience: 3}\n")
    assert main(["check", str(tree)]) == 2
    told = capsys.readouterr().err
    assert f'{tree}:4:7: /mine: unknown node "PlanFootstep"' in told or f"{tree}:4:7" in told
    assert 'did you mean "PlanFootsteps"' in told
    assert f"{tree}:5" in told


def test_check_tells_a_course_from_a_tree(capsys):
    courses = [str(shipped("config", "courses", f"{name}.yaml")) for name in ("stairs", "gaps")]
    assert main(["check", "look_and_step", *courses]) == 0
    told = capsys.readouterr().out
    assert told.count("sound (tree)") == 1
    assert told.count("sound (course)") == 2


def test_tree_is_drawn_with_every_leaf(capsys):
    assert main(["tree", "look_and_step"]) == 0
    drawn = capsys.readouterr().out
    for leaf in ("ExtractRegions", "PlanFootsteps", "SendFootsteps", "WaitForSwing"):
        assert leaf in drawn


def test_run_that_does_not_reach_its_goal_exits_with_1_and_writes_its_figures(tmp_path, capsys):
    figures = tmp_path / "figures.json"
    arguments = ["run", "--course", "flat", "--time-limit", "0.5", "--set", "camera.resolution=0.3125"]
    assert main([*arguments, "--json", str(figures)]) == 1
    assert "timeout" in capsys.readouterr().out
    table = json.loads(figures.read_text())
    assert table["outcome"] == "timeout"
    assert set(table["steps"]) == {"total", "flat", "uneven_flat", "rough", "ramp", "reactive"}
    assert set(table["plan"]) >= {"count", "median_ms", "p99_ms", "deadline_misses"}
