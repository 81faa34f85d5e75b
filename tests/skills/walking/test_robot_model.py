from pathlib import Path

import numpy as np
import pytest

from skills.footsteps.footstep import Side
from skills.geometry.pose import Array
from skills.walking import RobotError, RobotModel

MJCF = Path(__file__).parents[3] / "sim_envs" / "robot" / "atlas_class.xml"


def random_configuration(model: RobotModel, seed: int) -> Array:
    rng = np.random.default_rng(seed)
    q = model.neutral_configuration()
    q[:3] = rng.uniform(-1.0, 1.0, 3)
    q[3:7] = rng.normal(size=4)
    q[3:7] /= np.linalg.norm(q[3:7])
    q[7:] = rng.uniform(model.lower_limits, model.upper_limits)
    return q


def test_it_reads_the_robot(model: RobotModel) -> None:
    assert len(model.joint_names) == 23
    assert model.mass == pytest.approx(174.0, abs=1.5)
    assert np.all(model.lower_limits < model.upper_limits)
    for side in Side:
        names = [model.joint_names[joint] for joint in model.legs[side].joints]
        assert names == [
            f"{side.value}_{joint}"
            for joint in ("hip_yaw", "hip_roll", "hip_pitch", "knee", "ankle_pitch", "ankle_roll")
        ]


@pytest.mark.parametrize("knee", (0.0, 0.5, 1.5, 2.3))
def test_a_leg_is_as_long_as_its_knee_says(model: RobotModel, knee: float) -> None:
    for side in Side:
        leg = model.legs[side]
        q = random_configuration(model, 5)
        q[7 + leg.joints[3]] = knee
        hip = model.frame_pose(q, f"{side.value}_thigh").p
        ankle = model.sole_pose(q, side) @ leg.p_sole_ankle
        assert np.linalg.norm(hip - ankle) == pytest.approx(leg.length(knee), abs=1e-9)


def test_missing_files_and_frames_are_named(model: RobotModel, tmp_path: Path) -> None:
    with pytest.raises(ValueError, match=r"nowhere\.xml: there is no such MJCF file"):
        RobotModel(tmp_path / "nowhere.xml")
    with pytest.raises(ValueError, match="no frame 'tail'"):
        model.frame_pose(model.neutral_configuration(), "tail")
    (tmp_path / "paws.xml").write_text(MJCF.read_text().replace("left_sole", "left_paw"))
    with pytest.raises(ValueError, match="there is no site 'left_sole'"):
        RobotModel(tmp_path / "paws.xml")


@pytest.fixture(scope="module")
def courier() -> RobotModel:
    return RobotModel(MJCF.with_name("courier.xml"), 0.2, 0.096, "chest")


def test_joints_are_known_by_their_place_and_axis_whatever_their_names_and_order(courier: RobotModel) -> None:
    assert courier.mass == pytest.approx(45.0, abs=0.1)
    for side, name in ((Side.LEFT, "port"), (Side.RIGHT, "starboard")):
        leg = courier.legs[side]
        bending = [courier.joint_names[joint] for joint in (leg.hip_pitch, leg.knee, leg.ankle_pitch)]
        assert bending == [f"{name}_hip_swing", f"{name}_kneecap", f"{name}_foot_nod"]
        q = courier.neutral_configuration()
        q[[7 + leg.hip_pitch, 7 + leg.knee, 7 + leg.ankle_pitch]] = -0.5, 1.0, -0.5
        # Bent like that the sole is level and under the hip.
        sole = courier.sole_pose(q, side)
        np.testing.assert_allclose(sole.R, np.eye(3), atol=1e-9)
        ankle = sole @ leg.p_sole_ankle
        assert ankle[0] == pytest.approx(leg.p_pelvis_hip[0], abs=1e-9)
        assert leg.p_pelvis_hip[2] - ankle[2] == pytest.approx(leg.length(1.0), abs=1e-9)
    assert [courier.joint_names[joint] for joint in courier.back] == ["waist"]


def test_a_knee_that_bends_the_other_way_is_refused_by_name(tmp_path: Path) -> None:
    path, knee = tmp_path / "bird.xml", '<joint name="port_kneecap" class="leg" axis="0 1 0"'
    text = MJCF.with_name("courier.xml").read_text()
    assert knee in text
    path.write_text(text.replace(knee, knee.replace("0 1 0", "0 -1 0")))
    with pytest.raises(RobotError, match=r"left leg bends about \+y at port_hip_swing, port_foot_nod; .*port_kneecap"):
        RobotModel(path, torso="chest")
