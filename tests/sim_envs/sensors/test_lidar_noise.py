import dataclasses

import numpy as np
import pytest

from sim_envs.sensors import LIDAR_NOISE_PRESETS, LidarNoise, LidarParameters
from sim_envs.sensors.lidar_noise import LidarNoiseModel

LIDAR = LidarParameters().lidar
SILENT = LIDAR_NOISE_PRESETS["none"]


def all_at(distance: float) -> np.ndarray:
    """What a lidar in the middle of a hollow sphere measures."""
    return np.full((LIDAR.rings, LIDAR.columns), distance, dtype=np.float32)


def floor(height: float) -> np.ndarray:
    """What a level lidar above endless ground measures."""
    down = -np.sin(np.minimum(LIDAR.elevations, -1e-9))
    ranges = np.where(height / down <= LIDAR.far, height / down, 0.0)
    return np.repeat(ranges[:, None], LIDAR.columns, axis=1).astype(np.float32)


def measured(noise: LidarNoise, ranges: np.ndarray, scan_id: int = 0, seed: int = 0) -> np.ndarray:
    return LidarNoiseModel(noise, LIDAR, seed).corrupt(ranges, scan_id)


def test_without_noise_a_scan_stays_as_it_is():
    ranges = np.random.default_rng(0).uniform(0.4, 45.0, (LIDAR.rings, LIDAR.columns)).astype(np.float32)
    np.testing.assert_array_equal(measured(SILENT, ranges), ranges)


def test_the_same_scan_has_the_same_bits_whatever_came_before():
    fresh, used = (LidarNoiseModel(LidarNoise(), LIDAR, 7) for _ in range(2))
    for scan_id in (4, 1, 12):
        used.corrupt(floor(1.9), scan_id)
    np.testing.assert_array_equal(fresh.corrupt(floor(1.9), 2), used.corrupt(floor(1.9), 2))


@pytest.mark.parametrize(("seed", "scan_id"), [(0, 1), (1, 0)])
def test_other_scans_and_other_seeds_have_other_noise(seed, scan_id):
    white = dataclasses.replace(SILENT, white=0.015)
    one, other = (measured(white, all_at(5.0), *which) - 5.0 for which in ((0, 0), (scan_id, seed)))
    assert abs(np.corrcoef(one.ravel(), other.ravel())[0, 1]) < 0.02


def test_a_rays_successive_errors_are_independent():
    model = LidarNoiseModel(LidarNoise(chance_loss=0.0), LIDAR, 0)
    errors = np.array([model.corrupt(all_at(1.0), scan_id)[64, 512] - 1.0 for scan_id in range(300)])
    assert errors.std() == pytest.approx(0.0173, rel=0.15)
    assert abs(np.corrcoef(errors[1:], errors[:-1])[0, 1]) < 0.15


@pytest.mark.parametrize(("distance", "deviation"), [(1.0, 0.0173), (5.0, 0.0265), (15.0, 0.0495)])
def test_ranges_scatter_like_an_os0s(distance, deviation):
    errors = measured(LidarNoise(chance_loss=0.0), all_at(distance)) - distance
    assert errors.std() == pytest.approx(deviation, rel=0.01)
    assert abs(errors.mean()) < 0.01 * deviation


def test_bias_moves_all_ranges_alike():
    assert (measured(dataclasses.replace(SILENT, range_bias=0.02), all_at(3.0)) - 3.0).mean() == pytest.approx(0.02)


@pytest.mark.parametrize("share", [0.0, 0.05, 1.0])
def test_returns_are_lost_by_chance(share):
    lost = measured(dataclasses.replace(SILENT, chance_loss=share), all_at(2.0)) == 0
    assert lost.mean() == pytest.approx(share, abs=0.005)


def test_half_of_the_returns_at_edges_are_lost_and_no_others():
    ranges = all_at(4.0)
    ranges[40:90, 1000:] = ranges[40:90, :200] = 2.0  # across the seam
    lost = measured(dataclasses.replace(SILENT, edge_loss=0.5), ranges) == 0
    edge = np.zeros_like(lost)
    edge[39:91, 999:] = edge[39:91, :201] = True
    edge[41:89, 1001:] = edge[41:89, :199] = False
    for ring in (39, 90):
        for column in (999, 200):
            edge[ring, column] = False  # touches the near square by a corner only
    assert not lost[~edge].any()
    assert lost[edge].mean() == pytest.approx(0.5, abs=0.06)


def test_slanting_ground_is_no_edge():
    ground = floor(1.9)
    near = (ground > 0) & (ground < 12.0)
    assert (measured(dataclasses.replace(SILENT, edge_loss=1.0), ground) > 0)[near].mean() > 0.99


def test_a_return_fades_with_range_and_grazing_incidence():
    fading = dataclasses.replace(SILENT, weakest=LidarNoise().weakest)
    heard = {distance: (measured(fading, all_at(distance)) > 0).mean() for distance in (10.0, 30.0, 45.0)}
    assert heard[10.0] == 1.0 and heard[45.0] < 0.05
    assert 0.3 < heard[30.0] < 0.7
    # On ground the cosine of incidence is height / range: 1.9 m / range^3 reaches 0.0011 / m^2 at 12 m.
    ground = floor(1.9)
    heard_ground = measured(fading, ground) > 0
    assert heard_ground[(ground > 0) & (ground < 8.0)].all()
    assert heard_ground[ground > 18.0].mean() < 0.02


def test_nothing_stays_nothing_and_all_else_stays_in_range():
    ranges = np.linspace(LIDAR.near, LIDAR.far, LIDAR.rings * LIDAR.columns, dtype=np.float32)
    ranges = ranges.reshape(LIDAR.rings, LIDAR.columns)
    ranges[::7] = 0
    values = measured(dataclasses.replace(SILENT, white=0.2), ranges)
    assert not values[::7].any()
    assert np.float32(LIDAR.near) <= values[values > 0].min() <= values.max() <= np.float32(LIDAR.far)
