"""`lookstep regions`: the planar regions of one depth image, from any depth camera."""

from __future__ import annotations

import argparse
import dataclasses
import math
import time as wall
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from lookstep.arguments import add_assignments
from lookstep.errors import UserError

if TYPE_CHECKING:
    from lookstep.extraction_figures import ExtractionFigures
    from skills.geometry import DepthImage
    from skills.regions import RegionExtraction, RegionParameters

NAME = "regions"
HELP = "find the planar regions of a depth image; print a table, write a picture and a recording"
EXAMPLE = "lookstep regions desk.png --camera 535.4,539.2,320.1,247.6 --scale 5000"

_FOLDER = Path("runs/regions")
_NAMES = {"picture": "regions.png", "record": "regions.rrd", "json": "regions.json"}
_PICTURES = (".png", ".jpg")
_RUNS = 9
_SUBJECT = "regions."
# Without a robot every plane counts, whatever its slope and its distance.
_ALL_PLANES = {"slope_max": np.pi, "depth_max": 20.0, "distance_min": 0.0}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the image, its camera and where to write."""
    parser.add_argument("image", type=Path, help="depth image: PNG or TIFF of 16 bits, TIFF or EXR of floats, .npy")
    parser.add_argument("--camera", required=True, metavar="FX,FY,CX,CY", help="pinhole camera of the image [px]")
    parser.add_argument("--scale", type=float, metavar="S", help="values a metre: 1000 for millimetres, 5000 for TUM "
                        "RGB-D (whole numbers are taken as millimetres, floats as metres)")  # fmt: skip
    parser.add_argument("--height", type=float, default=0.0, metavar="M", help="of the camera [m] (%(default)s)")
    parser.add_argument("--pitch", type=float, default=0.0, metavar="DEG", help="of its view below the horizon [deg] "
                        "(%(default)s: level)")  # fmt: skip
    parser.add_argument("--ground", action="store_true", help="only what the robot would walk on: the limits of slope "
                        "and distance that it walks with")  # fmt: skip
    parser.add_argument("--slope-max", type=float, metavar="DEG", help="reject steeper regions; 90 leaves out what "
                        "hangs over (180: all count)")  # fmt: skip
    add_assignments(parser, "one parameter, such as regions.area_min=0.05")
    parser.add_argument("--out", type=Path, metavar="DIR", help="folder for regions.png, regions.rrd and regions.json "
                        f"({_FOLDER}, where no file is named)")  # fmt: skip
    parser.add_argument("--picture", type=Path, metavar="FILE", help="write the picture here: .png or .jpg")
    parser.add_argument("--record", type=Path, metavar="RRD", help="write the recording for the rerun viewer here")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the figures here")


def execute(options: argparse.Namespace) -> int:
    """Extract, print, write; 0 however little was found."""
    from lookstep.depth_file import parse_camera, read_values
    from lookstep.extraction_figures import extraction_figures
    from skills.geometry import DepthImage, looking
    from skills.geometry.camera import values_per_metre

    _check(options)
    parameters = _parameters(options)
    values = read_values(options.image)
    camera = parse_camera(options.camera, width=values.shape[1], height=values.shape[0])
    scale = options.scale or values_per_metre(values)
    T_world_camera = looking((0.0, 0.0, options.height), pitch=np.deg2rad(options.pitch))
    image = DepthImage.from_array(values, camera, scale=scale, T_world_camera=T_world_camera)
    extraction, milliseconds = _timed(image, parameters)
    figures = dataclasses.replace(extraction_figures(extraction), extract_ms=milliseconds, runs=_RUNS)
    files = _files(options)
    _write(files, extraction, figures)
    _print(figures, _about(options, image, scale), files)
    return 0


def _check(options: argparse.Namespace) -> None:
    if options.scale is not None and not (math.isfinite(options.scale) and options.scale > 0.0):
        raise UserError(f"--scale: got {options.scale:g}, needs a positive number of values a metre")
    if options.slope_max is not None and not 0.0 <= options.slope_max <= 180.0:
        raise UserError(f"--slope-max: got {options.slope_max:g}, allowed: 0 .. 180 deg")
    if not -90.0 <= options.pitch <= 90.0:
        raise UserError(f"--pitch: got {options.pitch:g}, allowed: -90 .. 90 deg")
    if not math.isfinite(options.height):
        raise UserError(f"--height: got {options.height:g}, needs a number of metres")
    if options.picture is not None and options.picture.suffix not in _PICTURES:
        raise UserError(f"--picture {options.picture}: needs a name that ends in {' or '.join(_PICTURES)}")
    for name in ("picture", "record", "json"):
        file = getattr(options, name)
        if file is not None and not file.parent.is_dir():
            raise UserError(f"--{name} {file}: the folder {file.parent} does not exist")
    if options.out is not None and options.out.exists() and not options.out.is_dir():
        raise UserError(f"--out {options.out}: is a file, needs a folder")


def _parameters(options: argparse.Namespace) -> RegionParameters:
    from lookstep.configuration import load_configuration

    for text in options.assignments:
        if not text.startswith(_SUBJECT):
            raise UserError(f"--set {text}: only regions.KEY=VALUE has a meaning here")
    limits = {} if options.ground else dict(_ALL_PLANES)
    if options.slope_max is not None:
        limits["slope_max"] = np.deg2rad(options.slope_max)
    assignments = [f"{_SUBJECT}{key}={value!r}" for key, value in limits.items()]
    return load_configuration(None, [*assignments, *options.assignments]).regions


def _files(options: argparse.Namespace) -> dict[str, Path]:
    """Where to write what; the default folder is for those who name no file."""
    named = {name: getattr(options, name) for name in _NAMES if getattr(options, name) is not None}
    if named and options.out is None:
        return named
    folder = options.out or _FOLDER
    folder.mkdir(parents=True, exist_ok=True)
    return {name: named.get(name, folder / file) for name, file in _NAMES.items()}


def _timed(image: DepthImage, parameters: RegionParameters) -> tuple[RegionExtraction, float]:
    """An extraction and the median time of several [ms]; the first one loads or compiles the kernels."""
    from skills.regions import examine_regions

    extraction = examine_regions(image, parameters)
    times = []
    for _ in range(_RUNS):
        started = wall.perf_counter()
        examine_regions(image, parameters)
        times.append(wall.perf_counter() - started)
    return extraction, round(1e3 * float(np.median(times)), 2)


def _about(options: argparse.Namespace, image: DepthImage, scale: float) -> str:
    """What was looked at, and what was taken for granted."""
    depth = image.depth[image.depth > 0.0]
    unit = f"{scale:g} values a metre" + ("" if options.scale else ", taken for granted: --scale tells otherwise")
    size = f"{options.image}: {image.camera.width} x {image.camera.height} pixels, {unit}"
    if not len(depth):
        return f"{size}\nno pixel has a depth"
    low, middle, high = np.percentile(depth, (1.0, 50.0, 99.0))
    return f"{size}\ndepth {low:.2f} .. {high:.2f} m, median {middle:.2f} m"


def _print(figures: ExtractionFigures, about: str, files: dict[str, Path]) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table(box=None, padding=(0, 1), pad_edge=False)
    for name in ("region", "area m²", "pixels", "normal", "slope °", "far m", "off mm", "holes", "parts"):
        table.add_column(name, justify="right", no_wrap=True)
    for region in sorted(figures.regions, key=lambda region: -region.area_m2):
        normal = " ".join(f"{component:5.2f}" for component in region.normal_world)
        table.add_row(
            str(region.number), f"{region.area_m2:.3f}", str(region.pixels), normal, f"{region.slope_deg:.1f}",
            f"{region.distance_m:.2f}", f"{region.residual_mm:.1f}", str(region.holes), str(region.convex_parts),
        )  # fmt: skip
    console = Console(highlight=False, soft_wrap=True)
    console.print(about, markup=False)
    console.print(table)
    rejected = ", ".join(f"{cause} {count}" for cause, count in figures.rejected.items()) or "none"
    shares = ", ".join(
        f"{name.replace('_', ' ')} {100.0 * share:.0f} %" for name, share in figures.pixel_shares.items() if share
    )
    console.print(f"rejected   {rejected}")
    console.print(f"pixels     {shares}")
    console.print(f"extraction {figures.extract_ms:.1f} ms, median of {figures.runs}")
    for name, file in files.items():
        opened = f"   (open it: ./run rerun {file})" if name == "record" else ""
        console.print(f"{name:<10} {file}{opened}", markup=False)


def _write(files: dict[str, Path], extraction: RegionExtraction, figures: ExtractionFigures) -> None:
    import cv2

    from lookstep.recording.extraction_file import write_extraction
    from skills.regions import debug_image

    picture = debug_image(extraction)
    if "picture" in files:
        cv2.imwrite(str(files["picture"]), cv2.cvtColor(picture, cv2.COLOR_RGB2BGR))
    if "record" in files:
        write_extraction(files["record"], extraction, picture)
    if "json" in files:
        figures.write(files["json"])
