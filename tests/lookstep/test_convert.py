"""`lookstep convert`: files in, files out, and nothing written where something cannot be said."""

from __future__ import annotations

import sqlite3
from pathlib import Path

import pytest

import lookstep
from lookstep.__main__ import main
from strict_yaml import shipped


def test_the_shipped_tree_goes_to_xml_and_back(tmp_path: Path, capsys: pytest.CaptureFixture[str]):
    xml, yaml = tmp_path / "tree.xml", tmp_path / "tree.yaml"
    assert main(["convert", "look_and_step", str(xml)]) == 0
    assert main(["convert", str(xml), str(yaml)]) == 0
    assert main(["check", "--strict", str(yaml)]) == 0
    lines = [line.partition(" #")[0] for line in shipped("trees", "look_and_step.yaml").read_text().splitlines()[1:]]
    assert yaml.read_text().splitlines() == lines
    assert main(["convert", "leaves", str(tmp_path / "palette.xml")]) == 0
    assert 'ID="PlanFootsteps"' in (tmp_path / "palette.xml").read_text()


def test_a_run_becomes_a_log(tmp_path: Path):
    run, log = tmp_path / "run", tmp_path / "run.db3"
    lookstep.run(course="flat", world="kinematic", time_limit=0.5, assignments=("camera.resolution=0.3125",), out=run)
    assert main(["convert", str(run), str(log)]) == 0
    with sqlite3.connect(log) as database:
        (count,) = database.execute("SELECT COUNT(*) FROM Transitions WHERE state = 1").fetchone()
    database.close()
    assert count > 10


@pytest.mark.parametrize(
    ("source", "target", "message"),
    [
        ("look_and_step", "tree.txt", "needs .yaml or .xml"),
        ("look_and_stp", "tree.xml", 'did you mean "look_and_step"?'),
        ("missing.xml", "tree.yaml", "cannot read the file"),
        ("bad.xml", "tree.yaml", "bad.xml:1:36: node <OpenDoor> is not supported"),
        ("bad.yaml", "tree.xml", "bad.yaml:2:7: /t: unknown leaf"),
        ("look_and_step", "nowhere/tree.xml", "does not exist"),
        (".", "log.xml", "a run becomes a log, .db3 or .btdb"),
        (".", "log.db3", "cannot read the trace"),
    ],
)
def test_what_cannot_be_converted_is_told_and_nothing_is_written(
    source: str, target: str, message: str, tmp_path: Path, monkeypatch, capsys: pytest.CaptureFixture[str]
):
    monkeypatch.chdir(tmp_path)
    Path("bad.xml").write_text('<root><BehaviorTree ID="main_tree"><OpenDoor/></BehaviorTree></root>')
    Path("bad.yaml").write_text("tree: t\nroot: OpenDoor\n")
    assert main(["convert", source, target]) == 2
    assert message in capsys.readouterr().err
    assert not Path(target).exists()
