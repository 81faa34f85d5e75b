"""Another robot walks with the same code: a quarter of the mass, other proportions, other names, other hips."""

import re
from pathlib import Path

import numpy as np
import pytest

from lookstep import run
from lookstep.configuration import load_configuration
from lookstep.errors import UserError
from lookstep.options import RunOptions
from lookstep.summary import Outcome
from lookstep.walk import walk
from lookstep.world import build_world
from sim_envs.courses import load_course
from sim_envs.robot import SHIPPED_ROBOTS
from skills.footsteps.footstep import Footstep, Side
from skills.geometry.pose import Pose
from skills.walking import StepEventKind, WalkingPhase

CHEAP = ("camera.resolution=0.125", "physics.control_rate=250")


def test_the_courier_walks_over_steps_under_physics():
    configuration = load_configuration(assignments=CHEAP, robot="courier")
    world = build_world(load_course("flat"), configuration, "physics")
    x, y, _ = world.course.start
    steps, side = [], Side.LEFT
    for i in range(5):
        pose = Pose.from_xyz_rpy((x + 0.22 * min(i + 1, 4), y + 0.08 * side.sign, 0.0))
        steps.append(Footstep(i, side, pose, world.robot.sole_corners_sole, 0.6, 0.2, 0.06, np.zeros((0, 3))))
        side = side.opposite
    world.send_footsteps(tuple(steps))
    world.advance(6.0)
    status = world.status()
    assert (status.phase, status.failure) == (WalkingPhase.STANDING, "")
    landed = [event for event in world.drain_events() if event.kind is StepEventKind.COMPLETED]
    assert [event.step.sequence_id for event in landed] == list(range(5))
    for event in landed:
        np.testing.assert_allclose(event.T_world_sole.p, event.step.T_world_sole.p, atol=5e-3)


def test_the_courier_looks_plans_and_steps():
    summary = walk(RunOptions(robot="courier", course="flat", time_limit=5.0, assignments=CHEAP))
    assert summary.robot == "courier"
    assert summary.outcome is Outcome.TIMEOUT
    assert summary.distance_m > 0.6
    assert summary.pauses.count == 0


@pytest.mark.parametrize(
    ("assignment", "told"),
    (
        (
            "robot.cameras=[{name: front, body: neck}]",
            "camera front: got 'neck', the bodies of atlas_class.xml are pelvis,",
        ),
        ("robot.torso_body=neck", "there is no body 'neck' for the torso"),
        ("walking.posture=[[tail, 0.1]]", "posture: got joint 'tail', the robot has left_hip_yaw,"),
        ("robot.mjcf=nowhere.xml", "nowhere.xml: there is no such MJCF file"),
    ),
)
def test_a_robot_that_does_not_fit_its_description_is_told(assignment, told):
    with pytest.raises(UserError, match=r"^robot: ") as error:
        run(course="flat", assignments=(assignment,))
    assert told in str(error.value)


def test_the_robot_of_the_documentation_is_sound(tmp_path):
    page = (Path(__file__).parents[2] / "docs" / "robots.md").read_text()
    block = re.search(r"<!-- my_robot\.yaml -->\n```yaml\n(.*?)```", page, re.DOTALL)
    assert block is not None
    robot = tmp_path / "my_robot.yaml"
    robot.write_text(block.group(1))
    (tmp_path / "my_robot.xml").write_text((SHIPPED_ROBOTS / "courier.xml").read_text())
    configuration = load_configuration(robot=str(robot))
    world = build_world(load_course("flat"), configuration, "kinematic")
    world.advance(0.5)
    assert world.status().failure == ""
