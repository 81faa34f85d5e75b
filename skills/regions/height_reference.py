"""The ground of earlier frames as a raster of mean heights, against which new frames are registered."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skills.geometry.pose import Array
from skills.regions.region_cells import Cells, Raster, Window
from skills.regions.registration_parameters import RegistrationParameters


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
        """Heights, and the frames behind them, in another window of the same cells."""
        heights, counts = np.zeros(window.shape, np.float32), np.zeros(window.shape, np.float32)
        here, there = window.overlap(self.window)
        heights[here], counts[here] = self.heights[there], self.counts[there]
        return heights, counts


def updated(
    reference: HeightReference | None, cells: Cells, camera_world: Array, parameters: RegistrationParameters
) -> HeightReference:
    """Join a frame: ground where it was is averaged, ground elsewhere replaced; what is far from the camera goes."""
    window = Window.around(camera_world, parameters.reach, parameters.cell)
    newest, mask = window.paint(cells)
    if reference is None:
        return HeightReference(window, newest, mask)
    heights, counts = reference.cut(window)
    seen = mask > 0.0
    counts[seen & (np.abs(newest - heights) > parameters.same_height)] = 0.0
    counts[seen] = np.minimum(counts[seen] + 1.0, parameters.frames_max)
    heights[seen] += (newest[seen] - heights[seen]) / counts[seen]
    return HeightReference(window, heights, counts)
