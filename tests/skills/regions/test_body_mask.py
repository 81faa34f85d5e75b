"""Exactly the pixels that see the robot's own body lose their depth."""

from dataclasses import replace

import numpy as np
from block_fields import L515, block, camera_pose, look

from skills.geometry.camera import DepthImage
from skills.geometry.capsule import Capsule
from skills.regions.own_body import without_body

SMALL = L515.scaled(0.3125)


def scene() -> DepthImage:
    return look([block(1.0, 0.0, 0.0, size=(4.0, 3.0, 0.1))], camera_pose(0.0), SMALL).image


def points_world(image: DepthImage) -> np.ndarray:
    v, u = np.indices(image.depth.shape)
    camera = image.camera
    rays = np.stack(((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, np.ones(u.shape)), axis=-1)
    return image.T_world_camera @ (rays * image.depth[..., None].astype(np.float64)).reshape(-1, 3)


def distances(points: np.ndarray, capsule: Capsule) -> np.ndarray:
    axis = capsule.end_world - capsule.start_world
    share = np.clip((points - capsule.start_world) @ axis / max(axis @ axis, 1e-12), 0.0, 1.0)
    return np.linalg.norm(points - capsule.start_world - share[:, None] * axis, axis=1)


def test_pixels_inside_capsules_are_erased_and_no_others():
    rng = np.random.default_rng(0)
    image = scene()
    capsules = tuple(
        Capsule(rng.uniform((-0.3, -0.8, -0.2), (1.8, 0.8, 1.3)), rng.uniform((-0.3, -0.8, -0.2), (1.8, 0.8, 1.3)), r)
        for r in rng.uniform(0.03, 0.3, 60)
    )
    for body in (capsules, capsules[:1], capsules[7:8]):
        points = points_world(image)
        inside = np.zeros(len(points), bool)
        unsure = np.zeros(len(points), bool)
        for capsule in body:
            off = distances(points, capsule) - capsule.radius
            inside |= off < 0.0
            unsure |= np.abs(off) < 1e-5
        inside, unsure = inside.reshape(image.depth.shape), unsure.reshape(image.depth.shape)
        seen = without_body(replace(image, body_world=body)).depth
        expected = np.where(inside, 0.0, image.depth)
        np.testing.assert_array_equal(seen[~unsure], expected[~unsure])


def test_an_image_without_body_in_view_is_not_copied():
    image = scene()
    behind = (Capsule(np.array((-3.0, 0.0, 1.0)), np.array((-2.0, 0.0, 1.0)), 0.2),)
    assert without_body(image) is image
    assert without_body(replace(image, body_world=behind)).depth is image.depth
