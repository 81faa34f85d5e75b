"""How true the ground is on which a robot would step: regions against the true surface, on a horizontal grid.

Where regions of a frame overlap, the higher one counts, as it does for the planner. A cell counts as seen where some
pixel shows ground there, and as wrong where a region covers it at the wrong height or with the wrong slope, seen or
not: a region that reaches past the edge of its block is as wrong as one that lies too high.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lookstep.bench.perception.fill import fill
from lookstep.bench.perception.truth import Truth
from sim_envs.courses import Ground
from skills.geometry.pose import Array
from skills.regions import PlanarRegion, PlanarRegions

CELL = 0.01
RANGE = 2.0
"""Edge of a cell, and how far from the camera ground is judged, in the plane: as far as regions are remembered [m]."""
WRONG_HEIGHT, WRONG_SLOPE = 0.015, np.deg2rad(5.0)
"""A cell is wrong where it is off by more than this [m, rad]."""
STEEPEST = np.deg2rad(40.0)
"""Steeper faces are no ground [rad]."""


@dataclass(frozen=True, slots=True)
class GroundCells:
    """Counts of cells of one frame, or of several.

    Attributes:
        seen: cells of ground in view.
        seen_covered: those of them that a region covers.
        covered: cells that a region covers, in view or not.
        wrong_height, wrong_slope: covered cells whose height or slope is wrong.
    """

    seen: int
    seen_covered: int
    covered: int
    wrong_height: int
    wrong_slope: int


@dataclass(frozen=True, slots=True, eq=False)
class TrueGround:
    """The ground around a camera.

    Attributes:
        ground: the true ground.
        corner: where the grid begins, (2,) [m].
        near: cells that are judged, (size, size) bool, rows along y.
        seen: those in which some pixel sees ground.
    """

    ground: Ground
    corner: Array
    near: NDArray[np.bool_]
    seen: NDArray[np.bool_]


def true_ground(truth: Truth, ground: Ground) -> TrueGround:
    """The grid of cells around the camera of a true view."""
    corner = truth.image.T_world_camera.p[:2] - RANGE
    size = round(2.0 * RANGE / CELL)
    center = (np.arange(size) + 0.5) * CELL - RANGE
    near = center[:, None] ** 2 + center**2 <= RANGE**2
    return TrueGround(ground, corner, near, near & _seen_cells(truth, corner, size))


def judge_ground(around: TrueGround, regions: PlanarRegions) -> GroundCells:
    """Compare the ground regions of one frame with the true ground around the camera."""
    height, normal = _cells_of(regions, around.corner, len(around.near))
    covered = np.isfinite(height) & around.near
    rows, columns = np.nonzero(covered)
    surface, true_normal, _ = around.ground.surface(around.corner + (np.column_stack((columns, rows)) + 0.5) * CELL)
    cosine = np.einsum("ni,ni->n", true_normal, normal[rows, columns])
    return GroundCells(
        seen=int(around.seen.sum()),
        seen_covered=int((around.seen & covered).sum()),
        covered=len(rows),
        wrong_height=int((np.abs(surface - height[rows, columns]) > WRONG_HEIGHT).sum()),
        wrong_slope=int((cosine < np.cos(WRONG_SLOPE)).sum()),
    )


def ground_figures(frames: Sequence[GroundCells]) -> dict[str, float]:
    """The numbers to publish, by name: shares of cells."""
    seen, covered = sum(f.seen for f in frames), sum(f.covered for f in frames)
    return {
        "coverage": sum(f.seen_covered for f in frames) / max(seen, 1),
        "wrong_height": sum(f.wrong_height for f in frames) / max(covered, 1),
        "wrong_slope": sum(f.wrong_slope for f in frames) / max(covered, 1),
    }


def _seen_cells(truth: Truth, corner: Array, size: int) -> NDArray[np.bool_]:
    """Cells in which some pixel sees ground."""
    is_ground = np.append(truth.planes[:, 2] >= np.cos(STEEPEST), (False, False))  # for BEYOND and VOID
    points = truth.points[is_ground[truth.face]]
    index = np.floor((points[:, :2] - corner) / CELL).astype(int)
    index = index[((index >= 0) & (index < size)).all(axis=1)]
    return np.bincount(index[:, 1] * size + index[:, 0], minlength=size * size).reshape(size, size) > 0


def _cells_of(regions: PlanarRegions, corner: Array, size: int) -> tuple[Array, Array]:
    """Height of the ground regions in each cell, (size, size), -inf where none is, and normal, (size, size, 3)."""
    height, normal = np.full((size, size), -np.inf), np.zeros((size, size, 3))
    for region in regions.regions:
        if region.normal_world[2] < np.cos(STEEPEST):
            continue
        mask, row, column = fill(_rings(region, corner), (size, size))
        rows, columns = np.nonzero(mask)
        rows, columns = rows + row, columns + column
        n = region.normal_world
        xy = corner + (np.column_stack((columns, rows)) + 0.5) * CELL - region.T_world_region.p[:2]
        z = region.T_world_region.p[2] - (xy @ n[:2]) / n[2]
        higher = z > height[rows, columns]
        height[rows[higher], columns[higher]] = z[higher]
        normal[rows[higher], columns[higher]] = n
    return height, normal


def _rings(region: PlanarRegion, corner: Array) -> list[Array]:
    """Outline and holes in cells; integers are centres."""
    rings = (region.hull_region, *region.holes_region)
    worlds = [region.T_world_region @ np.column_stack((ring, np.zeros(len(ring)))) for ring in rings]
    return [(points[:, :2] - corner) / CELL - 0.5 for points in worlds]
