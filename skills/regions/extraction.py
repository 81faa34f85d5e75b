"""Planar regions out of one depth image.

After the rapid planar regions of Calvert et al. (look-and-step, 2022), with patch planes in closed form from inverse
depth: patches -> regions of patches -> labels of finer cells -> outlines -> polygons and convex parts in the world.
Every step is deterministic and runs on one core.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from skills.geometry.camera import DepthImage
from skills.geometry.polygon import convex_parts, signed_area, simplify
from skills.geometry.pose import Array, Pose, readonly
from skills.regions.growing import grow_regions
from skills.regions.outline import trace_outlines
from skills.regions.parameters import RegionParameters
from skills.regions.patches import fit_patches, patch_size
from skills.regions.planar_region import PlanarRegion, PlanarRegions
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
    """

    image: DepthImage
    regions: PlanarRegions
    labels: NDArray[np.int16]
    region_labels: tuple[int, ...]
    rejected: tuple[RejectedRegion, ...]
    parameters: RegionParameters

    def __post_init__(self) -> None:
        self.labels.flags.writeable = False


DEFAULT_PARAMETERS = RegionParameters()


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
    regions, region_labels, rejected = polygons_of(image, fine.labels, fine.planes, fine.sigma, fine.bend, parameters)
    found = PlanarRegions(regions, image.time, image.frame_id)
    return RegionExtraction(image, found, fine.labels, region_labels, rejected, parameters)


def polygons_of(
    image: DepthImage,
    labels: NDArray[np.int16],
    planes: Array,
    sigma: Array,
    bend: Array,
    parameters: RegionParameters,
) -> tuple[tuple[PlanarRegion, ...], tuple[int, ...], tuple[RejectedRegion, ...]]:
    """Turn labelled pixels into polygons in the world and sort out what is no ground.

    Args:
        image: the depth image.
        labels: flat piece of each pixel, (height, width); -1 for none.
        planes: plane of each piece, (R, 3) [1/m], as in `Patches`.
        sigma: spread of each piece's points about its plane, (R,) [m].
        bend: how much each piece is bent, (R,) [m]; infinite where that is not known.
        parameters: tolerances and limits.

    Returns:
        The regions, the label behind each of them, and the pieces that became no region.
    """
    regions: list[PlanarRegion] = []
    region_labels: list[int] = []
    rejected: list[RejectedRegion] = []
    R_world_regions = _frames(planes, image.T_world_camera)
    outlines = _back_project(
        trace_outlines(labels), image, planes, R_world_regions, patch_size(image.camera, parameters)
    )
    holes = [outline for outline in outlines if outline.area < -parameters.hole_area_min]
    for outline in outlines:
        if outline.area <= 0.0:
            continue
        label, R = outline.label, R_world_regions[outline.label]
        objection = _objection(outline, R, bend[label], parameters)
        if objection:
            rejected.append(RejectedRegion(label, *objection, outline.points_image))
            continue
        inside = [hole.points for hole in holes if hole.label == label and _within(hole.points, outline.points)]
        x, y, z = *outline.points.mean(axis=0), outline.height
        hull, *cut_out = (
            simplify(points - (x, y), parameters.outline_tolerance) for points in (outline.points, *inside)
        )
        if len(hull) < 3:
            rejected.append(RejectedRegion(label, "thin", "thinner than the outline's tolerance", outline.points_image))
            continue
        cut_out = tuple(hole for hole in cut_out if len(hole) > 2)
        parts = convex_parts(hull, parameters.convex_tolerance, cut_out)
        area = float(signed_area(hull)) + sum(float(signed_area(hole)) for hole in cut_out)
        T_world_region = Pose(R, R @ np.array((x, y, z)))
        regions.append(PlanarRegion(T_world_region, hull, parts, area, image.time, cut_out, float(sigma[label])))
        region_labels.append(label)
    return tuple(regions), tuple(region_labels), tuple(rejected)


