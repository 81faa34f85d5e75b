"""Images that nobody on this project made: a real desk (TUM RGB-D) and a synthetic living room (ICL-NUIM).

Nobody knows their true planes, so each image judges the extraction itself: how far pixels are from the planes of their
regions, whether a region goes on across a step in depth, and whether what is plainly flat has been found.
"""

import os
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import cv2
import numpy as np
import pytest

from skills.geometry import DepthImage, PinholeCamera, Pose
from skills.regions import RegionExtraction, RegionParameters, examine_regions, piece_of_pixels

ANY_PLANE = RegionParameters(slope_max=np.pi, depth_max=20.0, distance_min=0.0)
FLAT_WINDOW = 21  # [px]
PATCH = 3  # more than a line along an edge [px]


@dataclass(frozen=True)
class Source:
    """An image, and the standard deviation of its depth, noise + growth z^2: that of triangulation."""

    file: str
    camera: PinholeCamera
    noise: float
    growth: float
    covered_min: float

    def sigma(self, depth):
        return self.noise + self.growth * depth**2


# Khoshelham and Oude Elberink, 2012: the depth of such a sensor spreads by 1.425 mm at 1 m, growing with its square.
DESK = Source(
    "tum_fr3_1341848230.910894_depth.png", PinholeCamera(640, 480, 535.4, 539.2, 320.1, 247.6), 0.0005, 1.425e-3, 0.85
)
# Rendered without noise, in steps of 0.2 mm.
ROOM = Source("icl_nuim_0_depth.png", PinholeCamera(640, 480, 481.2, 480.0, 319.5, 239.5), 0.001, 0.0, 0.98)
SOURCES = pytest.mark.parametrize("source", [DESK, ROOM], ids=["desk", "room"])


@cache
def extraction(source: Source) -> RegionExtraction:
    folder = os.environ.get("LOOKSTEP_DATA")
    path = Path(folder or "") / "depth" / source.file
    if not folder or not path.exists():
        pytest.skip(f"no {source.file}: LOOKSTEP_DATA names no folder that holds depth/{source.file}")
    depth = (np.asarray(cv2.imread(str(path), cv2.IMREAD_UNCHANGED)) / 5000.0).astype(np.float32)
    # Gravity is unknown, and any slope counts: a level camera will do.
    level = Pose(np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]), np.zeros(3))
    return examine_regions(DepthImage(depth, source.camera, level, 0.0, 0), ANY_PLANE)


def rays(camera: PinholeCamera) -> np.ndarray:
    v, u = np.indices((camera.height, camera.width))
    return np.stack(((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, np.ones(u.shape)), axis=-1)


def depth_off_planes(source: Source) -> tuple[np.ndarray, np.ndarray]:
    """How much deeper each pixel is than the plane of its region, not a number outside regions; and the regions."""
    found = extraction(source)
    pieces = piece_of_pixels(found)
    depth = found.image.depth.astype(np.float64)
    off = np.full(depth.shape, np.nan)
    for k, region in enumerate(found.regions.regions):
        T_camera_region = found.image.T_world_camera.inverse @ region.T_world_region
        normal = T_camera_region.R[:, 2]
        inside = (pieces == k) & (depth > 0.0)
        off[inside] = depth[inside] - normal @ T_camera_region.p / (rays(source.camera)[inside] @ normal)
    return off, pieces


@SOURCES
def test_every_region_is_as_flat_as_the_sensor_is_exact(source):
    off, pieces = depth_off_planes(source)
    depth = extraction(source).image.depth
    for k in range(len(extraction(source).regions.regions)):
        inside = (pieces == k) & np.isfinite(off)
        scaled = np.sort(np.abs(off[inside]) / source.sigma(depth[inside]))
        assert np.sqrt(np.mean(scaled[: int(0.98 * len(scaled))] ** 2)) < 2.5


@SOURCES
def test_no_region_goes_on_across_a_depth_edge(source):
    """Beyond an edge, pixels are far off the plane: next to it some may be, but no patch of them."""
    off, _ = depth_off_planes(source)
    with np.errstate(invalid="ignore"):
        stray = np.abs(off) > 6.0 * source.sigma(extraction(source).image.depth)
    assert stray.sum() < 0.001 * np.isfinite(off).sum()
    assert not cv2.erode(stray.astype(np.uint8), np.ones((PATCH, PATCH)), borderValue=0).any()


def plainly_flat(source: Source) -> np.ndarray:
    """Pixels in the middle of a window that one plane fits as well as the sensor can measure."""
    depth = extraction(source).image.depth.astype(np.float64)
    valid = depth > 0.0
    w = np.divide(1.0, depth, out=np.zeros_like(depth), where=valid)
    v, u = np.indices(depth.shape).astype(np.float64)
    size = (FLAT_WINDOW, FLAT_WINDOW)
    mean, square, u_mean, v_mean = (cv2.blur(values, size) for values in (w, w * w, u * w, v * w))
    variance = (FLAT_WINDOW**2 - 1) / 12.0
    a, b = (u_mean - u * mean) / variance, (v_mean - v * mean) / variance
    spread = np.sqrt(np.maximum(square - mean**2 - (a**2 + b**2) * variance, 0.0)) * depth**2
    whole = cv2.erode(valid.astype(np.uint8), np.ones(size)) > 0
    half = FLAT_WINDOW // 2
    whole[:half] = whole[-half:] = whole[:, :half] = whole[:, -half:] = False
    return whole & (spread < 1.2 * source.sigma(depth))


@SOURCES
def test_what_is_plainly_flat_is_found(source):
    flat = plainly_flat(source)
    pieces = piece_of_pixels(extraction(source))
    assert flat.mean() > 0.2
    assert (pieces[flat] >= 0).mean() > source.covered_min
