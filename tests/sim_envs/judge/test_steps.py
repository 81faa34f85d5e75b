import numpy as np
import pytest

from sim_envs.courses import Box, Ground
from sim_envs.judge import BoxMoved, StepKind, TrueStep, classify_step, count_steps, judge_step, support_fraction
from skills.footsteps.footstep import Side
from skills.geometry.pose import Pose

SOLE = (0.26, 0.138)


def sole(x=0.0, y=0.0, z=0.0, roll_deg=0.0, pitch_deg=0.0, yaw_deg=0.0):
    return Pose.from_xyz_rpy((x, y, z), np.radians((roll_deg, pitch_deg, yaw_deg)))


def on_ramp(x, y, pitch_deg):
    """A sole on the plane through the origin that falls along x."""
    pitch = np.radians(pitch_deg)
    return sole(x, y, -np.tan(pitch) * x, pitch_deg=pitch_deg)


CASES = {
    "all level and coplanar": (sole(0, 0.12), sole(-0.4, -0.12), sole(0.4, -0.12), StepKind.FLAT),
    "heading does not matter": (sole(0, 0.12, yaw_deg=40), sole(-0.4, -0.12), sole(0.4, yaw_deg=170), StepKind.FLAT),
    "9 mm is coplanar": (sole(), sole(-0.4), sole(0.4, z=0.009), StepKind.FLAT),
    "11 mm is not": (sole(), sole(-0.4), sole(0.4, z=0.011), StepKind.UNEVEN_FLAT),
    "stance above both": (sole(z=0.1), sole(-0.4), sole(0.4), StepKind.UNEVEN_FLAT),
    "2.9 degrees is level": (sole(), sole(-0.4), sole(0.4, pitch_deg=2.9), StepKind.FLAT),
    "3.1 degrees is not": (sole(), sole(-0.4), sole(0.4, pitch_deg=3.1), StepKind.ROUGH),
    "level each, 5 degrees between": (sole(), sole(roll_deg=2.5), sole(roll_deg=-2.5), StepKind.UNEVEN_FLAT),
    "one tilted": (sole(), sole(-0.4, roll_deg=-15), sole(0.4), StepKind.ROUGH),
    "a ramp": (on_ramp(0, 0.1, -10), on_ramp(-0.4, -0.1, -10), on_ramp(0.4, -0.1, -10), StepKind.RAMP),
    "onto the ramp": (sole(0, 0.1), sole(-0.4, -0.1), on_ramp(0.4, -0.1, -10), StepKind.ROUGH),
    "parallel planes": (sole(pitch_deg=10), sole(-0.4, pitch_deg=10), sole(0.4, pitch_deg=10), StepKind.ROUGH),
}


@pytest.mark.parametrize("name", CASES)
def test_kind_of_step_follows_the_definitions(name):
    stance, start, end, kind = CASES[name]
    assert classify_step(stance, start, end) is kind


def test_kind_of_step_depends_on_no_frame_of_heading():
    generator = np.random.default_rng(0)
    for stance, start, end, kind in CASES.values():
        T = Pose.from_xyz_rpy(generator.uniform(-5, 5, 3), (0.0, 0.0, generator.uniform(-np.pi, np.pi)))
        assert classify_step(T @ stance, T @ start, T @ end) is kind


def box(name, x, y=0.0, top=0.0, size=(0.4, 0.4, 0.2)):
    return Box(name, size, Pose.from_xyz_rpy((x, y, top - size[2] / 2)), "block")


def test_support_is_the_share_of_the_area_over_ground():
    ground = Ground((box("a", 0.0),))
    assert support_fraction(sole(), SOLE, ground) == 1.0
    for overhang in (0.05, 0.13, 0.2, 0.26):
        x = 0.2 + overhang - SOLE[0] / 2
        expected = 1.0 - overhang / SOLE[0]
        assert support_fraction(sole(x), SOLE, ground) == pytest.approx(expected, abs=0.5 * 0.01 / SOLE[0] + 0.02)
    assert support_fraction(sole(5.0), SOLE, ground) == 0.0


def test_support_ends_a_centimetre_from_the_ground():
    ground = Ground((box("a", 0.0),))
    assert support_fraction(sole(z=0.009), SOLE, ground) == 1.0
    assert support_fraction(sole(z=0.011), SOLE, ground) == 0.0
    assert support_fraction(sole(z=-0.011), SOLE, ground) == 0.0
    # A sole pitched about its centre leaves the ground where half its length times the sine passes 1 cm.
    pitched = support_fraction(sole(pitch_deg=10.0), SOLE, ground)
    assert pitched == pytest.approx(0.02 / np.sin(np.radians(10.0)) / SOLE[0], abs=0.04)


def test_support_on_a_tilted_block_is_whole():
    T_world_box = Pose.from_xyz_rpy((1.0, 2.0, 0.3), np.radians((12.0, -14.0, 30.0)))
    ground = Ground((Box("a", (0.4, 0.4, 0.2), T_world_box, "block"),))
    T_world_sole = T_world_box @ Pose.from_xyz_rpy((0.0, 0.0, 0.1), (0.0, 0.0, 0.4))
    assert support_fraction(T_world_sole, SOLE, ground) == 1.0


def step(end=None):
    return TrueStep(7, Side.LEFT, 10.0, 11.2, sole(0.0, -0.12), sole(-0.3, 0.12), end or sole(0.4, 0.12))


def test_judgement_holds_the_figures_of_the_step():
    ground = Ground((box("near", 0.0), box("far", 0.4, 0.12, top=0.1)))
    judged = judge_step(step(sole(0.4, 0.12, 0.1)), SOLE, ground)
    assert (judged.sequence_id, judged.side, judged.start_time, judged.end_time) == (7, Side.LEFT, 10.0, 11.2)
    assert judged.kind is StepKind.UNEVEN_FLAT
    assert judged.boxes == ("far",)
    assert judged.support_fraction == 1.0
    assert judged.tilt == 0.0
    assert judged.length == pytest.approx(np.hypot(0.4, 0.24))
    assert judged.max_step_height == pytest.approx(0.1)
    assert not judged.reactive


@pytest.mark.parametrize(
    ("move", "reactive"),
    [
        (BoxMoved("far", 8.0, 1.0), True),
        (BoxMoved("far", 11.1, 0.4), True),
        (BoxMoved("far", 8.0, 3.0), False),
        (BoxMoved("far", 11.3, 0.3), False),
        (BoxMoved("near", 8.0, 1.0), False),
    ],
)
def test_reactive_is_a_foothold_that_moved_during_the_approach(move, reactive):
    ground = Ground((box("near", 0.0, -0.12), box("far", 0.4, 0.12)))
    assert judge_step(step(), SOLE, ground, (move,)).reactive is reactive


def test_counts_add_up():
    ground = Ground((box("near", 0.0), box("far", 0.4, 0.12)))
    moves = (BoxMoved("far", 8.0, 1.0),)
    judged = [judge_step(step(), SOLE, ground), judge_step(step(), SOLE, ground, moves)]
    judged.append(judge_step(step(sole(0.4, 0.12, 0.1)), SOLE, ground))
    judged.append(judge_step(step(sole(0.4, 0.12, 0.1, pitch_deg=12)), SOLE, ground))
    counts = count_steps(judged)
    assert counts.total == counts.flat + counts.uneven_flat + counts.rough + counts.ramp == 4
    assert (counts.flat, counts.uneven_flat, counts.rough, counts.ramp, counts.reactive) == (2, 1, 1, 0, 1)
