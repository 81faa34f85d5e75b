"""Planar regions out of one depth image.

After the rapid planar regions of Calvert et al. (look-and-step, 2022), with patch planes in closed form from inverse
depth: patches -> regions of patches -> labels of pixels -> outlines -> polygons and convex parts in the world.
Every step is deterministic and runs on one core.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skills.geometry.camera import DepthImage
from skills.geometry.pose import Array, readonly
from skills.regions.growing import grow_regions
from skills.regions.noise_level import NoiseLevel
from skills.regions.outline import trace_outlines
from skills.regions.own_body import without_body
from skills.regions.parameters import RegionParameters
from skills.regions.patches import fit_patches, patch_size
from skills.regions.planar_region import PlanarRegion, PlanarRegions
from skills.regions.plane_outlines import back_project
from skills.regions.refinement import refine_regions
from skills.regions.region_shapes import shape_regions


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
    seen = without_body(image)
    patches = fit_patches(seen, parameters)
    coarse = grow_regions(patches, parameters, parameters.patches_min)
    fine = refine_regions(seen, patches, coarse, parameters)
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
    accepted: list[int] = []
    rejected: list[RejectedRegion] = []

    def reject(loop: int, cause: str, reason: str) -> None:
        outline = outlines.points[starts[loop] : starts[loop + 1]]
        rejected.append(RejectedRegion(owners[loop], cause, reason, outline))

    starts, owners, pixels = outlines.starts.tolist(), outlines.labels.tolist(), outlines.pixels.tolist()
    areas, depths = on_planes.areas.tolist(), on_planes.depths.tolist()
    upwards, bends, sigmas = on_planes.R_world_planes[:, 2, 2].tolist(), bend.tolist(), sigma.tolist()
    for loop, label in enumerate(owners):
        patches = pixels[loop] / patch_pixels
        if patches < 0.0:
            continue
        objection = _objection(areas[loop], upwards[label], depths[loop], patches, bends[label], parameters, noise)
        if objection:
            reject(loop, *objection)
        else:
            accepted.append(loop)
    regions: list[PlanarRegion] = []
    region_labels: list[int] = []
    for shape in shape_regions(accepted, outlines, on_planes, parameters):
        if not shape.rings:
            reject(shape.loop, "thin", "thinner than the outline's tolerance")
            continue
        label = owners[shape.loop]
        hull, *holes = shape.rings
        regions.append(
            PlanarRegion(shape.T_world_region, hull, shape.parts, shape.area, image.time, tuple(holes), sigmas[label])
        )
        region_labels.append(label)
    return tuple(regions), tuple(region_labels), tuple(rejected)


def _objection(
    area: float,
    upwards: float,
    depth: float,
    patches: float,
    bend: float,
    parameters: RegionParameters,
    noise: NoiseLevel,
) -> tuple[str, str] | None:
    """Cause and reason why an outline is no region, if there is one."""
    slope = math.acos(min(max(upwards, -1.0), 1.0))
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
