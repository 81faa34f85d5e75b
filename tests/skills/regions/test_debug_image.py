"""The debug image shows what became of each pixel, and the pieces behind it belong to the regions that they name."""

from dataclasses import replace

import cv2
import numpy as np
import pytest
from block_fields import L515, block, camera_pose, look, with_noise

from skills.geometry import Capsule, DepthImage
from skills.regions import PixelKind, RegionParameters, debug_image, examine_regions, kind_of_pixels, piece_of_pixels

CAMERA = L515.scaled(0.5)


@pytest.fixture(scope="module")
def extraction():
    """Ground with a wall on it, part of the robot over it, and a strip of the image without depth."""
    view = look(
        [block(0.5, 0.0, 0.0, size=(4.0, 3.0, 0.1)), block(1.2, 0.0, 0.5, size=(0.2, 1.0, 0.6))],
        camera_pose(0.0),
        CAMERA,
    )
    body = (Capsule(np.array((0.6, -0.3, 0.0)), np.array((0.6, -0.1, 0.0)), 0.08),)
    noisy = with_noise(view.image, 0)
    depth = noisy.depth.copy()
    depth[:, :40] = 0.0
    return examine_regions(replace(noisy, depth=depth, body_world=body))


def saturation(picture):
    return picture.max(axis=2).astype(int) - picture.min(axis=2)


@pytest.mark.parametrize("stride", [1, 2])
def test_regions_have_colours_and_what_is_none_has_none(extraction, stride):
    picture = debug_image(extraction, stride)
    height, width = CAMERA.height // stride, CAMERA.width // stride
    assert picture.dtype == np.uint8 and picture.shape[1] == width and picture.shape[0] > height
    picture = picture[:height]
    kinds = kind_of_pixels(extraction, piece_of_pixels(extraction, stride), stride)
    assert {PixelKind.REGION, PixelKind.REJECTED, PixelKind.OWN_BODY, PixelKind.NO_DEPTH} <= set(np.unique(kinds))
    lines = cv2.dilate((picture.max(axis=2) < 40).astype(np.uint8), np.ones((3, 3))) > 0
    coloured = saturation(picture) > 35
    assert coloured[(kinds == PixelKind.REGION) & ~lines].mean() > 0.95
    assert coloured[np.isin(kinds, (PixelKind.REJECTED, PixelKind.NO_PLANE)) & ~lines].mean() < 0.05
    assert picture[:, : 40 // stride - 6].max() == 0


def test_every_region_has_its_own_colour_unless_colours_are_given(extraction):
    pieces = piece_of_pixels(extraction)
    count = len(extraction.regions.regions)
    picture = debug_image(extraction, colors=np.full((count, 3), 128))
    inside = cv2.erode((pieces == 0).astype(np.uint8), np.ones((9, 9))) > 0
    assert np.median(saturation(picture[: CAMERA.height])[inside]) == 0


def test_a_pixel_is_in_the_region_whose_polygon_it_sees(extraction):
    pieces = piece_of_pixels(extraction)
    camera, depth = CAMERA, extraction.image.depth
    for k, region in enumerate(extraction.regions.regions):
        v, u = np.nonzero((pieces == k) & (depth > 0.0))
        z = depth[v, u].astype(np.float64)
        points = np.column_stack(((u - camera.cx) / camera.fx * z, (v - camera.cy) / camera.fy * z, z))
        points_region = (region.T_world_region.inverse @ extraction.image.T_world_camera) @ points
        hull = np.round(1000.0 * region.hull_region).astype(np.int32)
        inside = [cv2.pointPolygonTest(hull, (1000.0 * x, 1000.0 * y), True) > -20.0 for x, y, _ in points_region[::50]]
        assert np.mean(inside) > 0.98


def test_pieces_with_one_label_are_told_apart():
    """A ditch parts the ground in two; both sides are on one plane."""
    sides = [block(0.5, 0.45, 0.0, size=(4.0, 0.8, 0.1)), block(0.5, -0.45, 0.0, size=(4.0, 0.8, 0.1))]
    extraction = examine_regions(with_noise(look(sides, camera_pose(0.0), CAMERA).image, 0))
    pieces = piece_of_pixels(extraction)
    assert len(extraction.regions.regions) == 2
    half = CAMERA.width // 2
    left, right = (np.bincount(side[side >= 0], minlength=2) for side in (pieces[:, :half], pieces[:, half:]))
    assert sorted((left.argmax(), right.argmax())) == [0, 1]
    assert left.min() < 0.02 * left.max() and right.min() < 0.02 * right.max()


def test_depths_that_the_extraction_ignores_are_out_of_range():
    view = look([block(0.5, 0.0, 0.0, size=(6.0, 3.0, 0.1))], camera_pose(0.0), CAMERA)
    extraction = examine_regions(view.image, RegionParameters(depth_max=1.5))
    kinds = kind_of_pixels(extraction, piece_of_pixels(extraction))
    assert np.all(kinds[view.image.depth > 1.52] == PixelKind.OUT_OF_RANGE)


def test_an_image_of_nothing_is_drawn_too():
    depth = np.zeros((CAMERA.height, CAMERA.width), np.float32)
    extraction = examine_regions(DepthImage(depth, CAMERA, camera_pose(0.0), 0.0, 0))
    assert debug_image(extraction)[: CAMERA.height].max() == 0
