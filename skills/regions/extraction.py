"""Planar regions out of one depth image.

After the rapid planar regions of Calvert et al. (look-and-step, 2022), with patch planes in closed form from inverse
depth: patches -> regions of patches -> labels of finer cells -> outlines -> polygons and convex parts in the world.
Every step is deterministic and runs on one core.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skills.geometry.camera import DepthImage
from skills.geometry.polygon import convex_parts, signed_area, simplify
from skills.geometry.pose import Array, Pose
from skills.regions.growing import Labels, Segmentation, grow_regions
from skills.regions.outline import trace_outlines
from skills.regions.parameters import RegionParameters
from skills.regions.patches import fit_patches
from skills.regions.planar_region import PlanarRegion, PlanarRegions
from skills.regions.refinement import refine_regions


@dataclass(frozen=True, slots=True, eq=False)
class Capsule:
    """A part of the robot's own body that the camera may see.

    Attributes:
        start_world, end_world: ends of its axis, (3,) [m].
        radius: distance from the axis within which pixels are ignored [m].
    """

    start_world: Array
    end_world: Array
    radius: float


@dataclass(frozen=True, slots=True, eq=False)
class RejectedRegion:
    """A flat piece of the image that is no ground.

    Attributes:
        label: its label.
        reason: why, as a short phrase for the operator.
        outline_image: its outline, (N, 2) [px].
    """

    label: int
    reason: str
    outline_image: Array


@dataclass(frozen=True, slots=True, eq=False)
class RegionExtraction:
    """Everything that one extraction found out, for people who look into it.

    Attributes:
        regions: the result.
        labels: flat piece of each cell of the image, (rows, columns) int32; -1 for none.
        cell_size: edge of a cell [px].
        region_labels: the label behind each region.
        rejected: flat pieces that became no region.
    """

    regions: PlanarRegions
    labels: Labels
    cell_size: int
    region_labels: tuple[int, ...]
    rejected: tuple[RejectedRegion, ...]


DEFAULT_PARAMETERS = RegionParameters()


def extract_regions(
    image: DepthImage, parameters: RegionParameters = DEFAULT_PARAMETERS, body: tuple[Capsule, ...] = ()
) -> PlanarRegions:
    """Planar regions of ground in the world, from one depth image.

    Args:
        image: the depth image with the camera's pose.
        parameters: tolerances and limits.
        body: parts of the robot that must not become ground.
    """
    return examine_regions(image, parameters, body).regions


def examine_regions(
    image: DepthImage, parameters: RegionParameters = DEFAULT_PARAMETERS, body: tuple[Capsule, ...] = ()
) -> RegionExtraction:
    """The same as `extract_regions`, with labels and with what was rejected and why."""
    patches = fit_patches(image, parameters, _capsules_in_camera(body, image.T_world_camera))
    coarse = grow_regions(patches, parameters)
    fine, bend = refine_regions(image, patches, coarse, parameters)
    cell_size = patches.size // 2
    regions, region_labels, rejected = _regions_of(image, fine, bend, cell_size, parameters)
    found = PlanarRegions(regions, image.time, image.frame_id)
    return RegionExtraction(found, fine.labels, cell_size, region_labels, rejected)


def _capsules_in_camera(body: tuple[Capsule, ...], T_world_camera: Pose) -> Array:
    T_camera_world = T_world_camera.inverse
    rows = [(*(T_camera_world @ c.start_world), *(T_camera_world @ c.end_world), c.radius) for c in body]
    return np.array(rows, dtype=np.float64).reshape(-1, 7)


def _regions_of(
    image: DepthImage, fine: Segmentation, bend: Array, cell_size: int, parameters: RegionParameters
) -> tuple[tuple[PlanarRegion, ...], tuple[int, ...], tuple[RejectedRegion, ...]]:
    """Turn labelled cells into polygons in the world and sort out what is no ground."""
    regions: list[PlanarRegion] = []
    region_labels: list[int] = []
    rejected: list[RejectedRegion] = []
    outlines = _Outlines.of(image, fine, cell_size)
    for label in range(len(fine.planes)):
        R_world_region = _facing_up(fine.planes[label], image.T_world_camera)
        loops = [k for k, owner in enumerate(outlines.owners) if owner == label]
        flat = [outlines.world[k] @ R_world_region[:, :2] for k in loops]
        areas = [float(signed_area(loop)) for loop in flat]
        for k, loop, area in zip(loops, flat, areas, strict=True):
            if area <= 0.0:
                continue
            reason = _reason_against(area, R_world_region, outlines.depth[k], bend[label], parameters)
            if reason:
                rejected.append(RejectedRegion(label, reason, outlines.image[k]))
                continue
            holes = [h for h, a in zip(flat, areas, strict=True) if a < -parameters.hole_area_min and _within(h, loop)]
            origin = float(np.mean(outlines.world[k] @ R_world_region[:, 2])), loop.mean(axis=0)
            p = R_world_region @ np.array((*origin[1], origin[0]))
            shapes = [simplify(shape - origin[1], parameters.outline_tolerance) for shape in (loop, *holes)]
            region = _region(
                Pose(R_world_region, p), shapes[0], tuple(s for s in shapes[1:] if len(s) > 2), image.time,
                float(fine.sigma[label]), parameters,
            )  # fmt: skip
            regions.append(region)
            region_labels.append(label)
    return tuple(regions), tuple(region_labels), tuple(rejected)


@dataclass(frozen=True, slots=True)
class _Outlines:
    """All outlines of an image: whose they are, in pixels, in the world, and the mean depth of each."""

    owners: list[int]
    image: list[Array]
    world: list[Array]
    depth: list[float]

    @classmethod
    def of(cls, image: DepthImage, fine: Segmentation, cell_size: int) -> _Outlines:
        camera = image.camera
        traced = [(k, loop) for k, loop in trace_outlines(fine.labels) if len(loop) >= 8]
        if not traced:
            return cls([], [], [], [])
        owners = [k for k, _ in traced]
        sizes = [len(loop) for _, loop in traced]
        uv = np.concatenate([loop for _, loop in traced]) * cell_size - 0.5
        rays = np.column_stack(((uv - (camera.cx, camera.cy)) / (camera.fx, camera.fy), np.ones(len(uv))))
        planes = np.repeat(fine.planes[owners], sizes, axis=0)
        depth = 1.0 / np.maximum(np.sum(rays * planes, axis=1), 1.0 / camera.far)
        world = image.T_world_camera @ (rays * depth[:, None])
        cuts = np.cumsum(sizes)[:-1]
        means = np.add.reduceat(depth, np.concatenate(([0], cuts))) / sizes
        return cls(owners, np.split(uv, cuts), np.split(world, cuts), means.tolist())


def _facing_up(plane: Array, T_world_camera: Pose) -> Array:
    """R_world_region with z towards the camera's side of the plane and x along the world's x as far as it can be."""
    normal = T_world_camera.R @ (-plane / np.linalg.norm(plane))
    heading = np.array((1.0, 0.0, 0.0)) if abs(normal[0]) < 0.9 else np.array((0.0, 1.0, 0.0))
    y = np.cross(normal, heading)
    y /= np.linalg.norm(y)
    return np.column_stack((np.cross(y, normal), y, normal))


def _reason_against(area: float, R: Array, depth: float, bend: float, parameters: RegionParameters) -> str:
    slope = np.arccos(np.clip(R[2, 2], -1.0, 1.0))
    if area < parameters.area_min:
        return f"area {area:.4f} m^2, limit {parameters.area_min:g} m^2"
    if slope > parameters.slope_max:
        return f"slope {np.rad2deg(slope):.0f} deg, limit {np.rad2deg(parameters.slope_max):.0f} deg"
    if depth < parameters.distance_min:
        return f"{depth:.2f} m from the camera, limit {parameters.distance_min:g} m: own body"
    if not bend <= parameters.bend_max:
        return f"bent by {1e3 * bend:.1f} mm, limit {1e3 * parameters.bend_max:g} mm"
    return ""


def _within(hole: Array, loop: Array) -> bool:
    return bool(np.all(hole.min(axis=0) >= loop.min(axis=0)) and np.all(hole.max(axis=0) <= loop.max(axis=0)))


def _region(
    T_world_region: Pose, hull: Array, holes: tuple[Array, ...], time: float, sigma: float, parameters: RegionParameters
) -> PlanarRegion:
    area = float(signed_area(hull)) + sum(float(signed_area(hole)) for hole in holes)
    parts = convex_parts(hull, parameters.convex_tolerance, holes)
    return PlanarRegion(T_world_region, hull, parts, area, time, holes, sigma)