@dataclass(frozen=True, slots=True)
class _Outline:
    """A loop around a flat piece or, clockwise, around a hole in it.

    `points` are x, y and `height` is the z that they share, along the axes of the region from the world's origin;
    `patches` is its size in the image and `depth` its mean.
    """

    label: int
    points_image: Array
    points: Array
    height: float
    area: float
    patches: float
    depth: float


def _back_project(
    loops: list[tuple[int, Array]], image: DepthImage, planes: Array, R_world_regions: Array, patch: int
) -> list[_Outline]:
    """Outlines on their planes, all in one go; loops around single pixels are left out."""
    loops = [(label, loop) for label, loop in loops if len(loop) > 4]
    if not loops:
        return []
    camera = image.camera
    sizes = np.array([len(loop) for _, loop in loops])
    ends = np.cumsum(sizes)
    starts = ends - sizes
    labels = np.repeat([label for label, _ in loops], sizes)
    uv = np.concatenate([loop for _, loop in loops]) - 0.5
    rays = np.column_stack(((uv - (camera.cx, camera.cy)) / (camera.fx, camera.fy), np.ones(len(uv))))
    depth = 1.0 / np.maximum(np.einsum("ni,ni->n", rays, planes[labels]), 1.0 / camera.far)
    points = np.einsum("ni,nij->nj", image.T_world_camera @ (rays * depth[:, None]), R_world_regions[labels])
    following = np.arange(1, len(uv) + 1)
    following[ends - 1] = starts
    turns = points[:, 0] * points[following, 1] - points[following, 0] * points[:, 1]
    areas = 0.5 * np.add.reduceat(turns, starts)
    pixels = -0.5 * np.add.reduceat(uv[:, 0] * uv[following, 1] - uv[following, 0] * uv[:, 1], starts)
    patches = pixels / patch**2
    depths = np.add.reduceat(depth, starts) / sizes
    heights = np.add.reduceat(points[:, 2], starts) / sizes
    return [
        _Outline(label, uv[a:b], points[a:b, :2], height, area, size, mean_depth)
        for (label, _), a, b, height, area, size, mean_depth in zip(
            loops,
            *(values.tolist() for values in (starts, ends, heights, areas, patches, depths)),
            strict=True,
        )
    ]


def _frames(planes: Array, T_world_camera: Pose) -> Array:
    """R_world_region of each plane, (R, 3, 3): z towards the camera's side, x along the world's x as far as it can."""
    normals = -(planes @ T_world_camera.R.T) / np.linalg.norm(planes, axis=1, keepdims=True)
    nx, ny, nz = normals.T
    zero = np.zeros(len(planes))
    y = np.where(np.abs(nx) < 0.9, np.array((zero, nz, -ny)), np.array((-nz, zero, nx))).T
    y /= np.linalg.norm(y, axis=1, keepdims=True)
    return np.stack((np.cross(y, normals), y, normals), axis=2)


def _objection(outline: _Outline, R: Array, bend: float, parameters: RegionParameters) -> tuple[str, str] | None:
    """Cause and reason why a piece is no region, if there is one."""
    slope = math.acos(min(max(R[2, 2], -1.0), 1.0))
    if outline.area < parameters.area_min:
        return "small", f"area {outline.area:.4f} m^2, limit {parameters.area_min:g} m^2"
    if slope > parameters.slope_max:
        return "steep", f"slope {np.rad2deg(slope):.0f} deg, limit {np.rad2deg(parameters.slope_max):.0f} deg"
    if outline.depth < parameters.distance_min:
        return "near", f"{outline.depth:.2f} m from the camera, limit {parameters.distance_min:g} m: own body"
    if outline.patches < parameters.patches_min:
        return "few pixels", f"{outline.patches:.0f} patches, limit {parameters.patches_min}"
    if math.isinf(bend):
        return "thin", "too thin to fit a plane"
    if bend > parameters.bend_max:
        return "bent", f"bent by {1e3 * bend:.1f} mm, limit {1e3 * parameters.bend_max:g} mm"
    return None


def _within(hole: Array, loop: Array) -> bool:
    return bool(np.all(hole.min(axis=0) >= loop.min(axis=0)) and np.all(hole.max(axis=0) <= loop.max(axis=0)))
