from dataclasses import replace

import numpy as np
import pytest

from lookstep.bench.perception.fill import fill
from lookstep.bench.perception.ground_cells import CELL, TrueGround, ground_figures, judge_ground, true_ground
from lookstep.bench.perception.measure import extractor, measure_quality, noisy
from lookstep.bench.perception.quality import figures, judge
from lookstep.bench.perception.scenes import HELD_OUT_SEEDS, NOISES, SCENES, TUNING_SEEDS, Scene, camera_pose, scene
from lookstep.bench.perception.truth import VOID, Truth, true_view
from sim_envs.courses import Box, Ground
from skills.geometry.camera import PinholeCamera
from skills.geometry.polygon import contains_points
from skills.geometry.pose import Pose, rotation_y
from skills.regions import PlanarRegion, PlanarRegions

CAMERA = PinholeCamera(320, 240, 230.0, 230.0, 159.5, 119.5)


def slab(x: float, top: float, length=0.5, width=0.5, pitch=0.0, name="slab") -> Box:
    R = rotation_y(pitch)
    return Box(name, (length, width, 0.1), Pose(R, np.array((x, 0.0, top)) - R @ np.array((0.0, 0.0, 0.05))), "block")


def top(box: Box, grow=0.0, lift=0.0, pitch=0.0) -> PlanarRegion:
    """The upper face of a slab as a region, and ways to spoil it."""
    half = 0.5 * np.array(box.size[:2]) + grow
    hull = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * half
    T_box_top = Pose(rotation_y(pitch), np.array((0.0, 0.0, 0.05 + lift)))
    return PlanarRegion(box.T_world_box @ T_box_top, hull, (hull,), float(4.0 * half.prod()), 0.0)


def seen(*boxes: Box) -> tuple[Truth, Scene]:
    """The boxes from straight above, so that no side is in view."""
    looked_at = Scene("test", 0, boxes, CAMERA, camera_pose((0.0, 0.0, 1.2), pitch=0.5 * np.pi))
    return true_view(looked_at), looked_at


def ground_of(*boxes: Box) -> TrueGround:
    return true_ground(seen(*boxes)[0], Ground(boxes))


def regions(*found: PlanarRegion) -> PlanarRegions:
    return PlanarRegions(found, 0.0, 0)


TWO = (slab(-0.3, 0.0, name="near"), slab(0.3, 0.1, name="far"))
LEVEL = (slab(-0.25, 0.0, name="near"), slab(0.25, 0.0, name="far"))


def test_filling_is_by_the_centres_of_cells():
    rng = np.random.default_rng(0)
    angle = np.sort(rng.uniform(0.0, 2.0 * np.pi, 17))
    ring = np.column_stack((np.cos(angle), np.sin(angle))) * rng.uniform(8.0, 30.0, 17)[:, None] + (20.0, 25.0)
    hole = np.array([(18.2, 23.1), (18.2, 27.3), (23.4, 25.2)])
    mask, row, column = fill([ring, hole], (48, 40))
    whole = np.zeros((48, 40), bool)
    whole[row : row + mask.shape[0], column : column + mask.shape[1]] = mask
    v, u = np.indices(whole.shape)
    points = np.column_stack((u.ravel(), v.ravel())).astype(float)
    np.testing.assert_array_equal(whole.ravel(), contains_points(ring, points) ^ contains_points(hole, points))


def test_perfect_regions_score_one():
    truth, _ = seen(*TWO)
    found = figures(judge(truth, regions(*map(top, TWO)), truth.face))
    assert found["faces"] == 2
    assert found["recall"] == found["iou"] == found["label_iou"] == 1.0
    assert found["normal_deg_p90"] == pytest.approx(0.0, abs=1e-5)
    assert found["offset_mm_p90"] == pytest.approx(0.0, abs=1e-3)
    assert found["false_area"] == found["stray_area"] == 0.0


def test_a_shifted_plane_scores_its_shift():
    truth, _ = seen(*TWO)
    found = figures(judge(truth, regions(*(top(box, lift=0.003) for box in TWO))))
    assert found["recall"] == 1.0
    assert found["offset_mm_median"] == pytest.approx(3.0, abs=1e-3)
    assert found["normal_deg_median"] == pytest.approx(0.0, abs=1e-5)
    assert found["false_area"] == 0.0


def test_a_turned_plane_scores_its_angle():
    truth, _ = seen(*TWO)
    found = figures(judge(truth, regions(*(top(box, pitch=np.deg2rad(4.0)) for box in TWO))))
    assert found["normal_deg_median"] == pytest.approx(4.0, abs=1e-6)
    assert found["offset_mm_p90"] == pytest.approx(0.0, abs=0.3)


def test_a_grown_outline_scores_its_overlap():
    truth, _ = seen(TWO[0])
    found = figures(judge(truth, regions(top(TWO[0], grow=0.05))))
    assert found["iou"] == pytest.approx((0.5 / 0.6) ** 2, abs=0.01)
    assert found["stray_area"] == pytest.approx(1.0 - (0.5 / 0.6) ** 2, abs=0.01)


def test_nothing_found_is_nothing_recalled():
    truth, _ = seen(*TWO)
    found = figures(judge(truth, regions(), np.full(truth.face.shape, -1)))
    assert found["recall"] == found["label_iou"] == found["false_area"] == 0.0


