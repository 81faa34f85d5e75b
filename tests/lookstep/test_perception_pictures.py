"""Pictures from above have x to the right and y up; what is unknown stays black."""

import numpy as np

from lookstep.perception_pictures import colored, depth_picture, height_picture, map_picture
from skills.geometry import DepthImage, PinholeCamera, Pose
from skills.height_map import HeightMap, ScanAccount
from skills.regions import PlanarRegion, PlanarRegions

RED, BLUE = np.array((200, 0, 0)), np.array((0, 0, 200))


def square(x: float, y: float, time: float = 0.0) -> PlanarRegion:
    hull = 0.5 * np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    return PlanarRegion(Pose(np.eye(3), np.array((x, y, 0.0))), hull, (hull,), 1.0, time)


def test_unknown_values_are_black_and_high_ones_redder_than_low_ones():
    picture = colored(np.array([[np.nan, 0.0, 1.0]], dtype=np.float32)).astype(int)
    assert picture[0, 0].max() == 0
    assert picture[0, 1, 2] > picture[0, 1, 0] and picture[0, 2, 0] > picture[0, 2, 2]


def test_near_is_red_and_no_depth_is_black():
    camera = PinholeCamera(3, 1, 1.0, 1.0, 1.0, 0.0)
    depth = np.array([[0.0, 1.0, 3.0]], dtype=np.float32)
    picture = depth_picture(DepthImage(depth, camera, Pose.identity(), 0.0, 0)).astype(int)
    assert picture[0, 0].max() == 0
    assert picture[0, 1, 0] > picture[0, 1, 2] and picture[0, 2, 2] > picture[0, 2, 0]


def test_a_height_map_is_cut_to_what_is_known_and_seen_from_above():
    heights = np.full((6, 8), np.nan, np.float32)
    heights[2:4, 3:6] = 0.0
    heights[3, 5] = 1.0  # the largest x and y
    empty = np.zeros(heights.shape, bool)
    known = HeightMap(heights, heights.copy(), empty, 0.05, np.zeros(2), 0.0, 0, 0.0, ScanAccount())
    picture = height_picture(known).astype(int)
    assert picture.shape[0] * 3 == picture.shape[1] * 2
    red = picture[..., 0] > picture[..., 2]
    assert red[0, -1] and red.mean() < 0.2


def test_newer_regions_lie_over_older_ones_and_x_points_to_the_right():
    regions = PlanarRegions((square(0.0, 0.0), square(0.5, 0.0, time=1.0)), 1.0, 1)
    sole = 0.05 * np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    picture = map_picture(regions, np.array((RED, BLUE), np.uint8), [Pose.identity()], sole).astype(int)
    row = picture[picture.shape[0] // 4]
    blue = np.flatnonzero((row == BLUE).all(axis=1))
    red = np.flatnonzero((row == RED).all(axis=1))
    assert red.max() < blue.min()
    assert len(blue) > 1.8 * len(red)
    assert (picture == 250).all(axis=2).any()
