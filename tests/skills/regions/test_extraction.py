from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from block_fields import L515, Box, View, block, camera_pose, look, with_noise

from lookstep.bench.perception.ground_cells import ground_figures, judge_ground, true_ground
from lookstep.bench.perception.measure import TrueFrame, extractor, frame_figures, judge_frame, noisy, true_frame
from lookstep.bench.perception.scenes import HELD_OUT_SEEDS, scene
from lookstep.bench.perception.truth import true_view
from sim_envs.courses import Ground
from skills.geometry.camera import DepthImage, PinholeCamera
from skills.geometry.capsule import Capsule
from skills.geometry.polygon import contains_points, signed_area
from skills.geometry.pose import Pose
from skills.regions import PlanarRegions, RegionParameters, examine_regions, extract_regions

HELD_OUT = HELD_OUT_SEEDS[:3]
SMALL = L515.scaled(0.3125)  # 320 x 240


@cache
def true_field(seed: int) -> TrueFrame:
    return true_frame("contiguous", seed, RegionParameters().depth_max)


@cache
def found(noise: str) -> dict[str, float]:
    """How well touching blocks are found, over scenes that were never used to choose a parameter."""
    extract = extractor()
    return frame_figures([judge_frame(extract, true_field(seed), noise) for seed in HELD_OUT])


def noisy_field(seed: int) -> DepthImage:
    return noisy(true_field(seed).truth.image, "standard")


def ground(camera: PinholeCamera = L515, height=1.05, *boxes: Box) -> View:
    return look([block(0.5, 0.0, 0.0, size=(4.0, 3.0, 0.1)), *boxes], camera_pose(0.0, height=height), camera)


def region_at(regions: PlanarRegions, x: float, y: float) -> list[float]:
    """Heights of the regions over a place."""
    heights = []
    for region in regions.regions:
        T, n = region.T_world_region, region.normal_world
        z = T.p[2] - (n[0] * (x - T.p[0]) + n[1] * (y - T.p[1])) / n[2]
        point = (T.inverse @ np.array((x, y, z)))[None, :2].copy()
        inside = contains_points(region.hull_region, point)[0]
        if inside and not any(contains_points(hole, point)[0] for hole in region.holes_region):
            heights.append(float(z))
    return heights


def test_touching_blocks_are_found_in_standard_noise():
    assert found("standard")["recall"] >= 0.91
    assert found("standard")["iou"] >= 0.95
    assert found("standard")["coverage"] >= 0.97


def test_touching_blocks_are_not_smeared_together():
    assert found("standard")["wrong_height"] <= 0.01
    assert found("standard")["wrong_slope"] <= 0.02
    assert found("standard")["false_area"] <= 0.01


def test_planes_are_accurate():
    assert found("standard")["normal_deg_median"] <= 0.2
    assert found("standard")["normal_deg_p90"] <= 1.0
    assert found("standard")["offset_mm_p90"] <= 0.5


def test_strong_correlated_noise_costs_little():
    assert found("correlated_4mm")["recall"] >= 0.85
    assert found("correlated_4mm")["coverage"] >= 0.96
    assert found("correlated_4mm")["wrong_height"] <= 0.013


def test_a_block_tilted_by_11_degrees_parts_from_level_neighbours():
    tilt = np.deg2rad(11.0)
    boxes = [
        block(0.6 + 0.37 * i, 0.39 * j, 0.0, pitch=tilt if i == j == 1 else 0.0) for i in range(3) for j in range(3)
    ]
    view = look(boxes, camera_pose(0.0, y=0.39))
    regions = extract_regions(with_noise(view.image, 0)).regions
    slopes = np.sort([np.rad2deg(np.arccos(region.normal_world[2])) for region in regions if region.area > 0.05])
    assert slopes[-1] == pytest.approx(11.0, abs=0.3)
    assert np.all(slopes[:-1] < 0.3)


def test_without_noise_a_plane_is_exact():
    view = ground()
    (region,) = extract_regions(view.image).regions
    assert np.arccos(min(region.normal_world[2], 1.0)) < 1e-5
    assert abs(region.T_world_region.p[2]) < 1e-5


def test_regions_are_well_formed():
    for region in extract_regions(noisy_field(HELD_OUT[0])).regions:
        R = region.T_world_region.R
        np.testing.assert_allclose(R @ R.T, np.eye(3), atol=1e-12)
        assert R[2, 2] > 0.0
        assert signed_area(region.hull_region) > 0.0
        assert all(signed_area(hole) < 0.0 for hole in region.holes_region)
        assert all(signed_area(part) > 0.0 for part in region.convex_parts_region)
        parts = sum(signed_area(part) for part in region.convex_parts_region)
        assert region.area <= parts + 1e-9


