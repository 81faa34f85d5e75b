"""The ground of earlier frames as a raster of mean heights, against which new frames are registered."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skills.geometry.pose import Pose, rotation_z
from skills.regions.planar_region import PlanarRegions
from skills.regions.region_raster import Raster, Window, paint_regions
from skills.regions.registration_parameters import RegistrationParameters

# Edges of a course along an axis would lie between the same two cells all along; turned, they do not.
T_RASTER_WORLD = Pose(rotation_z(-0.4), np.zeros(3))


@dataclass(frozen=True, slots=True, eq=False)
class HeightReference:
    """Mean heights of recent frames.

    Attributes:
        window: where the raster lies.
        heights: of each cell, (rows, columns) [m]; 0 where none is known.
        counts: frames behind each cell; 0 where none is known.
    """

    window: Window
    heights: Raster
    counts: Raster

    def __post_init__(self) -> None:
        for array in (self.heights, self.counts):
            array.flags.writeable = False

    def cut(self, window: Window) -> tuple[Raster, Raster]:
        """Heights, and 1 where they are known, in another window of the same cells."""
        heights, counts = self._cut(window)
        return heights, np.minimum(counts, np.float32(1.0))

    def _cut(self, window: Window) -> tuple[Raster, Raster]:
        heights, counts = np.zeros(window.shape, np.float32), np.zeros(window.shape, np.float32)
        here, there = window.overlap(self.window)
        heights[here], counts[here] = self.heights[there], self.counts[there]
        return heights, counts


def updated(
    reference: HeightReference | None, regions: PlanarRegions, T_world_camera: Pose, parameters: RegistrationParameters
) -> HeightReference:
    """Join a frame: ground where it was is averaged, ground elsewhere replaced; what is far from the camera goes."""
    camera = (T_RASTER_WORLD @ T_world_camera.p)[:2]
    window = Window.between(camera - parameters.reach, camera + parameters.reach, parameters.cell)
    newest, mask = paint_regions(regions.regions, T_RASTER_WORLD, window)
    if reference is None:
        return HeightReference(window, newest, mask)
    heights, counts = reference._cut(window)
    seen = mask > 0.0
    moved = seen & (np.abs(newest - heights) > parameters.same_height)
    counts[moved] = 0.0
    counts[seen] = np.minimum(counts[seen] + 1.0, parameters.frames_max)
    heights[seen] += (newest[seen] - heights[seen]) / counts[seen]
    return HeightReference(window, heights, counts)
