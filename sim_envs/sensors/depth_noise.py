"""Errors of a depth camera like the Intel RealSense L515: white, spatially correlated, biased, and lost at depth edges.

White noise is harmless, because a fit to many pixels averages it away; noise that neighbours share bends surfaces, and
is what tells good extraction from bad. Fields of normal numbers are drawn once. A frame takes windows of them, placed
and signed by a generator that is seeded by (seed, frame id) alone: the same frame has the same noise whatever was
rendered before.
"""

from __future__ import annotations

from statistics import NormalDist
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from sim_envs.sensors.mount_error import mount_rotation
from skills.geometry.camera import PinholeCamera
from skills.kernels import kernel
from skills.parameters import parameter, parameters

_MARGIN = 256  # a frame's window is shifted by up to this many rows and columns [px]
_TILE_STREAM, _FRAME_STREAM, _MOUNT_STREAM = 0, 1, 2


@parameters
class DepthNoise:
    """How far a depth image is from the truth; the defaults are an L515's."""

    white: float = parameter(
        0.0025, unit="m", minimum=0.0, maximum=0.1, meaning="standard deviation of a pixel's own error at depth 0"
    )
    white_per_metre: float = parameter(
        0.0016, unit="m/m", minimum=0.0, maximum=0.1, meaning="growth of that standard deviation with depth"
    )
    correlated: float = parameter(
        0.002, unit="m", minimum=0.0, maximum=0.1, meaning="standard deviation of the error that neighbours share"
    )
    correlation_length: float = parameter(
        6.0, unit="px", minimum=1.0, maximum=100.0, meaning="distance at which the shared error's correlation is 1/e"
    )
    edge_loss: float = parameter(
        0.5, unit="1", minimum=0.0, maximum=1.0, meaning="share of the pixels at depth edges that return nothing"
    )
    edge_jump: float = parameter(
        0.03, unit="1", minimum=0.001, maximum=1.0, meaning="jump to a neighbour that is an edge, relative to depth"
    )
    depth_bias: float = parameter(
        0.0, unit="1", minimum=-0.2, maximum=0.2, meaning="error of the depth scale: 0.01 measures 1 % too far"
    )
    mount_error_deg: float = parameter(
        0.0, unit="deg", minimum=0.0, maximum=20.0, meaning="angle between the true camera and the believed one"
    )


DEPTH_NOISE_PRESETS: dict[str, DepthNoise] = {
    "none": DepthNoise(white=0.0, white_per_metre=0.0, correlated=0.0, edge_loss=0.0),
    "standard": DepthNoise(),
    "hard": DepthNoise(correlated=0.004, depth_bias=0.01, mount_error_deg=2.0),
}


class DepthNoiseModel:
    """Adds the errors of one camera to its images."""

    def __init__(self, noise: DepthNoise, camera: PinholeCamera, seed: int) -> None:
        self.noise = noise
        self._camera = camera
        self._seed = seed
        rng = np.random.default_rng((seed, _TILE_STREAM))
        shape = (camera.height + _MARGIN, camera.width + _MARGIN)
        self._white = rng.standard_normal(shape, dtype=np.float32)
        self._correlated = _correlated_field(rng, shape, noise.correlation_length)

    @property
    def R_mount(self) -> NDArray[np.float64]:
        """Rotation from the true camera to the believed one, R_believed_true (3, 3), about an axis drawn once."""
        return mount_rotation(np.deg2rad(self.noise.mount_error_deg), (self._seed, _MOUNT_STREAM))

    def corrupt(self, depth: NDArray[np.float32], frame_id: int) -> NDArray[np.float32]:
        """Depth as the sensor measures it, (height, width) float32 [m]; 0 stays 0, as does what leaves [near, far].

        Args:
            depth: true depth, (height, width) float32 [m].
            frame_id: index of the frame, the only thing besides the seed on which its noise depends.
        """
        rng = np.random.default_rng((self._seed, _FRAME_STREAM, frame_id))
        corner = rng.integers(0, _MARGIN, size=(3, 2))
        white_sign, correlated_sign = rng.choice((-1.0, 1.0), size=2)
        noise, camera = self.noise, self._camera
        lost_below = (
            NormalDist().inv_cdf(noise.edge_loss) if 0 < noise.edge_loss < 1 else (noise.edge_loss - 0.5) * np.inf
        )
        measured = np.empty_like(depth)
        scales = (
            1.0 + noise.depth_bias,
            white_sign * noise.white,
            white_sign * noise.white_per_metre,
            correlated_sign * noise.correlated,
            noise.edge_jump,
            lost_below,
            camera.near,
            camera.far,
        )
        _corrupt(depth, self._white, self._correlated, corner, np.array(scales, dtype=np.float32), measured)
        return measured


def _correlated_field(rng: np.random.Generator, shape: tuple[int, int], length: float) -> NDArray[np.float32]:
    """Normal numbers of variance 1 whose correlation at distance d is exp(-(d / length)^2)."""
    margin = int(np.ceil(2 * length))  # blurred borders are not as random as the rest
    white = rng.standard_normal((shape[0] + 2 * margin, shape[1] + 2 * margin), dtype=np.float32)
    # A Gaussian kernel of deviation s correlates its output as exp(-d^2 / 4 s^2).
    smooth = cv2.GaussianBlur(white, (0, 0), 0.5 * length)[margin:-margin, margin:-margin]
    return np.ascontiguousarray(smooth / smooth.std(), dtype=np.float32)


@kernel
def _corrupt(
    depth: NDArray[Any],
    white: NDArray[Any],
    correlated: NDArray[Any],
    corner: NDArray[Any],
    scales: NDArray[Any],
    measured: NDArray[Any],
) -> None:
    """Measure each pixel; one in the outermost columns is never at an edge, which lets the loop run in vectors."""
    height, width = depth.shape
    bias, sigma, sigma_per_metre, sigma_correlated, edge_jump, lost_below, near, far = scales
    zero = np.float32(0.0)
    for v in range(height):
        here = depth[v]
        above, below = depth[max(v - 1, 0)], depth[min(v + 1, height - 1)]
        left, right = here[: width - 2], here[2:]
        own = white[corner[0, 0] + v, corner[0, 1] : corner[0, 1] + width]
        shared = correlated[corner[1, 0] + v, corner[1, 1] : corner[1, 1] + width]
        draw = white[corner[2, 0] + v, corner[2, 1] : corner[2, 1] + width]
        out = measured[v]
        for u in range(width):
            z = here[u]
            value = bias * z + (sigma + sigma_per_metre * z) * own[u] + sigma_correlated * shared[u]
            out[u] = value if (z > zero) & (value >= near) & (value <= far) else zero
        for u in range(width - 2):
            z = here[u + 1]
            jump = edge_jump * z
            edge = (
                (abs(above[u + 1] - z) > jump)
                | (abs(below[u + 1] - z) > jump)
                | (abs(left[u] - z) > jump)
                | (abs(right[u] - z) > jump)
            )
            out[u + 1] = zero if edge & (draw[u + 1] < lost_below) else out[u + 1]
