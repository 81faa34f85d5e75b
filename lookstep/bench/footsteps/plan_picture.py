"""A picture of a plan from above: the ground by height, walls in red, left soles green, right soles orange."""

from __future__ import annotations

from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from skills.footsteps import FootstepPlan, Side, Stance
from skills.footsteps.region_map import RegionMap
from skills.geometry.pose import Array, Pose
from skills.regions import PlanarRegion

_LONGER_EDGE = 1600
_MARGIN = 1.0
_WALL = 0.35
_INK, _PAPER, _RED = (20, 20, 20), (45, 45, 45), (60, 60, 230)
_FEET = {Side.LEFT: (90, 210, 60), Side.RIGHT: (40, 140, 255)}
_FRACTION_BITS = 4


def write_plan_picture(
    file: Path, region_map: RegionMap, stance: Stance, plan: FootstepPlan, sole_outline: Array
) -> None:
    """Draw a map with the start stance, the steps of a plan and the goal, and write it to an image file.

    Args:
        file: the image, .png or .jpg.
        region_map: the ground.
        stance: the stance before the first step.
        plan: the steps.
        sole_outline: (N, 2) polygon in the sole frame [m].
    """
    view = _View.around(region_map, plan)
    image = np.full((view.height, view.width, 3), _PAPER, dtype=np.uint8)
    _draw_ground(image, view, region_map)
    for side in Side:
        cv2.polylines(image, [view.pixels(_world(stance.sole(side), sole_outline))], True, _FEET[side], 2, *_SMOOTH)
    for number, step in enumerate(plan.steps, 1):
        outline = view.pixels(_world(step.T_world_sole, sole_outline))
        cv2.fillPoly(image, [outline], _FEET[step.side], *_SMOOTH)
        cv2.polylines(image, [outline], True, _INK, 1, *_SMOOTH)
        foothold = view.pixels(_world(step.T_world_sole, step.foothold_sole))
        cv2.polylines(image, [foothold], True, (255, 255, 255), 1, *_SMOOTH)
        x, y = view.pixels(step.T_world_sole.p[None])[0] >> _FRACTION_BITS
        cv2.putText(image, str(number), (int(x) - 6, int(y) + 4), cv2.FONT_HERSHEY_SIMPLEX, 0.35, _INK, 1, cv2.LINE_AA)
    x, y = view.pixels(region_map.goal_world[None, :3])[0] >> _FRACTION_BITS
    cv2.drawMarker(image, (int(x), int(y)), (255, 255, 255), cv2.MARKER_TILTED_CROSS, 14, 2, cv2.LINE_AA)
    title = f"{region_map.name}  {plan.outcome.value}, {len(plan.steps)} steps"
    cv2.putText(image, title, (8, 18), cv2.FONT_HERSHEY_SIMPLEX, 0.5, (255, 255, 255), 1, cv2.LINE_AA)
    cv2.imwrite(str(file), image)


_SMOOTH = (cv2.LINE_AA, _FRACTION_BITS)


class _View:
    """Maps the world's x to the right and y up into pixels."""

    def __init__(self, low: Array, high: Array) -> None:
        self._low, self._high = low, high
        self._scale = _LONGER_EDGE / float(np.max(high - low))
        self.width, self.height = (max(1, int(n)) for n in (high - low) * self._scale)

    @classmethod
    def around(cls, region_map: RegionMap, plan: FootstepPlan) -> _View:
        """The view that holds start, goal and steps, with a margin."""
        ends = [region_map.start_world[:2], region_map.goal_world[:2]]
        points = np.array([*ends, *(step.T_world_sole.p[:2] for step in plan.steps)])
        return cls(points.min(axis=0) - _MARGIN, points.max(axis=0) + _MARGIN)

    def pixels(self, points_world: Array) -> NDArray[np.int32]:
        """Pixels of points, (N, 2), with binary fractions."""
        x = (points_world[:, 0] - self._low[0]) * self._scale
        y = (self._high[1] - points_world[:, 1]) * self._scale
        return (np.column_stack((x, y)) * (1 << _FRACTION_BITS)).astype(np.int32)


def _world(T_world_frame: Pose, polygon: Array) -> Array:
    return T_world_frame @ np.column_stack((polygon, np.zeros(len(polygon))))


def _draw_ground(image: NDArray[np.uint8], view: _View, region_map: RegionMap) -> None:
    """Ground from the lowest up, then walls."""
    regions = [region for region in region_map.regions.regions if len(region.hull_region) >= 2]
    ground = [region for region in regions if region.normal_world[2] > _WALL]
    heights = np.array([_height(region) for region in ground])
    shades = (255 * (heights - heights.min(initial=0.0)) / max(np.ptp(heights), 0.1)).astype(np.uint8)
    colors = cv2.applyColorMap(shades.reshape(-1, 1), cv2.COLORMAP_CIVIDIS).reshape(-1, 3).tolist()
    for i in np.argsort(heights, kind="stable"):
        outline = view.pixels(ground[i].hull_world)
        cv2.fillPoly(image, [outline], colors[i], *_SMOOTH)
        cv2.polylines(image, [outline], True, _INK, 1, *_SMOOTH)
    for region in regions:
        if abs(region.normal_world[2]) <= _WALL:
            cv2.polylines(image, [view.pixels(region.hull_world)], True, _RED, 1, *_SMOOTH)


def _height(region: PlanarRegion) -> float:
    return float(region.hull_world[:, 2].max())
