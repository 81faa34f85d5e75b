import dataclasses

import numpy as np
import pytest

from sim_envs.sensors import DEPTH_NOISE_PRESETS, DepthCameraParameters, DepthNoise
from sim_envs.sensors.depth_noise import DepthNoiseModel

CAMERA = DepthCameraParameters().camera
SILENT = DEPTH_NOISE_PRESETS["none"]


def wall(depth: float) -> np.ndarray:
    return np.full((CAMERA.height, CAMERA.width), depth, dtype=np.float32)


def errors_of(noise: DepthNoise, depth: float, frame_id: int = 0, seed: int = 0) -> np.ndarray:
    return DepthNoiseModel(noise, CAMERA, seed).corrupt(wall(depth), frame_id) - np.float32(depth)


def correlation(field: np.ndarray, distance: int) -> float:
    centred = field - field.mean()
    return float((centred[:, :-distance] * centred[:, distance:]).mean() / centred.var())


def test_without_noise_an_image_stays_as_it_is():
    depth = np.random.default_rng(0).uniform(0.2, 8.0, (CAMERA.height, CAMERA.width)).astype(np.float32)
    np.testing.assert_array_equal(DepthNoiseModel(SILENT, CAMERA, 0).corrupt(depth, 3), depth)


def test_the_same_frame_has_the_same_bits_whatever_came_before():
    depth = wall(1.5)
    depth[200:400, 300:600] = 1.0
    fresh = DepthNoiseModel(DepthNoise(), CAMERA, 7)
    used = DepthNoiseModel(DepthNoise(), CAMERA, 7)
    for frame_id in (4, 1, 12):
        used.corrupt(depth, frame_id)
    np.testing.assert_array_equal(fresh.corrupt(depth, 2), used.corrupt(depth, 2))


@pytest.mark.parametrize(("seed", "frame_id"), [(0, 1), (1, 0)])
def test_other_frames_and_other_seeds_have_other_noise(seed, frame_id):
    one, other = errors_of(DepthNoise(), 2.0), errors_of(DepthNoise(), 2.0, frame_id, seed)
    assert abs(np.corrcoef(one.ravel(), other.ravel())[0, 1]) < 0.05


@pytest.mark.parametrize("depth", [0.5, 2.0, 6.0])
def test_white_noise_grows_with_depth_and_is_white(depth):
    error = errors_of(dataclasses.replace(SILENT, white=0.0025, white_per_metre=0.0016), depth)
    assert error.std() == pytest.approx(0.0025 + 0.0016 * depth, rel=0.01)
    assert abs(error.mean()) < 1e-4
    assert abs(correlation(error, 1)) < 0.01


@pytest.mark.parametrize("length", [3.0, 6.0, 15.0])
def test_correlated_noise_has_its_deviation_and_its_length(length):
    noise = dataclasses.replace(SILENT, correlated=0.002, correlation_length=length)
    fields = [errors_of(noise, 1.0, frame_id, seed) for frame_id, seed in ((0, 0), (1, 1), (2, 2))]
    assert np.mean([field.std() for field in fields]) == pytest.approx(0.002, rel=0.05)
    at_length = np.mean([correlation(field, round(length)) for field in fields])
    assert at_length == pytest.approx(np.exp(-1), abs=0.05)
    assert np.mean([correlation(field, round(3 * length)) for field in fields]) == pytest.approx(0, abs=0.05)


def test_successive_errors_of_a_pixel_are_independent():
    model = DepthNoiseModel(DepthNoise(), CAMERA, 0)
    pixel = np.array([model.corrupt(wall(1.0), frame_id)[384, 512] - 1.0 for frame_id in range(300)])
    sigma = np.hypot(0.0025 + 0.0016, 0.002)
    assert pixel.std() == pytest.approx(sigma, rel=0.15)
    assert abs(correlation(pixel[None], 1)) < 0.15


def test_half_of_the_pixels_at_depth_edges_are_lost_and_no_others():
    depth = wall(2.0)
    depth[100:600, 200:800] = 1.0
    noise = dataclasses.replace(SILENT, edge_loss=0.5)
    lost = DepthNoiseModel(noise, CAMERA, 0).corrupt(depth, 0) == 0
    edge = np.zeros_like(lost)
    edge[99:601, 199:801] = True
    edge[101:599, 201:799] = False
    for row in (99, 600):
        for column in (199, 800):
            edge[row, column] = False  # touches the near face by a corner only
    assert not lost[~edge].any()
    assert lost[edge].mean() == pytest.approx(0.5, abs=0.04)


@pytest.mark.parametrize("share", [0.0, 1.0])
def test_none_or_all_of_the_pixels_at_edges_are_lost(share):
    depth = wall(2.0)
    depth[:, 500:] = 1.0
    lost = DepthNoiseModel(dataclasses.replace(SILENT, edge_loss=share), CAMERA, 0).corrupt(depth, 0) == 0
    assert lost[:, 499:501].mean() == share
    assert lost.sum() == share * 2 * CAMERA.height


def test_invalid_pixels_stay_invalid_and_all_others_stay_in_range():
    depth = np.linspace(CAMERA.near, CAMERA.far, CAMERA.height * CAMERA.width, dtype=np.float32)
    depth = depth.reshape(CAMERA.height, CAMERA.width)
    depth[::7] = 0
    measured = DepthNoiseModel(DEPTH_NOISE_PRESETS["hard"], CAMERA, 0).corrupt(depth, 0)
    assert not measured[::7].any()
    valid = measured[measured > 0]
    assert valid.min() >= np.float32(CAMERA.near)
    assert valid.max() <= np.float32(CAMERA.far)


def test_depth_bias_scales_depth():
    assert errors_of(dataclasses.replace(SILENT, depth_bias=0.01), 2.0).mean() == pytest.approx(0.02, rel=1e-3)


def test_mount_error_turns_by_its_angle_about_an_axis_of_the_seed():
    rotations = [DepthNoiseModel(DEPTH_NOISE_PRESETS["hard"], CAMERA, seed).R_mount for seed in (0, 0, 1)]
    for R in rotations:
        assert np.degrees(np.arccos((np.trace(R) - 1) / 2)) == pytest.approx(2.0)
    np.testing.assert_array_equal(rotations[0], rotations[1])
    assert not np.allclose(rotations[0], rotations[2])
