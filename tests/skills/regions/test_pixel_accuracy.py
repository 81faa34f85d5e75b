"""Pixels get the label of the face that they see, whatever camera looks."""

import cv2
import numpy as np
import pytest
from block_fields import L515, Box, block, camera_pose, look, with_noise

from skills.geometry.camera import DepthImage, PinholeCamera
from skills.regions import RegionParameters, examine_regions
from skills.regions.growing import grow_regions
from skills.regions.patches import fit_patches
from skills.regions.refinement import Segmentation, refine_regions

PARAMETERS = RegionParameters()
ODD_LENS = PinholeCamera(640, 480, 610.0, 540.0, 250.0, 300.0)


def segment(image: DepthImage) -> Segmentation:
    patches = fit_patches(image, PARAMETERS)
    return refine_regions(image, patches, grow_regions(patches, PARAMETERS, PARAMETERS.patches_min), PARAMETERS)


def white(image: DepthImage, sigma: float, seed: int = 0, lost: float = 0.0) -> DepthImage:
    rng = np.random.default_rng(seed)
    depth = np.where(image.depth > 0.0, image.depth + sigma * rng.standard_normal(image.depth.shape), 0.0)
    depth[rng.random(depth.shape) < lost] = 0.0
    return DepthImage(depth.astype(np.float32), image.camera, image.T_world_camera, 0.0, 0)


def iou(found: np.ndarray, true: np.ndarray) -> float:
    """Of the label that covers the truth best."""
    labels, counts = np.unique(found[true & (found >= 0)], return_counts=True)
    if not len(labels):
        return 0.0
    best = found == labels[np.argmax(counts)]
    return float((best & true).sum() / (best | true).sum())


def step() -> list[Box]:
    return [block(1.0, 0.0, 0.0, size=(4.0, 3.0, 0.1)), block(0.85, 0.0, 0.2, size=(0.4, 0.5, 0.2), yaw=0.4)]


@pytest.mark.parametrize(
    "camera",
    [L515, L515.scaled(0.3125), PinholeCamera(1280, 720, 900.0, 900.0, 640.0, 360.0), ODD_LENS],
    ids=["1024x768", "320x240", "1280x720", "fx is not fy"],
)
def test_a_block_on_a_floor_is_cut_out_to_the_pixel(camera):
    view = look(step(), camera_pose(0.0), camera)
    found = segment(white(view.image, 0.003)).labels
    assert found.shape == (camera.height, camera.width) and found.dtype == np.int16
    small = camera.width < 400
    top, floor = (view.box == 1) & view.is_top, (view.box == 0) & view.is_top
    assert iou(found, top) > (0.92 if small else 0.97)
    assert iou(found, floor) > 0.97


def test_of_a_block_only_a_few_pixels_at_its_border_are_wrong():
    view = look(step(), camera_pose(0.0))
    top = (view.box == 1) & view.is_top
    found = segment(white(view.image, 0.002)).labels
    mine = found == np.bincount(found[top & (found >= 0)]).argmax()
    border = np.count_nonzero(top ^ cv2.erode(top.astype(np.uint8), np.ones((3, 3), np.uint8)).astype(bool))
    assert np.count_nonzero(top & ~mine) < 0.2 * border
    assert np.count_nonzero(mine & ~top) < 0.1 * border


def test_a_crease_of_15_degrees_runs_where_the_planes_meet():
    boxes = [
        block(0.65, 0.0, 0.0, size=(0.5, 1.6, 0.4)),
        block(0.9 + 0.25 * np.cos(0.26), 0.0, -0.25 * np.sin(0.26), size=(0.5, 1.6, 0.4), pitch=0.26),
    ]
    view = look(boxes, camera_pose(0.0))
    for seed in range(3):
        found = segment(white(view.image, 0.005, seed)).labels
        for box in (0, 1):
            assert iou(found, (view.box == box) & view.is_top) > 0.95


def test_a_face_narrower_than_the_window_of_a_patch_is_found():
    boxes = [block(1.0, 0.0, 0.0, size=(4.0, 3.0, 0.1)), block(0.95, 0.0, 0.055, size=(0.5, 1.0, 0.06))]
    view = look(boxes, camera_pose(0.0, down=0.7))
    front = (view.box == 1) & ~view.is_top
    rows = np.flatnonzero(front.any(axis=1))
    assert 12 < np.ptp(rows) + 1 < 24  # a window is 24 px
    assert iou(segment(white(view.image, 0.002)).labels, front) > 0.6


@pytest.mark.parametrize(("lost", "tolerance"), [(0.3, 0.015), (0.6, 0.03)])
def test_lost_pixels_all_over_cost_almost_nothing(lost, tolerance):
    view = look(step(), camera_pose(0.0))
    top = (view.box == 1) & view.is_top
    whole, holed = (segment(white(view.image, 0.004, lost=share)) for share in (0.0, lost))
    assert iou(holed.labels, top) > iou(whole.labels, top) - tolerance
    for part in (whole, holed):
        label = np.bincount(part.labels[top & (part.labels >= 0)]).argmax()
        normal = -view.image.T_world_camera.R @ part.planes[label]
        assert np.rad2deg(np.arccos(normal[2] / np.linalg.norm(normal))) < 0.15


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, -1.0])
def test_pixels_that_are_no_depth_count_as_lost(value):
    image = with_noise(look(step(), camera_pose(0.0)).image, 0)
    lost = np.random.default_rng(0).random(image.depth.shape) < 0.05
    bad, zero = image.depth.copy(), image.depth.copy()
    bad[lost], zero[lost] = value, 0.0
    labels = [segment(DepthImage(depth, image.camera, image.T_world_camera, 0.0, 0)).labels for depth in (bad, zero)]
    np.testing.assert_array_equal(labels[0], labels[1])


def test_what_two_blocks_join_to_by_loose_limits_is_cut_again():
    tilt = np.deg2rad(6.0)
    boxes = [block(0.7, 0.0, 0.0, size=(0.4, 1.2, 0.4)), block(1.1, 0.0, 0.02, size=(0.4, 1.2, 0.4), pitch=-tilt)]
    view = look(boxes, camera_pose(0.0, down=0.9))
    loose = RegionParameters(link_angle=0.3, link_offset=0.03, grow_angle=0.3, grow_offset=0.03)
    extraction = examine_regions(white(view.image, 0.002), loose)
    slopes = [np.rad2deg(np.arccos(region.normal_world[2])) for region in extraction.regions.regions]
    assert any(slope < 0.5 for slope in slopes) and any(abs(slope - 6.0) < 0.5 for slope in slopes)
