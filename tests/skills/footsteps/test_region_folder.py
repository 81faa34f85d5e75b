import json
import os
from pathlib import Path

import numpy as np
import pytest

from skills.footsteps.region_map import RegionMapError, map_files, read_region_map

DATA = os.environ.get("LOOKSTEP_DATA")
MAPS = sorted(Path(DATA, "planar_regions").glob("*.json")) if DATA else []
TRIANGLE = "0.0, 0.0\n1.0, 0.0\n0.0, 2.0\n"
HEADER = (
    "regionId: 7, index: 1, origin: 1.0, 2.0, 3.0, normal: 1.0, 0.0, 0.0, concave hull size: 3, "
    "number of convex polygons: 1, [3]\n"
    "regionId: 7, index: 2, origin: 0.0, 0.0, 0.0, normal: 0.0, 0.0, -1.0, concave hull size: 2, "
    "number of convex polygons: 0, []\n"
)
INPUTS = "start_position 0.5 0 0.0\ngoal_position 2.5 -2.0 0.1\ngoal_yaw -0.4\nstep_planner_status dev\n"


def data_set(folder: Path, header: str = HEADER, inputs: str = INPUTS) -> Path:
    regions = folder / "a_field" / "PlanarRegions"
    regions.mkdir(parents=True)
    (regions.parent / "PlannerInputs.txt").write_text(inputs)
    (regions / "header.txt").write_text(header)
    (regions / "region7_1").write_text(TRIANGLE + TRIANGLE)
    (regions / "region7_2").write_text("0.0, 0.0\n1.0, 0.0\n")
    return regions.parent


def test_a_folder_of_text_files_is_a_map(tmp_path: Path):
    folder = data_set(tmp_path)
    assert map_files(tmp_path) == [folder]
    found = read_region_map(folder)
    assert found.name == "a_field"
    np.testing.assert_allclose(found.start_world, (0.5, 0.0, 0.0, -np.pi / 4))
    np.testing.assert_allclose(found.goal_world, (2.5, -2.0, 0.1, -0.4))
    wall, line = found.regions.regions
    # The shortest turn that takes z to x takes x to -z and leaves y.
    np.testing.assert_allclose(wall.T_world_region.R, ((0, 0, 1), (0, 1, 0), (-1, 0, 0)), atol=1e-12)
    np.testing.assert_allclose(wall.hull_world, ((1, 2, 3), (1, 2, 2), (1, 4, 3)), atol=1e-12)
    assert len(wall.convex_parts_region) == 1 and wall.area == pytest.approx(1.0)
    assert len(line.hull_region) == 2 and not line.convex_parts_region
    np.testing.assert_allclose(line.T_world_region.R[:, 2], (0, 0, -1), atol=1e-12)


def test_older_data_sets_write_their_keys_otherwise(tmp_path: Path):
    inputs = "startPosition -2.000 -.500 0.000\ngoalPosition 5.000 0.500 0.000\nstartYaw 0.1\ntestVisGraph true\n"
    found = read_region_map(data_set(tmp_path, inputs=inputs))
    np.testing.assert_allclose(found.start_world, (-2.0, -0.5, 0.0, 0.1))


@pytest.mark.parametrize(
    ("header", "inputs", "message"),
    [
        ("regionId: 7\n", INPUTS, "header.txt:1: got 'regionId: 7', needs regionId: N, index"),
        (HEADER.replace("size: 3", "size: 4"), INPUTS, "region7_1: got 6 vertices, needs 7"),
        (HEADER.replace("[3]", "[3, 3]"), INPUTS, "header.txt:1: got 1 convex polygons, but 2 sizes"),
        (HEADER.replace("7, index: 2", "8, index: 1"), INPUTS, "region8_1: No such file"),
        (HEADER.replace("origin: 1.0", "origin: 1.0.0"), INPUTS, "header.txt:1: got '1.0.0', needs a number"),
        (HEADER, "goal_position 1 2 3\n", "start_position: got nothing, needs numbers"),
        (HEADER, INPUTS.replace("0.5 0", "0.5 east"), "PlannerInputs.txt:1: got 'east', needs a number"),
    ],
)
def test_what_is_no_data_set_is_refused_with_its_place(tmp_path: Path, header: str, inputs: str, message: str):
    with pytest.raises(RegionMapError) as caught:
        read_region_map(data_set(tmp_path, header, inputs))
    assert message in str(caught.value)


@pytest.mark.skipif(not MAPS, reason="LOOKSTEP_DATA does not point to a folder that holds planar_regions/*.json")
def test_published_maps_come_out_the_same_in_both_forms(tmp_path: Path):
    for file in MAPS:
        data = json.loads(file.read_text())
        folder = tmp_path / file.stem
        (folder / "PlanarRegions").mkdir(parents=True)
        keys = ("start_position", "goal_position", "start_yaw", "goal_yaw")
        lines = [f"{key} {' '.join(map(str, np.atleast_1d(data[key])))}" for key in keys if data.get(key) is not None]
        (folder / "PlannerInputs.txt").write_text("\n".join(lines))
        header = []
        for i, region in enumerate(data["regions"]):
            rings = [region["hull"], *region["convex_polygons"]]
            header.append(
                f"regionId: {i}, index: 1, origin: {', '.join(map(str, region['origin']))}, "
                f"normal: {', '.join(map(str, region['normal']))}, concave hull size: {len(rings[0])}, "
                f"number of convex polygons: {len(rings) - 1}, [{', '.join(str(len(ring)) for ring in rings[1:])}]"
            )
            vertices = (f"{x}, {y}" for ring in rings for x, y in ring)
            (folder / "PlanarRegions" / f"region{i}_1").write_text("\n".join(vertices))
        (folder / "PlanarRegions" / "header.txt").write_text("\n".join(header))
        one, other = read_region_map(file), read_region_map(folder)
        np.testing.assert_allclose(one.start_world, other.start_world)
        np.testing.assert_allclose(one.goal_world, other.goal_world)
        for a, b in zip(one.regions.regions, other.regions.regions, strict=True):
            np.testing.assert_allclose(a.hull_world, b.hull_world, atol=1e-6)
            assert a.area == pytest.approx(b.area)
