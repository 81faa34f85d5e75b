"""What one extraction found, in figures: a row for each region, and what became of the rest of the image."""

from __future__ import annotations

import dataclasses
import json
from collections import Counter
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from skills.geometry import Array
from skills.regions import PixelKind, RegionExtraction, kind_of_pixels, piece_of_pixels

_TRIMMED = 0.99  # share of a region's pixels that its residual counts


@dataclass(frozen=True, slots=True)
class RegionFigures:
    """One region.

    Attributes:
        number: its index in the extraction, and its number in the picture.
        area_m2: area of the outline less its holes [m^2].
        pixels: how many are in it.
        normal_world: unit normal towards the camera's side.
        slope_deg: angle of the normal with the vertical [deg].
        distance_m: mean distance of its points from the camera [m].
        residual_mm: root mean square distance of its points from the plane, without the farthest hundredth [mm].
        holes, convex_parts: how many it has.
    """

    number: int
    area_m2: float
    pixels: int
    normal_world: tuple[float, float, float]
    slope_deg: float
    distance_m: float
    residual_mm: float
    holes: int
    convex_parts: int


@dataclass(frozen=True, slots=True)
class ExtractionFigures:
    """One image.

    Attributes:
        regions: in the order of the extraction.
        rejected: number of rejected pieces by cause, most frequent first.
        pixel_shares: share of the image by what became of its pixels; they add up to 1.
        extract_ms: median time of an extraction [ms], None where it was not measured.
        runs: over how many extractions.
    """

    regions: tuple[RegionFigures, ...]
    rejected: dict[str, int]
    pixel_shares: dict[str, float]
    extract_ms: float | None = None
    runs: int = 0

    def write(self, path: Path) -> None:
        """Write as JSON."""
        path.write_text(json.dumps(dataclasses.asdict(self), indent=2) + "\n")


def extraction_figures(extraction: RegionExtraction) -> ExtractionFigures:
    """Measure what an extraction found against its own image."""
    pieces = piece_of_pixels(extraction)
    kinds = kind_of_pixels(extraction, pieces)
    shares = np.bincount(kinds.ravel(), minlength=len(PixelKind)) / max(kinds.size, 1)
    causes = Counter(piece.cause for piece in extraction.rejected).most_common()
    return ExtractionFigures(
        regions=_region_figures(extraction, pieces),
        rejected=dict(causes),
        pixel_shares={kind.name.lower(): round(float(shares[kind]), 4) for kind in PixelKind},
    )


def points_camera(extraction: RegionExtraction) -> Array:
    """The measured point of each pixel in the camera frame, (height, width, 3) [m]; zeros where there is no depth."""
    camera = extraction.image.camera
    depth = np.where(extraction.image.depth > 0.0, extraction.image.depth, 0.0).astype(np.float64)
    v, u = np.ogrid[: camera.height, : camera.width]
    return np.stack(((u - camera.cx) / camera.fx * depth, (v - camera.cy) / camera.fy * depth, depth), axis=-1)


def _trimmed_mean(values: Array, group: NDArray[np.intp], count: NDArray[np.intp]) -> Array:
    """Mean of each group's values without its largest hundredth: pixels across a depth edge would outweigh the rest."""
    order = np.lexsort((values, group))
    rank = np.arange(len(values)) - np.repeat(np.cumsum(count) - count, count)
    kept = order[rank < np.ceil(_TRIMMED * count)[group[order]]]
    total = np.bincount(group[kept], values[kept], len(count))
    return total / np.maximum(np.bincount(group[kept], minlength=len(count)), 1)


def _region_figures(extraction: RegionExtraction, pieces: NDArray[np.int16]) -> tuple[RegionFigures, ...]:
    regions = extraction.regions.regions
    inside = (pieces >= 0) & (extraction.image.depth > 0.0)
    region, points = pieces[inside].astype(np.intp), points_camera(extraction)[inside]
    count = np.bincount(region, minlength=len(regions))
    planes = [extraction.image.T_world_camera.inverse @ found.T_world_region for found in regions]
    normals = np.array([plane.R[:, 2] for plane in planes]).reshape(-1, 3)
    offsets = np.einsum("ri,ri->r", normals, np.array([plane.p for plane in planes]).reshape(-1, 3))
    off = np.einsum("ni,ni->n", points, normals[region]) - offsets[region]
    shared = np.maximum(count, 1)
    residual = np.sqrt(_trimmed_mean(off**2, region, count))
    distance = np.bincount(region, np.linalg.norm(points, axis=1), len(regions)) / shared
    return tuple(
        RegionFigures(
            number=k,
            area_m2=round(found.area, 5),
            pixels=int(count[k]),
            normal_world=tuple(round(float(n), 6) for n in found.normal_world),  # pyright: ignore[reportArgumentType]
            slope_deg=round(float(np.rad2deg(np.arccos(np.clip(found.normal_world[2], -1.0, 1.0)))), 2),
            distance_m=round(float(distance[k]), 4),
            residual_mm=round(float(1e3 * residual[k]), 3),
            holes=len(found.holes_region),
            convex_parts=len(found.convex_parts_region),
        )
        for k, found in enumerate(regions)
    )
