import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from skills.footsteps.region_map import RegionMapError, map_files, read_region_map

SQUARE = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]


def region(**changes: Any) -> dict[str, Any]:
    fields = {
        "origin": [1.0, 2.0, 0.5],
        "normal": [0.0, 0.0, 1.0],
        "quaternion_xyzw": [0.0, 0.0, 0.0, 1.0],
        "hull": SQUARE,
        "convex_polygons": [SQUARE],
    }
    return {**fields, **changes}


def content(**changes: Any) -> dict[str, Any]:
    return {"start_position": [0, 0, 0], "goal_position": [1, 1, 0.2], "regions": [region()], **changes}


def written(folder: Path, data: Any) -> Path:
    path = folder / "a_map.json"
    path.write_text(data if isinstance(data, str) else json.dumps(data))
    return path


def test_a_map_has_a_name_regions_start_and_goal(tmp_path: Path):
    found = read_region_map(written(tmp_path, content(goal_yaw=0.5, status_2019="dev")))
    assert (found.name, found.note) == ("a_map", "dev")
    np.testing.assert_allclose(found.start_world, (0, 0, 0, np.pi / 4))
    np.testing.assert_allclose(found.goal_world, (1, 1, 0.2, 0.5))
    (only,) = found.regions.regions
    np.testing.assert_allclose(only.hull_world[2], (2.0, 3.0, 0.5))
    assert only.area == pytest.approx(1.0)


def test_outlines_run_counter_clockwise_whatever_the_file_has(tmp_path: Path):
    found = read_region_map(written(tmp_path, content(regions=[region(hull=SQUARE[::-1])])))
    hull = found.regions.regions[0].hull_region
    assert np.sum(hull[:, 0] * np.roll(hull[:, 1], -1) - hull[:, 1] * np.roll(hull[:, 0], -1)) > 0.0


def test_degenerate_regions_are_read(tmp_path: Path):
    regions = [region(hull=[]), region(hull=[[0, 0], [1, 0]]), region(convex_polygons=[])]
    assert len(read_region_map(written(tmp_path, content(regions=regions))).regions.regions) == 3


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ("{", "not a JSON file"),
        ([], 'needs an object with a list "regions"'),
        (content(start_position=[0, 0]), "start_position: got [0, 0], needs 3 numbers"),
        (content(goal_position=None), "goal_position: got nothing, needs numbers"),
        (content(goal_yaw="north"), "goal_yaw: got 'north', needs numbers"),
        (content(start_position=[0, 0, float("nan")]), "needs finite numbers"),
        (content(regions=[region(), 3]), "regions[1]: got 3, needs an object"),
        (content(regions=[region(hull=[0, 1, 2])]), "regions[0].hull: got an array of shape (3,), needs (N, 2)"),
        (content(regions=[region(quaternion_xyzw=[0, 0, 0, 2])]), "quaternion_xyzw: got [0.0, 0.0, 0.0, 2.0], needs"),
        (content(regions=[region(origin="here")]), "regions[0].origin: got 'here', needs numbers"),
        (content(regions=[region(convex_polygons=1)]), "regions[0].convex_polygons: got 1, needs a list"),
    ],
)
def test_what_is_no_map_is_refused_with_its_place(tmp_path: Path, data: Any, message: str):
    path = written(tmp_path, data)
    with pytest.raises(RegionMapError) as caught:
        read_region_map(path)
    assert message in str(caught.value) and str(path) in str(caught.value)


def test_a_folder_or_its_subfolder_holds_the_maps(tmp_path: Path):
    inner = tmp_path / "planar_regions"
    inner.mkdir()
    files = [written(inner, content())]
    assert map_files(tmp_path) == map_files(inner) == files


def test_a_folder_without_maps_is_refused(tmp_path: Path):
    for folder, message in ((tmp_path, "holds no *.json"), (tmp_path / "none", "is not a folder")):
        with pytest.raises(RegionMapError, match=message.replace("*", r"\*")):
            map_files(folder)
    with pytest.raises(RegionMapError, match="No such file"):
        read_region_map(tmp_path / "none.json")
