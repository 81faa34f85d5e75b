"""Planar-region maps: ground with a start and a goal, on which footstep planners are compared.

A map is a JSON file with a start and a goal for the middle of the feet, and regions with a frame, a concave hull and
its convex parts; or a folder with the same in text files, see `region_folder`.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from math import atan2
from pathlib import Path
from typing import Any

import numpy as np

from skills.footsteps.region_folder import INPUTS, RegionMapError, read_region_folder
from skills.geometry.polygon import signed_area
from skills.geometry.pose import Array, Pose, readonly
from skills.regions.planar_region import PlanarRegion, PlanarRegions

_SUBFOLDER = "planar_regions"


@dataclass(frozen=True, slots=True, eq=False)
class RegionMap:
    """Ground with a start and a goal.

    Attributes:
        name: of the file, without its ending.
        regions: the ground.
        start_world, goal_world: (4,) middle of the feet x, y, z [m] and heading [rad]; z is near the ground.
        note: what its makers noted of it; empty where nothing.
    """

    name: str
    regions: PlanarRegions
    start_world: Array
    goal_world: Array
    note: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "start_world", readonly(self.start_world, (4,)))
        object.__setattr__(self, "goal_world", readonly(self.goal_world, (4,)))


def map_files(folder: Path) -> list[Path]:
    """The maps in a folder, or in its subfolder `planar_regions`, files and folders in the order of their names.

    Raises:
        RegionMapError: where there are none.
    """
    for place in (folder / _SUBFOLDER, folder):
        maps = sorted((*place.glob("*.json"), *(inputs.parent for inputs in place.glob(f"*/{INPUTS}"))))
        if maps:
            return maps
    kind = (
        f"holds no *.json and no */{INPUTS}, neither does its planar_regions" if folder.is_dir() else "is not a folder"
    )
    raise RegionMapError(f"{folder}: {kind}; allowed: a folder of planar-region maps")


def read_region_map(path: Path) -> RegionMap:
    """Read a map, a file or a folder; headings that it leaves out point from start to goal.

    Raises:
        RegionMapError: where it is missing or is no such map.
    """
    data = read_region_folder(path) if path.is_dir() else _json(path)
    start, goal = (_numbers(path, key, data.get(key), (3,)) for key in ("start_position", "goal_position"))
    facing = atan2(goal[1] - start[1], goal[0] - start[0])
    yaws = [float(_numbers(path, key, data.get(key, facing), ())) for key in ("start_yaw", "goal_yaw")]
    regions = tuple(_region(path, f"regions[{i}]", region) for i, region in enumerate(data["regions"]))
    return RegionMap(
        name=path.stem,
        regions=PlanarRegions(regions, 0.0, 0),
        start_world=np.array((*start, yaws[0])),
        goal_world=np.array((*goal, yaws[1])),
        note=str(data.get("status_2019", "")),
    )


def _json(path: Path) -> dict[str, Any]:
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise RegionMapError(f"{path}: {error.strerror or error}") from error
    except ValueError as error:
        raise RegionMapError(f"{path}: not a JSON file: {error}") from error
    if not isinstance(data, dict) or not isinstance(data.get("regions"), list):
        raise RegionMapError(f'{path}: needs an object with a list "regions"')
    return data


def _region(path: Path, place: str, data: Any) -> PlanarRegion:
    if not isinstance(data, Mapping):
        raise RegionMapError(f"{path}: {place}: got {data!r}, needs an object")
    quaternion = _numbers(path, f"{place}.quaternion_xyzw", data.get("quaternion_xyzw"), (4,))
    if not abs(np.linalg.norm(quaternion) - 1.0) < 1e-3:
        raise RegionMapError(f"{path}: {place}.quaternion_xyzw: got {quaternion.tolist()}, needs unit length")
    origin = _numbers(path, f"{place}.origin", data.get("origin"), (3,))
    hull = _polygon(path, f"{place}.hull", data.get("hull"))
    parts = data.get("convex_polygons", [])
    if not isinstance(parts, list):
        raise RegionMapError(f"{path}: {place}.convex_polygons: got {parts!r}, needs a list of polygons")
    convex = tuple(_polygon(path, f"{place}.convex_polygons[{i}]", part) for i, part in enumerate(parts))
    area = sum(float(signed_area(part)) for part in convex)
    return PlanarRegion(Pose.from_quaternion_xyzw(quaternion, origin), hull, convex, area, 0.0)


def _polygon(path: Path, place: str, data: Any) -> Array:
    """Vertices, (N, 2) counter-clockwise; degenerate ones are allowed."""
    vertices = _numbers(path, place, [] if data is None else data, None)
    if vertices.size == 0:
        return np.zeros((0, 2))
    if vertices.ndim != 2 or vertices.shape[1] != 2:
        raise RegionMapError(f"{path}: {place}: got an array of shape {vertices.shape}, needs (N, 2)")
    return vertices if signed_area(vertices) >= 0.0 else vertices[::-1].copy()


def _numbers(path: Path, place: str, data: Any, shape: tuple[int, ...] | None) -> Array:
    if data is None:
        raise RegionMapError(f"{path}: {place}: got nothing, needs numbers")
    try:
        values = np.array(data, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise RegionMapError(f"{path}: {place}: got {_short(data)}, needs numbers") from error
    if not np.all(np.isfinite(values)):
        raise RegionMapError(f"{path}: {place}: got {_short(data)}, needs finite numbers")
    if shape is not None and values.shape != shape:
        raise RegionMapError(f"{path}: {place}: got {_short(data)}, needs {shape[0] if shape else 1} numbers")
    return values


def _short(data: Any) -> str:
    text = repr(data)
    return text if len(text) <= 60 else f"{text[:57]}..."
