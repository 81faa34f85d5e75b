import numpy as np
import pytest
from open_loop import random_field, rectangle, region_map

from skills.footsteps import FootstepParameters, RegionTerrain, TerrainParameters, region_terrain, whole_sole
from skills.geometry.pose import Pose
from skills.regions.planar_region import PlanarRegion, PlanarRegions

PARAMETERS = FootstepParameters()


def terrain(*regions: PlanarRegion, **options: float) -> RegionTerrain:
    low, high = np.array((-1.5, -1.5)), np.array((1.5, 1.5))
    return region_terrain(region_map(*regions), low, high, TerrainParameters(**options))


def test_heights_are_those_of_the_highest_region_in_a_cell():
    regions = random_field(1)
    # With this cell size no centre lies on an edge.
    parameters = TerrainParameters(seam_width=0.0, resolution=0.0093)
    ground = region_terrain(regions, np.array((-1.0, -1.0)), np.array((5.0, 1.0)), parameters)
    points = np.random.default_rng(0).uniform((-0.9, -0.9), (4.9, 0.9), (3000, 2))
    # The raster decides by cell centres; so does the reference.
    centres = ground.corner_world + (np.floor((points - ground.corner_world) / 0.0093) + 0.5) * 0.0093
    in_cell, at_point = np.empty((2, len(regions.regions), len(points)))
    for i, region in enumerate(regions.regions):
        n, p = region.normal_world, region.T_world_region.p
        heights = p[2] - ((points - p[:2]) @ n[:2]) / n[2]
        heights_centres = p[2] - ((centres - p[:2]) @ n[:2]) / n[2]
        local = region.T_world_region.inverse @ np.column_stack((centres, heights_centres))
        half = np.abs(region.hull_region).max(axis=0)
        in_cell[i] = np.where(np.all(np.abs(local[:, :2]) < half, axis=1), heights_centres, -np.inf)
        at_point[i] = heights
    highest, known = np.argmax(in_cell, axis=0), np.isfinite(in_cell.max(axis=0))
    found = ground.heights(points)
    assert np.array_equal(np.isfinite(found), known)
    np.testing.assert_allclose(found[known], at_point[highest, np.arange(len(points))][known], atol=1e-9)


def test_later_region_replaces_an_older_one_and_the_higher_wins_at_the_same_time():
    old = rectangle((0.0, 0.0, 0.3), size=(1.0, 1.0), time=1.0)
    new = rectangle((0.0, 0.0, 0.1), size=(1.0, 1.0), time=2.0)
    low = rectangle((0.0, 0.0, 0.05), size=(1.0, 1.0), time=2.0)
    at = np.zeros((1, 2))
    assert terrain(old, new).heights(at)[0] == pytest.approx(0.1)
    assert terrain(new, low).heights(at)[0] == pytest.approx(0.1)
    assert terrain(low, new).heights(at)[0] == pytest.approx(0.1)


def test_holes_stay_open():
    outline = np.array(((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)))
    hole = 0.2 * outline[::-1]
    ground = terrain(PlanarRegion(Pose.identity(), outline, (outline,), 0.96, 0.0, (hole,)))
    heights = ground.heights(np.array(((0.0, 0.0), (0.3, 0.0), (0.095, 0.0), (0.105, 0.0))))
    assert np.isnan(heights[0]) and np.isnan(heights[2])
    assert heights[1] == 0.0 and heights[3] == 0.0


def test_sole_lies_in_a_tilted_plane():
    ground = terrain(rectangle((0.1, 0.0, 0.2), (0.1, -0.2, 0.0), size=(1.0, 1.0)))
    found = ground.snap(0.2, 0.1, 0.4, PARAMETERS)
    assert found.usable and found.share == 1.0
    assert found.T_world_sole is not None
    normal = Pose.from_xyz_rpy((0, 0, 0), (0.1, -0.2, 0.0)).R[:, 2]
    np.testing.assert_allclose(found.T_world_sole.R[:, 2], normal, atol=1e-12)
    assert (found.T_world_sole.p - (0.1, 0.0, 0.2)) @ normal == pytest.approx(0.0, abs=1e-12)
    assert found.T_world_sole.yaw == pytest.approx(0.4, abs=1e-12)


def test_level_neighbours_carry_one_sole_together_across_their_seam():
    blocks = [rectangle((0.19 * s, 0.0, 0.003 * s), size=(0.36, 0.5)) for s in (-1, 1)]
    for x in np.linspace(-0.1, 0.1, 9):
        found = terrain(*blocks).snap(float(x), 0.0, 0.0, PARAMETERS)
        assert found.usable, (x, found.reason)