def test_the_same_image_gives_the_same_bits():
    image = noisy_field(HELD_OUT[0])
    first, second = extract_regions(image), extract_regions(image)
    assert len(first.regions) == len(second.regions)
    for a, b in zip(first.regions, second.regions, strict=True):
        assert a.hull_region.tobytes() == b.hull_region.tobytes()
        assert a.T_world_region.p.tobytes() == b.T_world_region.p.tobytes()


def test_a_pit_in_a_floor_is_a_hole_in_its_region():
    slabs = [
        block(0.6, 0.7, 0.0, size=(2.0, 1.0, 0.1)),
        block(0.6, -0.7, 0.0, size=(2.0, 1.0, 0.1)),
        block(0.4, 0.0, 0.0, size=(0.8, 0.4, 0.1)),
        block(1.4, 0.0, 0.0, size=(0.6, 0.4, 0.1)),
    ]
    regions = extract_regions(with_noise(look(slabs, camera_pose(0.0)).image, 0))
    assert max(len(region.holes_region) for region in regions.regions) == 1
    assert region_at(regions, 0.95, 0.0) == []
    assert len(region_at(regions, 0.95, 0.4)) == 1


@pytest.mark.parametrize("lost", [0.3, 0.7])
def test_lost_pixels_lose_no_region(lost):
    view = ground()
    depth = view.image.depth.copy()
    depth[np.random.default_rng(0).random(depth.shape) < lost] = 0.0
    image = DepthImage(depth, view.image.camera, view.image.T_world_camera, 0.0, 0)
    (region,) = extract_regions(image).regions
    whole = extract_regions(view.image).regions[0]
    assert region.area == pytest.approx(whole.area, rel=0.02)
    assert np.arccos(min(region.normal_world[2], 1.0)) < 1e-4


def test_a_small_camera_sees_the_same_blocks():
    looked_at = scene("contiguous", HELD_OUT[0], SMALL)
    truth = true_view(looked_at, 2.0)
    regions = extract_regions(with_noise(truth.image, 0))
    cells = ground_figures([judge_ground(true_ground(truth, Ground(looked_at.boxes)), regions)])
    assert cells["coverage"] >= 0.85
    assert cells["wrong_height"] <= 0.03


def test_walls_are_rejected_with_their_slope():
    view = ground(L515, 1.05, block(1.2, 0.0, 0.5, size=(0.2, 1.0, 0.6)))
    extraction = examine_regions(with_noise(view.image, 0))
    assert any("slope" in rejected.reason for rejected in extraction.rejected)
    assert all(region.normal_world[2] > np.cos(np.deg2rad(40.0)) for region in extraction.regions.regions)


def test_what_is_very_near_is_the_own_body():
    view = ground(L515, 1.05, block(0.25, 0.0, 0.75, size=(0.3, 0.2, 0.1)))
    extraction = examine_regions(with_noise(view.image, 0))
    assert any("own body" in rejected.reason for rejected in extraction.rejected)
    assert all(region.T_world_region.p[2] < 0.1 for region in extraction.regions.regions)


def test_capsules_of_the_body_leave_no_ground():
    foot = block(0.75, 0.0, 0.1, size=(0.26, 0.14, 0.1))
    image = with_noise(ground(L515, 1.05, foot).image, 0)
    body = (Capsule(np.array((0.62, 0.0, 0.05)), np.array((0.88, 0.0, 0.05)), 0.1),)
    assert any(height > 0.05 for height in region_at(extract_regions(image), 0.75, 0.0))
    assert not any(height > 0.05 for height in region_at(extract_regions(replace(image, body_world=body)), 0.75, 0.0))


def test_a_barrel_is_no_ground():
    view = ground()
    camera, depth = view.image.camera, view.image.depth.copy()
    _, u = np.indices(depth.shape)
    x = (u - camera.cx) / camera.fx
    # A cylinder of radius 0.12 m whose axis is parallel to the image's columns, 0.9 m ahead.
    a, b = x**2 + 1.0, -2.0 * 0.9
    root = b * b - 4.0 * a * (0.9**2 - 0.12**2)
    near = np.where(root > 0.0, (-b - np.sqrt(np.maximum(root, 0.0))) / (2.0 * a), np.inf)
    depth = np.minimum(depth, near).astype(np.float32)
    image = with_noise(DepthImage(depth, camera, view.image.T_world_camera, 0.0, 0), 0)
    for region in extract_regions(image).regions:
        assert abs(region.T_world_region.p[2]) < 0.02 or region.area < 0.05


@pytest.mark.parametrize("value", [0.0, np.nan, np.inf, 50.0])
def test_an_image_without_depth_has_no_regions(value):
    image = DepthImage(np.full((240, 320), value, np.float32), SMALL, Pose.identity(), 1.0, 7)
    found = extract_regions(image)
    assert (found.regions, found.time, found.frame_id) == ((), 1.0, 7)


def test_parameters_out_of_range_are_refused():
    with pytest.raises(ValueError, match="area_min"):
        RegionParameters(area_min=-1.0)
