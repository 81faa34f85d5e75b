"""Looking: each image counts once, and its regions join the map of the ground."""

from __future__ import annotations

import numpy as np
import pytest
from scripted_walk import PARAMETERS, WalkingRobot, feet_at, ground, status_and_reason, tick

from behaviors import Status, Tree, parse_tree
from behaviors.leaves import look
from skills.geometry import DepthImage, PinholeCamera, Pose
from skills.regions import NoiseLevel, PlanarRegions, RegionExtraction, RegionParameters

CAMERA = PinholeCamera(4, 3, 2.0, 2.0, 1.5, 1.0)
camera_pose = Pose.from_xyz_rpy((0.0, 0.0, 1.0))
LOOK = """
tree: look
root:
  loop_forever:
    sequence:
      - ExtractRegions: {out: [extraction], latency: 0.04}
      - RememberGround: {in: [extraction], out: [ground]}
"""


@pytest.fixture
def looked_at(monkeypatch: pytest.MonkeyPatch) -> list[DepthImage]:
    """The images that regions were extracted from; each shows one square metre of ground."""
    images: list[DepthImage] = []

    def examine(image: DepthImage, parameters: RegionParameters) -> RegionExtraction:
        assert parameters is PARAMETERS["regions"]
        images.append(image)
        seen = PlanarRegions(ground(image.time).regions, image.time, image.frame_id)
        return RegionExtraction(image, seen, np.zeros((1, 1), dtype=np.int16), (0,), (), parameters, NoiseLevel())

    monkeypatch.setattr(look, "examine_regions", examine)
    return images


@pytest.fixture
def tree(looked_at):
    tree = Tree(parse_tree(LOOK), WalkingRobot(), parameters=dict(PARAMETERS))
    yield tree
    tree.shutdown()


def test_it_waits_for_the_first_image_with_a_reason(tree, looked_at):
    assert status_and_reason(tree) == (Status.RUNNING, "waits for the first depth image")
    assert not looked_at


def test_each_image_is_used_once(tree, looked_at):
    robot = tree.context.robot.robot
    robot.frame_id = 0
    tick(tree, 20)
    assert [image.frame_id for image in looked_at] == [0]
    assert tree.root.reason == "waits for the next depth image"
    robot.frame_id = 3
    tick(tree, 20)
    assert [image.frame_id for image in looked_at] == [0, 3]


def test_an_image_that_comes_while_another_is_examined_is_taken_next(tree, looked_at):
    robot = tree.context.robot.robot
    for frame_id in range(10):
        robot.frame_id = frame_id
        tick(tree)
    assert [image.frame_id for image in looked_at] == sorted({image.frame_id for image in looked_at})
    assert 1 < len(looked_at) < 10, "images that came meanwhile are passed over, but not the newest"


def test_cameras_are_looked_through_as_often_as_they_take_images(tree, looked_at, monkeypatch):
    robot = tree.context.robot.robot
    rates = {"front": 30.0, "rear": 5.0, "left": 5.0}
    monkeypatch.setattr(
        robot, "depth_frames", lambda: {name: round(robot.time * rate + 0.499) for name, rate in rates.items()}
    )

    def image(camera: str) -> DepthImage:
        depth = np.zeros((3, 4), dtype=np.float32)
        frame = robot.depth_frames()[camera]
        return DepthImage(depth, CAMERA, camera_pose, robot.time, frame, camera_name=camera)

    monkeypatch.setattr(robot, "depth_image", image)
    tick(tree, 1000)
    names = [image.camera_name for image in looked_at]
    assert names[:3] == ["front", "rear", "left"], "each once, before any is looked through again"
    shares = {name: names.count(name) / len(names) for name in rates}
    assert 0.55 < shares["front"] < 0.8, "three quarters of the images are its own"
    assert shares["rear"] == pytest.approx(shares["left"], abs=0.01)


def test_the_map_holds_what_was_seen_and_is_as_new_as_the_image(tree, looked_at):
    tree.context.robot.robot.frame_id = 0
    tick(tree, 5)
    remembered = tree.blackboard["ground"]
    assert isinstance(remembered, PlanarRegions)
    assert remembered.frame_id == 0
    assert remembered.time == looked_at[0].time
    (seen,) = tree.blackboard["extraction"].regions.regions
    assert any(region is seen for region in remembered.regions)


def test_the_map_is_made_around_the_imminent_stance(tree, looked_at, monkeypatch):
    stances = []
    remember = look.remember
    monkeypatch.setattr(
        look,
        "remember",
        lambda memory, regions, stance, *rest: stances.append(stance) or remember(memory, regions, stance, *rest),
    )
    robot = tree.context.robot.robot
    robot.stand(x=2.0)
    robot.frame_id = 0
    tick(tree, 5)
    assert [stance.mid_feet.tolist() for stance in stances] == [feet_at(2.0).mid_feet.tolist()]
