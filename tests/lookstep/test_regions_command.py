"""`lookstep regions`: any depth image in; a table, a picture, a recording and figures out, or an error that helps."""

import json

import cv2
import numpy as np
import pytest
from rerun.chunk import RrdReader

from lookstep.__main__ import main

WIDTH, HEIGHT, FOCAL = 160, 120, 80.0
CAMERA = f"{FOCAL},{FOCAL},79.5,59.5"


def room() -> np.ndarray:
    """A level camera 1 m above a floor, 2 m from a wall; depth in metres."""
    v, _ = np.indices((HEIGHT, WIDTH))
    down = (v - 59.5) / FOCAL
    with np.errstate(divide="ignore"):
        floor = np.where(down > 0.0, 1.0 / down, np.inf)
    return np.minimum(floor, 2.0)


@pytest.fixture
def image(tmp_path):
    path = tmp_path / "room.png"
    cv2.imwrite(str(path), np.round(5000.0 * room()).astype(np.uint16))
    return path


def figures(arguments, tmp_path):
    file = tmp_path / "figures.json"
    assert main(["regions", *map(str, arguments), "--json", str(file)]) == 0
    return json.loads(file.read_text())


def test_a_wall_and_a_floor_are_told_with_their_figures(image, tmp_path, capsys):
    told = figures([image, "--camera", CAMERA, "--scale", "5000", "--height", "1"], tmp_path)
    wall, floor = sorted(told["regions"], key=lambda region: -region["slope_deg"])
    assert wall["slope_deg"] == pytest.approx(90.0, abs=0.1)
    assert floor["slope_deg"] == pytest.approx(0.0, abs=0.1)
    assert wall["area_m2"] == pytest.approx(2.0 * WIDTH / FOCAL * (1.0 + 2.0 * 59.5 / FOCAL), rel=0.1)
    assert max(wall["residual_mm"], floor["residual_mm"]) < 0.5
    assert sum(told["pixel_shares"].values()) == pytest.approx(1.0, abs=1e-3)
    assert wall["pixels"] + floor["pixels"] == pytest.approx(told["pixel_shares"]["region"] * WIDTH * HEIGHT, rel=0.01)
    printed = capsys.readouterr().out
    assert "0.00  0.00  1.00" in printed and "median of" in printed


def test_ground_leaves_out_what_is_too_steep(image, tmp_path):
    told = figures([image, "--camera", CAMERA, "--scale", "5000", "--ground"], tmp_path)
    assert [region["slope_deg"] < 1.0 for region in told["regions"]] == [True]
    assert told["rejected"]["steep"] >= 1


def test_whole_numbers_are_millimetres_and_floats_metres_where_nobody_says_it(tmp_path, capsys):
    whole, floats, array = tmp_path / "mm.png", tmp_path / "m.tiff", tmp_path / "m.npy"
    cv2.imwrite(str(whole), np.round(1000.0 * room()).astype(np.uint16))
    cv2.imwrite(str(floats), room().astype(np.float32))
    np.save(array, room())
    areas = [
        sorted(region["area_m2"] for region in figures([file, "--camera", CAMERA], tmp_path)["regions"])
        for file in (whole, floats, array)
    ]
    np.testing.assert_allclose(areas[1:], [areas[0], areas[0]], rtol=0.02)
    printed = capsys.readouterr().out
    assert "1000 values a metre, taken for granted" in printed and "1 values a metre, taken for granted" in printed


def test_all_files_go_into_one_folder(image, tmp_path):
    out = tmp_path / "found"
    assert main(["regions", str(image), "--camera", CAMERA, "--scale", "5000", "--out", str(out)]) == 0
    assert sorted(file.name for file in out.iterdir()) == ["regions.json", "regions.png", "regions.rrd"]
    picture = np.asarray(cv2.imread(str(out / "regions.png")))
    assert picture.shape[1] == WIDTH and picture.shape[0] > HEIGHT
    entities = {chunk.entity_path for chunk in RrdReader(out / "regions.rrd").stream().to_chunks()}
    assert entities >= {"/world/points", "/world/regions/outlines", "/world/regions/surfaces", "/depth", "/picture"}


@pytest.mark.parametrize("values", [np.zeros((HEIGHT, WIDTH)), np.full((HEIGHT, WIDTH), np.nan), np.ones((1, 1))])
def test_an_image_without_planes_is_told_as_such(values, tmp_path, capsys):
    file = tmp_path / "empty.npy"
    np.save(file, values)
    assert main(["regions", str(file), "--camera", "100,100,0.5,0.5", "--out", str(tmp_path / "out")]) == 0
    assert "rejected" in capsys.readouterr().out


def bad_files(folder):
    cv2.imwrite(str(folder / "grey.png"), np.zeros((HEIGHT, WIDTH), np.uint8))
    cv2.imwrite(str(folder / "colour.png"), np.zeros((HEIGHT, WIDTH, 3), np.uint8))
    (folder / "text.png").write_text("no image")
    (folder / "text.npy").write_text("no array")
    np.save(folder / "cube.npy", np.zeros((2, 2, 2)))
    np.save(folder / "words.npy", np.array([["a"]]))
    np.save(folder / "good.npy", room())


@pytest.mark.parametrize(
    ("file", "arguments", "message"),
    [
        ("missing.png", [], "missing.png: no such file"),
        (".", [], "is a folder, needs one image"),
        ("text.png", [], "text.png: is not an image that can be read"),
        ("text.npy", [], "text.npy: is no array file"),
        ("grey.png", [], "holds uint8 of shape 120 x 160, which is a picture; needs one depth a pixel"),
        ("colour.png", [], "holds uint8 of shape 120 x 160 x 3, which is a picture"),
        ("cube.npy", [], "holds float64 of shape 2 x 2 x 2"),
        ("words.npy", [], "needs rows and columns of one depth each"),
        ("good.npy", ["--camera", "1,2,3"], '--camera: got "1,2,3", needs fx,fy,cx,cy in pixels'),
        ("good.npy", ["--camera", "140,0,79,59"], "--camera: got fy = 0, needs a positive number of pixels"),
        ("good.npy", ["--camera", "140,140,320,59"], "cx = 320, outside the image of 160 x 120 pixels"),
        ("good.npy", ["--scale", "0"], "--scale: got 0, needs a positive number"),
        ("good.npy", ["--scale", "nan"], "--scale: got nan"),
        ("good.npy", ["--slope-max", "200"], "--slope-max: got 200, allowed: 0 .. 180 deg"),
        ("good.npy", ["--set", "regions.area_mi=1"], 'unknown key "area_mi"; did you mean "area_min"?'),
        ("good.npy", ["--set", "footsteps.reach=1"], "only regions.KEY=VALUE has a meaning here"),
        ("good.npy", ["--picture", "a.gif"], "needs a name that ends in .png or .jpg"),
        ("good.npy", ["--record", "nowhere/a.rrd"], "the folder nowhere does not exist"),
    ],
)
def test_bad_input_is_named_with_what_is_allowed(file, arguments, message, tmp_path, monkeypatch, capsys):
    bad_files(tmp_path)
    monkeypatch.chdir(tmp_path)
    assert main(["regions", file, "--camera", CAMERA, *arguments]) == 2
    assert message in capsys.readouterr().err
    assert not (tmp_path / "runs").exists()