def test_a_region_over_two_planes_misses_one_of_them_or_both():
    lower, upper = LEVEL[0], slab(0.25, 0.06, name="far")
    truth, _ = seen(lower, upper)
    wide = np.array([(-0.5, -0.25), (0.5, -0.25), (0.5, 0.25), (-0.5, 0.25)])
    on_lower = PlanarRegion(Pose.identity(), wide, (wide,), 0.5, 0.0)
    found = figures(judge(truth, regions(on_lower)))
    assert found["recall"] <= 0.5
    assert found["false_area"] == 0.0
    assert found["stray_area"] == pytest.approx(0.5, abs=0.05)
    between = PlanarRegion(Pose(np.eye(3), np.array((0.0, 0.0, 0.03))), wide, (wide,), 0.5, 0.0)
    assert figures(judge(truth, regions(between)))["false_area"] == 1.0


def test_neighbours_in_one_plane_may_share_a_region_or_not():
    truth, _ = seen(*LEVEL)
    wide = np.array([(-0.5, -0.25), (0.5, -0.25), (0.5, 0.25), (-0.5, 0.25)])
    shared = PlanarRegion(Pose.identity(), wide, (wide,), 0.5, 0.0)
    for found in (regions(shared), regions(*map(top, LEVEL))):
        assert figures(judge(truth, found))["recall"] == 1.0
        assert figures(judge(truth, found))["iou"] == pytest.approx(1.0, abs=0.01)


def test_a_phantom_region_is_false_area():
    truth, _ = seen(*TWO)
    phantom = top(slab(0.3, 0.2))
    found = figures(judge(truth, regions(*map(top, TWO), phantom)))
    assert found["recall"] == 1.0
    assert found["false_area"] == pytest.approx(1.0 / 3.0)
    over_the_pit = PlanarRegion(Pose(np.eye(3), np.array((0.0, 0.5, 0.0))), *replaced_hull(0.1))
    assert figures(judge(truth, regions(over_the_pit)))["false_area"] == 1.0


def replaced_hull(half: float) -> tuple:
    hull = half * np.array([(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)])
    return hull, (hull,), 4.0 * half**2, 0.0


def test_what_is_too_deep_is_not_judged():
    _, looked_at = seen(*TWO)
    near_only = true_view(looked_at, depth_max=1.15)
    found = figures(judge(near_only, regions(*map(top, TWO))))
    assert (found["faces"], found["recall"], found["false_area"]) == (1, 1.0, 0.0)


def test_a_face_in_two_pieces_counts_twice():
    truth, _ = seen(slab(0.0, 0.0, length=1.0), slab(0.0, 0.2, length=0.1, width=0.8, name="bar"))
    assert np.count_nonzero(truth.pixels >= 1500) == 3
    assert (truth.face == VOID).any()


def test_perfect_ground_is_right_everywhere():
    ground = ground_of(*TWO)
    found = ground_figures([judge_ground(ground, regions(*map(top, TWO)))])
    assert found["coverage"] == pytest.approx(1.0, abs=0.02)
    assert found["wrong_height"] == found["wrong_slope"] == 0.0


def test_ground_that_reaches_past_its_block_is_wrong():
    ground = ground_of(TWO[0])
    cells = judge_ground(ground, regions(top(TWO[0], grow=2 * CELL)))
    assert cells.covered == pytest.approx(54**2, rel=0.01)
    assert cells.wrong_height == pytest.approx(54**2 - 50**2, rel=0.05)


def test_tilted_and_lifted_ground_is_counted():
    ground = ground_of(TWO[0])
    turned, lifted = top(TWO[0], pitch=np.deg2rad(6.0)), top(TWO[0], lift=0.02)
    assert ground_figures([judge_ground(ground, regions(turned))])["wrong_slope"] == 1.0
    assert ground_figures([judge_ground(ground, regions(lifted))])["wrong_height"] == 1.0


def test_the_higher_of_two_regions_is_the_ground():
    ground = ground_of(TWO[0])
    below = top(TWO[0], lift=-0.05)
    cells = judge_ground(ground, regions(top(TWO[0]), below))
    assert cells.wrong_height == 0


@pytest.mark.parametrize("name", SCENES)
def test_truth_agrees_with_the_depth(name):
    truth = true_view(scene(name, HELD_OUT_SEEDS[0], CAMERA))
    on_face = truth.face >= 0
    planes = truth.planes[truth.face[on_face]]
    off = np.einsum("ni,ni->n", planes[:, :3], truth.points[on_face]) - planes[:, 3]
    assert np.abs(off).max() < 1e-4
    np.testing.assert_array_equal(np.bincount(truth.face[on_face], minlength=len(truth.planes)), truth.pixels)
    ground = Ground(scene(name, HELD_OUT_SEEDS[0]).boxes)
    upward = planes[:, 2] > 0.7
    height = ground.ground_height(truth.points[on_face][upward][:, :2])
    # A little of what is in view lies under a leaning side.
    assert np.mean(np.abs(height - truth.points[on_face][upward][:, 2]) < 1e-4) > 0.95


def test_scenes_for_tuning_are_not_those_held_out():
    assert not set(TUNING_SEEDS) & set(HELD_OUT_SEEDS)
    assert len(HELD_OUT_SEEDS) >= 50


def test_noise_depends_on_the_frame_alone():
    image = true_view(scene("scattered", 3)).image
    first = noisy(image, "standard")
    noisy(replace(image, frame_id=4), "standard")
    np.testing.assert_array_equal(noisy(image, "standard").depth, first.depth)
    np.testing.assert_array_equal(noisy(image, "none").depth, image.depth)


@pytest.mark.parametrize("noise", NOISES)
def test_extraction_finds_the_faces_of_unseen_scenes(noise):
    found = measure_quality(extractor(), "scattered", noise, HELD_OUT_SEEDS[:1])
    assert found["recall"] > 0.85
    assert found["iou"] > 0.85
    assert found["false_area"] < 0.05
