"""Where on the ground a click lands, and two clicks as a place and a heading."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from lookstep.panel.snapshot import Snapshot
from skills.body_path import Goal
from skills.geometry import Array, Pose
from skills.height_map import HeightMap
from skills.regions import PlanarRegions

_LEAST_HEADING = 0.02  # Two clicks nearer than this say no heading [m].
_FARTHEST = 60.0


def ground_under_click(origin_world: Array, direction_world: Array, snapshot: Snapshot) -> Array | None:
    """First point of what is known of the ground along a ray, (3,) [m]; None where the ray points away from it.

    The ground is all that the robot knows, regions and height map, and the boxes of a simulated course; where the ray
    meets none of them, the level plane under the robot's feet.

    Args:
        origin_world: where the ray begins, (3,) [m].
        direction_world: where it points, (3,).
        snapshot: what is known.
    """
    origin = np.asarray(origin_world, dtype=np.float64)
    direction = np.asarray(direction_world, dtype=np.float64)
    length = float(np.linalg.norm(direction))
    if not (np.isfinite(origin).all() and np.isfinite(direction).all() and length > 0.0):
        return None
    direction = direction / length
    regions, heights = snapshot.value(PlanarRegions), snapshot.value(HeightMap)
    distances = [_along_boxes(origin, direction, snapshot)]
    if regions is not None:
        distances.append(_along_regions(origin, direction, regions))
    if heights is not None:
        distances.append(_along_heights(origin, direction, heights))
    distance = min(distances)
    if not np.isfinite(distance):
        distance = _along_plane(origin, direction, float(snapshot.state.stance.mid_feet[2]))
    return origin + distance * direction if distance <= _FARTHEST else None


def box_under_click(origin_world: Array, direction_world: Array, snapshot: Snapshot) -> str | None:
    """The box that a ray meets first; None where it meets none."""
    hits = _box_distances(np.asarray(origin_world), np.asarray(direction_world), snapshot)
    name = min(hits, key=lambda box: hits[box], default=None)
    return name if name is not None and np.isfinite(hits[name]) else None


@dataclass(frozen=True, slots=True)
class Placing:
    """A place that is being put down: the first click says where, the second which way.

    Attributes:
        position_world: of the first click, x, y, z [m]; None before it.
    """

    position_world: tuple[float, float, float] | None = None

    def clicked(self, point_world: Array) -> tuple[Placing, Goal | None]:
        """After a click on the ground: what comes next, and the place where it is complete."""
        x, y, z = (float(part) for part in point_world)
        if self.position_world is None:
            return Placing((x, y, z)), None
        dx, dy = x - self.position_world[0], y - self.position_world[1]
        if np.hypot(dx, dy) < _LEAST_HEADING:
            return self, None
        return Placing(), Goal(self.position_world[0], self.position_world[1], float(np.arctan2(dy, dx)))


def _along_plane(origin: Array, direction: Array, height: float) -> float:
    if direction[2] >= 0.0:
        return np.inf
    return max(0.0, float((height - origin[2]) / direction[2]))


def _along_regions(origin: Array, direction: Array, regions: PlanarRegions) -> float:
    nearest = np.inf
    for region in regions.regions:
        normal, point = region.T_world_region.R[:, 2], region.T_world_region.p
        slope = float(direction @ normal)
        if abs(slope) < 1e-6:
            continue
        distance = float((point - origin) @ normal) / slope
        if 0.0 < distance < nearest:
            inside = (region.T_world_region.inverse @ (origin + distance * direction))[:2]
            if any(_holds(part, inside) for part in region.convex_parts_region):
                nearest = distance
    return nearest


def _holds(convex: Array, point: Array) -> bool:
    """Whether a convex polygon, counter-clockwise, holds a point."""
    edges, ways = np.roll(convex, -1, axis=0) - convex, point - convex
    return bool(np.all(edges[:, 0] * ways[:, 1] - edges[:, 1] * ways[:, 0] >= 0.0))


def _along_heights(origin: Array, direction: Array, heights: HeightMap) -> float:
    """March along the ray by half a cell, until it is under the ground."""
    distances = np.arange(0.0, _FARTHEST, 0.5 * heights.resolution)
    points = origin + distances[:, None] * direction
    ground = heights.nearest(points[:, :2])
    under = np.flatnonzero(points[:, 2] <= ground)
    return float(distances[under[0]]) if len(under) and under[0] > 0 else np.inf


def _along_boxes(origin: Array, direction: Array, snapshot: Snapshot) -> float:
    return min(_box_distances(origin, direction, snapshot).values(), default=np.inf)


def _box_distances(origin: Array, direction: Array, snapshot: Snapshot) -> dict[str, float]:
    """How far along a ray each box begins, by the slab test; infinite where it is missed."""
    distances = {}
    for box in snapshot.stage.boxes:
        position, wxyz = snapshot.boxes[box.name]
        T_box_world = Pose.from_quaternion_wxyz(wxyz, position).inverse
        start, along = T_box_world @ origin, T_box_world.R @ direction
        half = 0.5 * np.array(box.size)
        with np.errstate(divide="ignore", invalid="ignore"):
            entry, leave = (-np.sign(along) * half - start) / along, (np.sign(along) * half - start) / along
        parallel = np.abs(along) < 1e-12
        if np.any(np.abs(start[parallel]) > half[parallel]):
            distances[box.name] = np.inf
            continue
        first = float(np.max(entry[~parallel], initial=-np.inf))
        last = float(np.min(leave[~parallel], initial=np.inf))
        distances[box.name] = first if 0.0 < first <= last else np.inf
    return distances
