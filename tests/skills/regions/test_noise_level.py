"""The noise that is measured on an image is the noise that was put into it."""

import numpy as np
import pytest
from block_fields import L515, block, camera_pose, look

from skills.geometry.camera import DepthImage, PinholeCamera
from skills.regions import RegionParameters
from skills.regions.noise_level import NoiseLevel
from skills.regions.patches import fit_patches


def noise_of(image: DepthImage, depth: np.ndarray) -> NoiseLevel:
    noisy = DepthImage(depth.astype(np.float32), image.camera, image.T_world_camera, 0.0, 0)
    return fit_patches(noisy, RegionParameters()).noise


@pytest.fixture(scope="module")
def field() -> DepthImage:
    """Three touching columns of blocks, level and tilted, that end in a pit."""
    rng = np.random.default_rng(0)
    boxes = [
        block(
            0.2 + 0.37 * row,
            0.39 * (column - 1),
            rng.uniform(-0.05, 0.05),
            pitch=rng.choice((-0.25, 0.0, 0.0, 0.25)),
            roll=rng.choice((-0.25, 0.0, 0.0)),
        )
        for row in range(6)
        for column in range(3)
    ]
    return look(boxes, camera_pose(0.0)).image


def white_at(noise: NoiseLevel, depth: float) -> float:
    return noise.white + noise.white_growth * depth**2


@pytest.mark.parametrize("sigma", [0.001, 0.0025, 0.005, 0.010])
def test_white_noise_is_measured_on_a_field_of_blocks(field, sigma):
    rng = np.random.default_rng(1)
    noise = noise_of(field, np.where(field.depth > 0, field.depth + sigma * rng.standard_normal(field.depth.shape), 0))
    for depth in (0.8, 1.2, 1.8):
        assert white_at(noise, depth) == pytest.approx(sigma, rel=0.06)
    assert noise.correlated < 0.12 * sigma


def test_no_noise_is_none(field):
    noise = noise_of(field, field.depth)
    assert white_at(noise, 1.5) < 1e-5
    assert noise.correlated + noise.correlated_growth * 1.5**2 < 1e-4


def test_noise_that_neighbours_share_is_told_from_white(field):
    import cv2

    rng = np.random.default_rng(2)
    smooth = cv2.GaussianBlur(rng.standard_normal(field.depth.shape), (0, 0), 3.0)
    smooth *= 0.004 / smooth.std()
    white = 0.003 * rng.standard_normal(field.depth.shape)
    noise = noise_of(field, np.where(field.depth > 0, field.depth + smooth + white, 0.0))
    # Averages over a patch, and differences to its neighbours, see part of it.
    assert 0.5 * 0.004 < noise.correlated + noise.correlated_growth * 1.2**2 < 0.004
    assert white_at(noise, 1.2) == pytest.approx(0.003, rel=0.2)


def test_noise_that_grows_with_the_square_of_depth_is_followed():
    camera = PinholeCamera(640, 480, 535.4, 539.2, 320.1, 247.6)
    image = look([block(2.0, 0.0, 0.0, size=(8.0, 6.0, 0.1))], camera_pose(0.0, down=0.6, height=1.2), camera).image
    rng = np.random.default_rng(3)
    sigma = 0.0015 * image.depth**2
    noise = noise_of(image, np.where(image.depth > 0, image.depth + sigma * rng.standard_normal(sigma.shape), 0.0))
    for depth in (1.2, 2.0, 3.0):
        assert white_at(noise, depth) == pytest.approx(0.0015 * depth**2, rel=0.15)


def test_lost_pixels_do_not_count_as_noise(field):
    rng = np.random.default_rng(4)
    depth = np.where(field.depth > 0, field.depth + 0.004 * rng.standard_normal(field.depth.shape), 0.0)
    depth[rng.random(depth.shape) < 0.3] = 0.0
    noise = noise_of(field, depth)
    assert white_at(noise, 1.2) == pytest.approx(0.004, rel=0.08)
    assert noise.correlated < 0.001


def test_known_noise_is_taken_as_it_is(field):
    known = NoiseLevel(0.003, 0.0, 0.001, 0.0)
    assert fit_patches(field, RegionParameters(), known).noise is known


def test_an_empty_image_has_no_noise():
    empty = DepthImage(np.zeros((L515.height, L515.width), np.float32), L515, camera_pose(0.0), 0.0, 0)
    assert fit_patches(empty, RegionParameters()).noise == NoiseLevel()
