import numpy as np
import pytest

from skills.geometry.camera import DepthImage, PinholeCamera
from skills.geometry.pose import Pose
from skills.regions import extract_regions

CAMERA = PinholeCamera(4, 3, 5.0, 5.0, 1.5, 1.0)


@pytest.mark.parametrize("dtype", [np.uint16, np.int32, np.uint32, np.int64])
def test_whole_numbers_are_millimetres(dtype):
    image = DepthImage.from_array(np.full((3, 4), 1500, dtype), CAMERA)
    assert image.depth.dtype == np.float32
    np.testing.assert_allclose(image.depth, 1.5)


@pytest.mark.parametrize("dtype", [np.float16, np.float32, np.float64, ">f4"])
def test_floats_are_metres(dtype):
    np.testing.assert_allclose(DepthImage.from_array(np.full((3, 4), 1.5, dtype), CAMERA).depth, 1.5)


def test_a_scale_is_in_values_a_metre():
    assert DepthImage.from_array(np.full((3, 4), 7500, np.uint16), CAMERA, scale=5000.0).depth[0, 0] == 1.5
    assert DepthImage.from_array(np.full((3, 4), 150.0), CAMERA, scale=100.0).depth[0, 0] == 1.5


def test_what_is_no_positive_number_is_no_depth():
    values = np.full((3, 4), 2.0)
    values[0] = np.nan, np.inf, -np.inf, -1.0
    values[1, 0] = 1e300
    depth = DepthImage.from_array(values, CAMERA).depth
    assert np.all(depth[0] == 0.0) and depth[1, 0] == 0.0
    assert np.all(depth[2] == 2.0)


def test_the_given_array_stays_writable_and_apart():
    values = np.ones((3, 4), np.float32)
    image = DepthImage.from_array(values, CAMERA, time=2.0, frame_id=7)
    values[:] = 5.0
    assert np.all(image.depth == 1.0) and (image.time, image.frame_id) == (2.0, 7)


def test_a_camera_of_unknown_pose_looks_down():
    image = DepthImage.from_array(np.ones((3, 4)), CAMERA)
    np.testing.assert_allclose(image.T_world_camera @ np.array((0.0, 0.0, 1.0)), (0.0, 0.0, -1.0))
    np.testing.assert_allclose(np.linalg.det(image.T_world_camera.R), 1.0)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        (np.zeros((3, 4, 3), np.uint16), r"shape \(3, 4, 3\)"),
        (np.zeros(12), r"shape \(12,\)"),
        (np.zeros((0, 0)), "got 0 x 0 pixels"),
        (np.zeros((4, 3)), "got 3 x 4 pixels, the camera has 4 x 3"),
        (np.zeros((3, 4), np.int8), "type int8"),
        (np.zeros((3, 4), np.uint8), "type uint8"),
        (np.zeros((3, 4), bool), "type bool"),
        (np.zeros((3, 4), complex), "type complex128"),
        (np.full((3, 4), "x"), "type <U1"),
    ],
)
def test_what_is_no_depth_image_is_refused(values, message):
    with pytest.raises(ValueError, match=message):
        DepthImage.from_array(values, CAMERA)


@pytest.mark.parametrize("scale", [0.0, -1000.0, np.nan, np.inf])
def test_a_scale_that_is_none_is_refused(scale):
    with pytest.raises(ValueError, match="scale"):
        DepthImage.from_array(np.ones((3, 4)), CAMERA, scale=scale)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"fx": 0.0}, "fx: got 0.0"),
        ({"fy": -5.0}, "fy"),
        ({"fx": np.nan}, "fx"),
        ({"cy": np.inf}, "cy"),
        ({"width": 0}, "0 x 3 pixels"),
        ({"near": 2.0, "far": 1.0}, "near"),
    ],
)
def test_a_camera_that_sees_nothing_is_refused(change, message):
    values = {"width": 4, "height": 3, "fx": 5.0, "fy": 5.0, "cx": 1.5, "cy": 1.0} | change
    with pytest.raises(ValueError, match=message):
        PinholeCamera(**values)


@pytest.mark.parametrize("size", [(1, 1), (7, 5), (1, 40), (33, 2), (64, 48)])
@pytest.mark.parametrize("value", [0.0, 1.0, np.nan, 1e30])
def test_images_too_small_or_empty_have_no_regions_or_sound_ones(size, value):
    width, height = size
    camera = PinholeCamera(width, height, 50.0, 50.0, 0.5 * width - 0.5, 0.5 * height - 0.5)
    regions = extract_regions(DepthImage.from_array(np.full((height, width), value), camera)).regions
    if value != 1.0 or min(size) < 16:
        assert regions == ()
    for region in regions:
        assert np.allclose(region.normal_world, (0.0, 0.0, 1.0)) and region.area > 0.0


def test_a_pose_moves_the_regions():
    camera = PinholeCamera(64, 48, 50.0, 50.0, 31.5, 23.5)
    depth = np.full((48, 64), 1000, np.uint16)
    T_world_camera = Pose(np.diag((1.0, -1.0, -1.0)), np.array((3.0, 2.0, 1.2)))
    (region,) = extract_regions(DepthImage.from_array(depth, camera, T_world_camera=T_world_camera)).regions
    np.testing.assert_allclose(region.T_world_region.p, (3.0, 2.0, 0.2), atol=1e-6)
    assert region.area == pytest.approx(64 * 48 / 50.0**2, rel=0.02)
