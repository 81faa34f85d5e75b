"""Errors of a lidar like the Ouster OS0-128: ranges that scatter, and returns that are lost.

A return fades with the square of its range and the cosine of its incidence (Lambert's law), so that distant ground is
lost long before a distant wall; at the edges of things part of the light goes elsewhere, and now and then a return is
lost without a reason. Incidence is taken from the ranges of neighbouring rays. A field of normal numbers is drawn once;
a scan takes windows of it, placed by a generator that is seeded by (seed, scan id) alone.
"""

from __future__ import annotations

from statistics import NormalDist
from typing import Any

import numpy as np
from numpy.typing import NDArray

from sim_envs.sensors.mount_error import mount_rotation
from skills.geometry.lidar import SpinningLidar
from skills.geometry.pose import Array
from skills.kernels import kernel
from skills.parameters import parameter, parameters

_MARGIN = 256  # a scan's windows are shifted by up to this many rings and columns
_TILE_STREAM, _SCAN_STREAM, _MOUNT_STREAM = 3, 4, 5  # others than the depth camera's
_FLICKER = 0.3  # standard deviation of a return's strength about what range and incidence make of it


@parameters
class LidarNoise:
    """How far a lidar scan is from the truth; the defaults are an OS0's."""

    white: float = parameter(
        0.015, unit="m", minimum=0.0, maximum=0.5, meaning="standard deviation of a range's error at range 0"
    )
    white_per_metre: float = parameter(
        0.0023, unit="m/m", minimum=0.0, maximum=0.1, meaning="growth of that standard deviation with range"
    )
    range_bias: float = parameter(
        0.0, unit="m", minimum=-0.5, maximum=0.5, meaning="error that all ranges share: 0.01 measures 1 cm too far"
    )
    weakest: float = parameter(
        0.0011,
        unit="1/m^2",
        minimum=0.0,
        maximum=1.0,
        meaning="cosine of incidence over squared range below which most returns are lost: a wall 30 m away has 0.0011",
    )
    edge_loss: float = parameter(
        0.3, unit="1", minimum=0.0, maximum=1.0, meaning="share of the returns at edges that are lost"
    )
    edge_jump: float = parameter(
        0.05, unit="1", minimum=0.001, maximum=1.0, meaning="jump to a neighbour that is an edge, relative to range"
    )
    chance_loss: float = parameter(
        0.005, unit="1", minimum=0.0, maximum=1.0, meaning="share of all returns that are lost without a reason"
    )
    mount_error_deg: float = parameter(
        0.0, unit="deg", minimum=0.0, maximum=20.0, meaning="angle between the true lidar and the believed one"
    )


LIDAR_NOISE_PRESETS: dict[str, LidarNoise] = {
    "none": LidarNoise(white=0.0, white_per_metre=0.0, weakest=0.0, edge_loss=0.0, chance_loss=0.0),
    "standard": LidarNoise(),
    "hard": LidarNoise(white=0.03, range_bias=0.02, edge_loss=0.5, chance_loss=0.05, mount_error_deg=1.0),
}


class LidarNoiseModel:
    """Adds the errors of one lidar to its scans."""

    def __init__(self, noise: LidarNoise, lidar: SpinningLidar, seed: int) -> None:
        self._noise = noise
        self._lidar = lidar
        self._seed = seed
        rng = np.random.default_rng((seed, _TILE_STREAM))
        self._white = rng.standard_normal((lidar.rings + _MARGIN, lidar.columns + _MARGIN), dtype=np.float32)

    @property
    def R_mount(self) -> Array:
        """Rotation from the true lidar to the believed one, (3, 3)."""
        return mount_rotation(np.deg2rad(self._noise.mount_error_deg), (self._seed, _MOUNT_STREAM))

    def corrupt(self, ranges: NDArray[np.float32], scan_id: int) -> NDArray[np.float32]:
        """Ranges as the sensor measures them, (rings, columns) float32 [m]; 0 stays 0, as does what leaves [near, far].

        Args:
            ranges: true ranges, (rings, columns) float32 [m].
            scan_id: index of the scan, the only thing besides the seed on which its noise depends.
        """
        rng = np.random.default_rng((self._seed, _SCAN_STREAM, scan_id))
        corner = rng.integers(0, _MARGIN, size=(3, 2))
        sign = rng.choice((-1.0, 1.0))
        noise, lidar = self._noise, self._lidar
        scales = (
            noise.range_bias,
            sign * noise.white,
            sign * noise.white_per_metre,
            noise.weakest,
            noise.edge_jump,
            _below(noise.edge_loss),
            _below(noise.chance_loss),
            lidar.near,
            lidar.far,
        )
        across = 2.0 * np.pi / lidar.columns * np.cos(lidar.elevations)
        down = (lidar.elevation_max - lidar.elevation_min) / (lidar.rings - 1)
        angles = np.stack((across, np.full(lidar.rings, down))).astype(np.float32)
        measured = np.empty_like(ranges)
        _corrupt(ranges, self._white, corner, np.array(scales, dtype=np.float32), angles, measured)
        return measured


def _below(share: float) -> float:
    """Below which number a share of all normal numbers lies."""
    return NormalDist().inv_cdf(share) if 0.0 < share < 1.0 else (share - 0.5) * np.inf


@kernel
def _corrupt(
    ranges: NDArray[Any],
    white: NDArray[Any],
    corner: NDArray[Any],
    scales: NDArray[Any],
    angles: NDArray[Any],
    measured: NDArray[Any],
) -> None:
    """Measure each range; angles (2, rings) lie between neighbouring columns and between neighbouring rings."""
    rings, columns = ranges.shape
    bias, sigma, sigma_per_metre, weakest, edge_jump, edge_below, chance_below, near, far = scales
    zero, one, flicker = np.float32(0.0), np.float32(1.0), np.float32(_FLICKER)
    around = np.empty(columns + 2, dtype=np.float32)
    for r in range(rings):
        here, above, below = ranges[r], ranges[max(r - 1, 0)], ranges[min(r + 1, rings - 1)]
        around[0], around[columns + 1] = here[columns - 1], here[0]
        for c in range(columns):
            around[c + 1] = here[c]
        across, down = angles[0, r], angles[1, r]
        own = white[corner[0, 0] + r, corner[0, 1] : corner[0, 1] + columns]
        strength = white[corner[1, 0] + r, corner[1, 1] : corner[1, 1] + columns]
        luck = white[corner[2, 0] + r, corner[2, 1] : corner[2, 1] + columns]
        out = measured[r]
        for c in range(columns):
            d = here[c]
            left, right = abs(around[c] - d), abs(around[c + 2] - d)
            up, low = abs(above[c] - d), abs(below[c] - d)
            # Of two neighbours the one that is nearer lies on the same surface.
            flat_across, jump_across = (left, right - left) if left < right else (right, left - right)
            flat_down, jump_down = (up, low - up) if up < low else (low, up - low)
            slope_across, slope_down = flat_across / across, flat_down / down
            edge = (jump_across > edge_jump * d) | (jump_down > edge_jump * d)
            # cos(incidence) / d^2 with tan(incidence) = slope / d
            signal = one / (d * np.sqrt(d * d + slope_across * slope_across + slope_down * slope_down))
            lost = (signal < weakest * (one + flicker * strength[c])) | (
                luck[c] < (edge_below if edge else chance_below)
            )
            value = d + bias + (sigma + sigma_per_metre * d) * own[c]
            out[c] = value if (d > zero) & (value >= near) & (value <= far) & (not lost) else zero