@pytest.mark.parametrize(
    ("xyz", "rpy", "reason"),
    [
        ((0.0, 0.0, 0.0), (0.0, 0.5, 0.0), "too steep"),
        ((0.25, 0.0, 0.0), (0.0, 0.0, 0.0), "foothold too small"),
        ((2.0, 0.0, 0.0), (0.0, 0.0, 0.0), "no ground"),
    ],
)
def test_bad_ground_is_named(xyz: tuple[float, float, float], rpy: tuple[float, float, float], reason: str):
    assert terrain(rectangle(xyz, rpy, size=(0.6, 0.6))).snap(0.0, 0.0, 0.0, PARAMETERS).reason == reason


def test_ground_that_sticks_through_the_sole_is_refused():
    floor = rectangle((0.0, 0.0, 0.0), size=(2.0, 2.0))
    assert terrain(floor, rectangle((0.11, 0.05, 0.03), size=(0.03, 0.03))).snap(0, 0, 0, PARAMETERS).reason == (
        "ground above the sole"
    )
    assert terrain(floor, rectangle((0.11, 0.05, 0.005), size=(0.03, 0.03))).snap(0, 0, 0, PARAMETERS).usable


def test_cliff_is_felt_before_the_toe_and_beside_the_sole():
    floor = rectangle((0.0, 0.0, 0.0), size=(2.0, 2.0))
    for gap, usable in ((0.025, False), (0.055, True)):
        wall = rectangle((0.13 + gap + 0.1, 0.0, 0.08), size=(0.2, 0.5))
        assert terrain(floor, wall).snap(0.0, 0.0, 0.0, PARAMETERS).usable is usable
        assert terrain(floor, wall).snap(-0.01, 0.0, np.pi, PARAMETERS).usable


def test_foothold_is_the_supported_part_of_the_sole():
    ledge = terrain(rectangle((-0.3, 0.0, 0.0), size=(0.8, 1.0)))
    partial = FootstepParameters(share=0.5)
    found = ledge.snap(0.02, 0.0, 0.0, partial)
    assert found.usable and 0.7 < found.share < 1.0
    assert found.T_world_sole is not None
    polygon = ledge.foothold_polygon(found.T_world_sole, partial)
    assert polygon[:, 0].max() == pytest.approx(0.08, abs=1e-9)  # The ledge ends at x = 0.1.
    np.testing.assert_allclose(polygon[:, 0].min(), -0.13)
    np.testing.assert_allclose(np.abs(polygon[:, 1]).max(), 0.069)
    area = 0.5 * np.sum(polygon[:, 0] * np.roll(polygon[:, 1], -1) - polygon[:, 1] * np.roll(polygon[:, 0], -1))
    assert area > 0.0
    whole = ledge.foothold_polygon(Pose.from_xyz_rpy((-0.3, 0.0, 0.0)), PARAMETERS)
    assert {tuple(np.round(v, 9)) for v in whole} == {tuple(np.round(v, 9)) for v in whole_sole(PARAMETERS)}


def test_foothold_on_two_tilted_planes_ends_where_one_leaves_the_sole():
    """A crease under the sole: the far side falls away, and carries as far as it is no deeper than allowed."""
    near = rectangle((-0.5, 0.0, 0.0), size=(1.0, 1.0))
    far = rectangle((0.5 * np.cos(0.2), 0.0, -0.5 * np.sin(0.2)), (0.0, 0.2, 0.0), size=(1.0, 1.0))
    partial = FootstepParameters(share=0.3)
    ground = terrain(near, far)
    found = ground.snap(-0.05, 0.0, 0.0, partial)
    assert found.usable and found.T_world_sole is not None
    polygon = ground.foothold_polygon(found.T_world_sole, partial)
    assert polygon[:, 0].max() == pytest.approx(0.05 + partial.support_below / np.tan(0.2), abs=1e-9)


def test_degenerate_and_vertical_regions_are_left_out():
    sliver = PlanarRegion(Pose.identity(), np.zeros((3, 2)), (), 0.0, 0.0)
    empty = PlanarRegion(Pose.identity(), np.zeros((0, 2)), (), 0.0, 0.0)
    wall = rectangle((0.0, 0.0, 0.5), (0.0, np.pi / 2, 0.0))
    broken = PlanarRegion(Pose(np.eye(3), np.full(3, np.nan)), np.array(((0, 0), (1, 0), (0, 1))), (), 0.5, 0.0)
    assert np.all(terrain(sliver, empty, wall, broken).raster.cells == -1)
    nothing = region_terrain(PlanarRegions((), 0.0, 3), np.zeros(2), np.ones(2), TerrainParameters())
    assert nothing.frame_id == 3
    assert not nothing.snap(0.5, 0.5, 0.0, PARAMETERS).usable
