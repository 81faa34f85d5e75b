"""Planar regions out of one depth image.

After the rapid planar regions of Calvert et al. (look-and-step, 2022), with patch planes in closed form from inverse
depth: patches -> regions of patches -> labels of pixels -> outlines -> polygons and convex parts in the world.
Every step is deterministic and runs on one core.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import accumulate, pairwise

import numpy as np
from numpy.typing import NDArray

from skills.geometry.camera import DepthImage
from skills.geometry.convex_decomposition import decompose
from skills.geometry.polygon import contains_point, signed_area
from skills.geometry.pose import Array, Pose, readonly
from skills.geometry.simplification import simplify_rings
from skills.regions.growing import grow_regions
from skills.regions.noise_level import NoiseLevel
from skills.regions.outline import Indices, Outlines, trace_outlines
from skills.regions.parameters import RegionParameters
from skills.regions.patches import fit_patches, patch_size
from skills.regions.planar_region import PlanarRegion, PlanarRegions
from skills.regions.plane_outlines import PlaneOutlines, back_project
from skills.regions.refinement import refine_regions


@dataclass(frozen=True, slots=True, eq=False)
class RejectedRegion:
    """A flat piece of the image that is no ground.

    Attributes:
        label: its label.
        cause: why, in a word or two, the same for all that were rejected alike.
        reason: why, with the figure and its limit, for the operator.
        outline_image: its outline, (N, 2) [px].
    """

    label: int
    cause: str
    reason: str
    outline_image: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "outline_image", readonly(self.outline_image, (None, 2)))


@dataclass(frozen=True, slots=True, eq=False)
class RegionExtraction:
    """Everything that one extraction found out, for people who look into it.

    Attributes:
        image: what was looked at.
        regions: the result.
        labels: flat piece of each pixel, (height, width) int16; -1 for none.
        region_labels: the label behind each region.
        rejected: flat pieces that became no region.
        parameters: the tolerances and limits that were used.
        noise: how noisy the image was found to be.
    """

    image: DepthImage
    regions: PlanarRegions
    labels: NDArray[np.int16]
    region_labels: tuple[int, ...]
    rejected: tuple[RejectedRegion, ...]
    parameters: RegionParameters
    noise: NoiseLevel

    def __post_init__(self) -> None:
        self.labels.flags.writeable = False


DEFAULT_PARAMETERS = RegionParameters()
NO_NOISE = NoiseLevel()
_BEND_OF_NOISE = 1.5  # times the error that the pixels of a patch share: so far it bends what is flat


def extract_regions(image: DepthImage, parameters: RegionParameters = DEFAULT_PARAMETERS) -> PlanarRegions:
    """Planar regions of ground in the world, from one depth image.

    Args:
        image: the depth image with the camera's pose and the robot's own body.
        parameters: tolerances and limits.
    """
    return examine_regions(image, parameters).regions


def examine_regions(image: DepthImage, parameters: RegionParameters = DEFAULT_PARAMETERS) -> RegionExtraction:
    """The same as `extract_regions`, with labels and with what was rejected and why."""
    patches = fit_patches(image, parameters)
    coarse = grow_regions(patches, parameters)
    fine = refine_regions(image, patches, coarse, parameters)
    regions, region_labels, rejected = polygons_of(
        image, fine.labels, fine.planes, fine.sigma, fine.bend, parameters, fine.noise
    )
    found = PlanarRegions(regions, image.time, image.frame_id)
    return RegionExtraction(image, found, fine.labels, region_labels, rejected, parameters, fine.noise)


def polygons_of(
    image: DepthImage,
    labels: NDArray[np.int16],
    planes: Array,
    sigma: Array,
    bend: Array,
    parameters: RegionParameters,
    noise: NoiseLevel = NO_NOISE,
) -> tuple[tuple[PlanarRegion, ...], tuple[int, ...], tuple[RejectedRegion, ...]]:
    """Turn labelled pixels into polygons in the world and sort out what is no ground.

    Args:
        image: the depth image.
        labels: flat piece of each pixel, (height, width); -1 for none.
        planes: plane of each piece, (R, 3) [1/m], as in `Patches`.
        sigma: spread of each piece's points about its plane, (R,) [m].
        bend: how much each piece is bent, (R,) [m]; infinite where that is not known.
        parameters: tolerances and limits.
        noise: of the image; what it moves patches by is no bend.

    Returns:
        The regions, the label behind each of them, and the pieces that became no region.
    """
    patch_pixels = patch_size(image.camera, parameters) ** 2
    outlines = trace_outlines(labels, patch_pixels // 4)
    on_planes = back_project(outlines, image, planes)
    tolerances = np.maximum(parameters.outline_tolerance, on_planes.pixels)
    starts, owners = outlines.starts.tolist(), outlines.labels.tolist()
    areas, depths, pixels = on_planes.areas.tolist(), on_planes.depths.tolist(), outlines.pixels.tolist()
    steepness, bends = on_planes.R_world_planes[:, 2, 2].tolist(), bend.tolist()
    sigmas = sigma.tolist()
    regions: list[PlanarRegion] = []
    region_labels: list[int] = []
    rejected: list[RejectedRegion] = []
    for loop, label in enumerate(owners):
        if pixels[loop] < 0:
            continue
        objection = _objection(
            areas[loop], steepness[label], depths[loop], pixels[loop] / patch_pixels, bends[label], parameters, noise
        )
        if not objection:
            rings = [loop, *_holes_in(loop, outlines, areas, parameters.hole_area_min)]
            region = _region(
                rings, label, starts, on_planes, tolerances, parameters.convex_tolerance, image.time, sigmas[label]
            )
            if region:
                regions.append(region)
                region_labels.append(label)
                continue
            objection = ("thin", "thinner than the outline's tolerance")
        rejected.append(RejectedRegion(label, *objection, outlines.points[starts[loop] : starts[loop + 1]]))
    return tuple(regions), tuple(region_labels), tuple(rejected)


def _region(
    rings: list[int],
    label: int,
    starts: list[int],
    on_planes: PlaneOutlines,
    tolerances: Array,
    convex_tolerance: float,
    time: float,
    sigma: float,
) -> PlanarRegion | None:
    """The region of an outline and its holes; none where it is thinner than the tolerance."""
    R = on_planes.R_world_planes[label]
    first, last = starts[rings[0]], starts[rings[0] + 1]
    points, limits, ends = on_planes.points[first:last], tolerances[first:last], [0, last - first]
    if len(rings) > 1:
        spans = [slice(starts[ring], starts[ring + 1]) for ring in rings]
        points = np.concatenate([on_planes.points[span] for span in spans])
        limits = np.concatenate([tolerances[span] for span in spans])
        ends = [0, *accumulate(span.stop - span.start for span in spans)]
    vertices, ring_ends = simplify_rings(points, np.array(ends), limits)
    if ring_ends[0] == 0:
        return None
    x, y = vertices[: ring_ends[0]].mean(axis=0)
    vertices -= (x, y)
    parts, part_ends = decompose(vertices, ring_ends, convex_tolerance)
    hull, *holes = _cut(vertices, ring_ends)
    holes = tuple(hole for hole in holes if len(hole))
    area = float(signed_area(hull)) + sum(float(signed_area(hole)) for hole in holes)
    T_world_region = Pose(R, R @ np.array((x, y, on_planes.heights[label])))
    return PlanarRegion(T_world_region, hull, _cut(parts, part_ends), area, time, holes, sigma)


def _cut(stacked: Array, ends: Indices) -> tuple[Array, ...]:
    """Polygons that are stacked."""
    return tuple(stacked[a:b] for a, b in pairwise((0, *ends.tolist())))


def _holes_in(loop: int, outlines: Outlines, areas: list[float], area_min: float) -> list[int]:
    """The holes within an outline."""
    owners, starts, points = outlines.labels, outlines.starts, outlines.points
    candidates = np.flatnonzero((owners == owners[loop]) & (outlines.pixels < 0)).tolist()
    around = points[starts[loop] : starts[loop + 1]]
    return [
        hole
        for hole in candidates
        if -areas[hole] >= area_min and contains_point(around, points[starts[hole], 0], points[starts[hole], 1])
    ]


def _objection(
    area: float,
    steepness: float,
    depth: float,
    patches: float,
    bend: float,
    parameters: RegionParameters,
    noise: NoiseLevel,
) -> tuple[str, str] | None:
    """Cause and reason why an outline is no region, if there is one."""
    slope = math.acos(min(max(steepness, -1.0), 1.0))
    if math.isinf(depth):
        return "edge-on", "seen edge-on: its plane leaves the camera's range within its outline"
    if area < parameters.area_min:
        return "small", f"area {area:.4f} m^2, limit {parameters.area_min:g} m^2"
    if slope > parameters.slope_max:
        return "steep", f"slope {np.rad2deg(slope):.0f} deg, limit {np.rad2deg(parameters.slope_max):.0f} deg"
    if depth < parameters.distance_min:
        return "near", f"{depth:.2f} m from the camera, limit {parameters.distance_min:g} m: own body"
    if patches < parameters.patches_min:
        return "few pixels", f"{patches:.0f} patches, limit {parameters.patches_min}"
    if math.isinf(bend):
        return "thin", "too thin to fit a plane"
    bend_max = math.hypot(parameters.bend_max, _BEND_OF_NOISE * noise.shared(depth))
    if bend > bend_max:
        return "bent", f"bent by {1e3 * bend:.1f} mm, limit {1e3 * bend_max:.1f} mm"
    return None
