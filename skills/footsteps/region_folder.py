"""Maps of planar regions as folders of text files, the form in which the reference system's data sets are published.

    NAME/PlannerInputs.txt               one "key numbers..." a line: start_position, goal_position, start_yaw, goal_yaw
    NAME/PlanarRegions/header.txt        one region a line: id, index, origin, normal, sizes of hull and convex polygons
    NAME/PlanarRegions/region<id>_<index>    one vertex "x, y" a line: the hull's, then each polygon's, in its frame

A region's frame is turned by the shortest rotation that takes +z to the normal. Older data sets write startPosition for
start_position; keys that tell of the reference system's own planners are passed over.
"""

from __future__ import annotations

import re
from itertools import pairwise
from math import hypot
from pathlib import Path
from typing import Any

INPUTS, REGIONS, HEADER = "PlannerInputs.txt", "PlanarRegions", "header.txt"
_KEYS = ("start_position", "goal_position", "start_yaw", "goal_yaw")
_NUMBER = r"[-+0-9.eE]+"
_LINE = re.compile(
    rf"regionId: (-?\d+), index: (\d+), origin: ({_NUMBER}), ({_NUMBER}), ({_NUMBER}), "
    rf"normal: ({_NUMBER}), ({_NUMBER}), ({_NUMBER}), "
    r"concave hull size: (\d+), number of convex polygons: (\d+), \[([\d, ]*)\]"
)
_LINE_NEEDS = (
    "needs regionId: N, index: N, origin: X, Y, Z, normal: X, Y, Z, concave hull size: N, "
    "number of convex polygons: N, [N, ...]"
)


class RegionMapError(ValueError):
    """A map that cannot be read; the message says which file, where in it, the value got and what is allowed."""


def read_region_folder(folder: Path) -> dict[str, Any]:
    """Read a data set.

    Returns:
        What a JSON map holds: start_position, goal_position, start_yaw and goal_yaw where given, and regions.

    Raises:
        RegionMapError: where a file is missing or is not what it must be.
    """
    header = folder / REGIONS / HEADER
    regions = [_region(header, number, line) for number, line in enumerate(_lines(header), start=1) if line.strip()]
    return {**_inputs(folder / INPUTS), "regions": regions}


def _inputs(file: Path) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for number, line in enumerate(_lines(file), start=1):
        words = line.split()
        key = re.sub(r"([A-Z])", lambda match: f"_{match[1].lower()}", words[0]) if words else ""
        if key in _KEYS:
            values = [_number(file, number, word) for word in words[1:]]
            found[key] = values if key.endswith("_position") else values[0] if len(values) == 1 else values
    return found


def _region(header: Path, number: int, line: str) -> dict[str, Any]:
    match = _LINE.fullmatch(line.strip())
    if match is None:
        raise RegionMapError(f"{header}:{number}: got {line.strip()[:60]!r}, {_LINE_NEEDS}")
    numbers = [_number(header, number, word) for word in match.groups()[2:8]]
    sizes = [int(match[9]), *(int(size) for size in match[11].split(",") if size.strip())]
    if len(sizes) != int(match[10]) + 1:
        raise RegionMapError(f"{header}:{number}: got {match[10]} convex polygons, but {len(sizes) - 1} sizes of them")
    vertices = _vertices(header.parent / f"region{match[1]}_{match[2]}", sum(sizes))
    starts = [sum(sizes[:i]) for i in range(len(sizes) + 1)]
    hull, *polygons = (vertices[begin:end] for begin, end in pairwise(starts))
    return {
        "origin": numbers[:3],
        "quaternion_xyzw": _shortest_rotation(*numbers[3:]),
        "hull": hull,
        "convex_polygons": polygons,
    }


def _vertices(file: Path, count: int) -> list[list[float]]:
    lines = [(number, line) for number, line in enumerate(_lines(file), start=1) if line.strip()]
    if len(lines) != count:
        raise RegionMapError(f"{file}: got {len(lines)} vertices, needs {count} by the sizes in {HEADER}")
    vertices = []
    for number, line in lines:
        words = line.split(",")
        if len(words) != 2:
            raise RegionMapError(f"{file}:{number}: got {line.strip()[:60]!r}, needs x, y")
        vertices.append([_number(file, number, word) for word in words])
    return vertices


def _shortest_rotation(x: float, y: float, z: float) -> list[float]:
    """Quaternion (x, y, z, w) of the shortest rotation that takes +z to a direction; about x where it points down."""
    length = hypot(x, y, z) or 1.0
    turn = [-y / length, x / length, 0.0, 1.0 + z / length]
    size = hypot(*turn)
    return [n / size for n in turn] if size > 1e-9 else [1.0, 0.0, 0.0, 0.0]


def _lines(file: Path) -> list[str]:
    try:
        return file.read_text(encoding="utf-8").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise RegionMapError(f"{file}: {getattr(error, 'strerror', None) or error}") from error


def _number(file: Path, line: int, word: str) -> float:
    try:
        return float(word)
    except ValueError as error:
        raise RegionMapError(f"{file}:{line}: got {word.strip()[:60]!r}, needs a number") from error
