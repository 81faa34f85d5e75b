"""Config files, presets and assignments."""

import pytest

from lookstep.configuration import (
    SUBJECTS,
    config_files,
    load_configuration,
    preset_names,
    robot_names,
    split_assignments,
)
from strict_yaml import YamlError, shipped


@pytest.mark.parametrize("name", sorted(config_files()))
def test_shipped_config_says_what_the_classes_say(name):
    assert shipped("config", name).read_text() == config_files()[name], "run: python -m lookstep.configuration"


@pytest.mark.parametrize("preset", preset_names())
def test_every_shipped_preset_is_valid(preset):
    load_configuration(preset)


def test_assignment_wins_over_preset_and_preset_over_config(tmp_path):
    preset = tmp_path / "slow.yaml"
    preset.write_text("footsteps: {swing_duration: 1.5, transfer_duration: 0.9}\n")
    configuration = load_configuration(str(preset), ["footsteps.transfer_duration=0.7"])
    assert configuration.footsteps.swing_duration == 1.5
    assert configuration.footsteps.transfer_duration == 0.7
    assert configuration.footsteps.reach == load_configuration().footsteps.reach


@pytest.mark.parametrize("robot", robot_names())
def test_every_shipped_robot_is_valid(robot):
    assert load_configuration(robot=robot).robot.mjcf_path.is_file()


def test_the_default_robot_is_what_the_classes_say():
    assert all(load_configuration().by_subject()[subject] == cls() for subject, cls in SUBJECTS.items())


def test_a_robot_wins_over_config_and_a_preset_over_the_robot(tmp_path):
    preset = tmp_path / "high.yaml"
    preset.write_text("walking: {com_height: 0.68}\n")
    courier, high = load_configuration(robot="courier"), load_configuration(str(preset), robot="courier")
    assert courier.walking.com_height != load_configuration().walking.com_height
    assert high.walking.com_height == 0.68
    assert high.walking.posture == courier.walking.posture
    assert {name for name, _ in courier.walking.posture}.isdisjoint(
        name for name, _ in load_configuration().walking.posture
    )


def test_a_robot_of_ones_own_finds_its_mjcf_file_beside_it(tmp_path):
    (tmp_path / "walker.xml").write_text("<mujoco/>")
    robot = tmp_path / "walker.yaml"
    robot.write_text("robot:\n  mjcf: walker.xml\n")
    assert load_configuration(robot=str(robot)).robot.mjcf_path == tmp_path / "walker.xml"
    robot.write_text("robot:\n  mjcf: walkr.xml\n")
    with pytest.raises(YamlError, match=rf"{robot}:2:9: robot.mjcf: there is no MJCF file 'walkr.xml'"):
        load_configuration(robot=str(robot))
    with pytest.raises(YamlError, match='unknown robot "courir"; did you mean "courier"'):
        load_configuration(robot="courir")


def test_all_problems_are_told_at_once_each_at_its_place(tmp_path):
    preset = tmp_path / "broken.yaml"
    preset.write_text("footsteps:\n  swing_duration: fast\n  reech: 1.0\nlegs: {count: 2}\n")
    with pytest.raises(YamlError) as error:
        load_configuration(str(preset))
    told = str(error.value).splitlines()
    assert [line.split(" ")[0] for line in told] == [f"{preset}:2:19:", f"{preset}:3:3:", f"{preset}:4:1:"]


def test_assignments_are_sorted_by_what_they_are_for():
    sorted_ = split_assignments(["footsteps.reach=0.4", "course.tilted_share=1.0", "/a/b.latency=0.3", "/a/b.x=2"])
    assert sorted_.subjects == ("footsteps.reach=0.4",)
    assert sorted_.course == {"tilted_share": 1.0}
    assert sorted_.nodes == {"/a/b": {"latency": 0.3, "x": 2}}


def test_every_parameter_has_unit_and_meaning():
    import dataclasses

    for subject, cls in SUBJECTS.items():
        for field in dataclasses.fields(cls):
            assert field.metadata.get("unit") and field.metadata.get("meaning"), f"{subject}.{field.name}"
