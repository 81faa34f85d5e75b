import numpy as np
import pytest

from lookstep.bench.perception.measure import baseline_extractor, noisy
from lookstep.bench.perception.rapid_regions_baseline import BaselineParameters, fill_and_blur, find_regions
from lookstep.bench.perception.scenes import CAMERA, HELD_OUT_SEEDS, Scene, camera_pose, scene
from lookstep.bench.perception.truth import Truth, true_view
from sim_envs.courses import Box
from skills.geometry.pose import Pose
from skills.regions import RegionParameters


@pytest.fixture(scope="module")
def corner() -> Truth:
    """The corner of a room: a floor and two walls."""
    slabs = [((4.0, 4.0, 0.2), (0, 0, -0.1)), ((0.2, 4.0, 4.0), (1.1, 0, 1)), ((4.0, 0.2, 4.0), (0, 1.1, 1))]
    boxes = tuple(
        Box(f"slab_{index}", size, Pose(np.eye(3), np.array(p, dtype=float)), "block")
        for index, (size, p) in enumerate(slabs)
    )
    pose = camera_pose((-0.2, -0.2, 1.0), pitch=np.deg2rad(35.0), yaw=np.deg2rad(45.0))
    return true_view(Scene("corner", 0, boxes, CAMERA, pose))


@pytest.mark.parametrize("noise", ["none", "standard"])
def test_the_three_planes_of_a_corner_are_found(corner, noise):
    regions, labels = baseline_extractor()(noisy(corner.image, noise))
    large = [region for region in regions.regions if region.area > 0.1]
    assert len(large) == 3
    for normal, offset in (((-1, 0, 0), -1.0), ((0, -1, 0), -1.0), ((0, 0, 1), 0.0)):
        found = max(large, key=lambda region: region.normal_world @ normal)
        np.testing.assert_allclose(found.normal_world, normal, atol=0.01)
        assert found.normal_world @ found.T_world_region.p == pytest.approx(offset, abs=0.005)
    assert len(np.unique(labels[labels >= 0])) >= 3


def test_the_same_image_gives_the_same_regions():
    image = noisy(true_view(scene("contiguous", HELD_OUT_SEEDS[0])).image, "standard")
    first, _ = find_regions(image, RegionParameters())
    second, _ = find_regions(image, RegionParameters())
    assert [r.hull_region.tobytes() for r in first.regions] == [r.hull_region.tobytes() for r in second.regions]


def test_regions_end_where_depth_jumps():
    truth = true_view(scene("contiguous", HELD_OUT_SEEDS[0]))
    _, labels = find_regions(truth.image, RegionParameters(), BaselineParameters(blur=0.0))
    void = truth.image.depth == 0.0
    assert np.mean(labels[void] >= 0) < 0.02


def test_single_dead_pixels_are_filled(corner):
    depth = corner.image.depth.copy()
    dead = np.zeros(depth.shape, bool)
    dead[10:-10:5, 10:-10:5] = True
    depth[dead] = 0.0
    filled = fill_and_blur(depth, 0.0)
    assert np.abs(filled[dead] / corner.image.depth[dead] - 1.0).max() < 0.01
    np.testing.assert_array_equal(filled[~dead], depth[~dead])
