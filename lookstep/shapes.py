"""What is drawn of a robot, its plans and the ground, as triangles and lines: for the recording and for the panel."""

# mujoco keeps its types in binary modules without stubs.
# pyright: reportAttributeAccessIssue=false

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from lookstep import palette
from sim_envs.sensors import GeomMesh, geom_mesh, geom_rgba
from skills.body_path import BodyPath
from skills.footsteps import Footstep, Side, Stance
from skills.geometry import Array, Pose, convex_hull
from skills.regions import PlanarRegions

# Regions float above the blocks and footprints above the regions, or they would flicker through each other.
# Of two regions the later in the map is the newer; it lies on top.
_REGION_LIFT = 0.004
_NEWER_LIFT = 0.0001
_STEP_LIFT = 0.02
_ROUND_SEGMENTS = 24


@dataclass(frozen=True, slots=True, eq=False)
class Triangles:
    """Triangles that share no corners.

    Attributes:
        corners: (3 N, 3), counter-clockwise from outside [m].
        colors: of each corner, (3 N, 3) RGB or (3 N, 4) RGBA.
    """

    corners: NDArray[np.float32]
    colors: NDArray[np.uint8]

    @property
    def normals(self) -> NDArray[np.float32]:
        """Unit normal of each corner's triangle, (3 N, 3)."""
        a, b, c = self.corners[0::3], self.corners[1::3], self.corners[2::3]
        normals = np.cross(b - a, c - a)
        normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
        return np.repeat(normals, 3, axis=0).astype(np.float32)


def link_triangles(model: mujoco.MjModel) -> Iterator[tuple[int, Triangles]]:
    """The visible shape of each link in its own frame, links without one left out: (body id, shape)."""
    mesh = geom_mesh(model, segments=_ROUND_SEGMENTS)
    bodies = model.geom_bodyid[mesh.geom_ids]
    for body in np.unique(bodies):
        # Boxes of the course are mocap bodies.
        if model.body_mocapid[body] < 0 and body != 0:
            yield int(body), _merged(model, mesh, np.flatnonzero(bodies == body))


def _merged(model: mujoco.MjModel, mesh: GeomMesh, members: np.ndarray) -> Triangles:
    """Some geoms of one body as one shape."""
    corners, colors = [], []
    for i in members:
        geom = int(mesh.geom_ids[i])
        T_body_geom = Pose.from_quaternion_wxyz(model.geom_quat[geom], model.geom_pos[geom])
        first = mesh.vertex_start[i]
        vertices_body = T_body_geom @ mesh.vertices_geom[first : mesh.vertex_start[i + 1]]
        faces = mesh.faces[mesh.face_start[i] : mesh.face_start[i + 1]] - first
        quads = faces[faces[:, 3] != faces[:, 2]]
        triangles = np.concatenate((faces[:, :3], quads[:, [0, 2, 3]]))
        corners.append(vertices_body[triangles.ravel()])
        color = np.round(255 * geom_rgba(model, geom)).astype(np.uint8)
        colors.append(np.tile(color, (3 * len(triangles), 1)))
    return Triangles(np.concatenate(corners).astype(np.float32), np.concatenate(colors))


def region_outlines(regions: PlanarRegions) -> list[Array]:
    """The closed outline of every region, each (N + 1, 3)."""
    return [
        closed(_lifted(region.T_world_region, region.hull_region, _REGION_LIFT + _NEWER_LIFT * i))
        for i, region in enumerate(regions.regions)
    ]


def region_surfaces(regions: PlanarRegions, region_colors: NDArray[np.uint8]) -> Triangles:
    """The convex parts of every region in the regions' colours, (R, 3) RGB."""
    corners, colors = [np.zeros((0, 3))], [np.zeros((0, 3), np.uint8)]
    for i, region in enumerate(regions.regions):
        fans = np.concatenate([_fan(part) for part in region.convex_parts_region])
        corners.append(_lifted(region.T_world_region, fans, _REGION_LIFT + _NEWER_LIFT * i))
        colors.append(np.tile(region_colors[i], (len(fans), 1)))
    return Triangles(np.concatenate(corners).astype(np.float32), np.concatenate(colors))


def colors_by_place(regions: PlanarRegions) -> NDArray[np.uint8]:
    """Colours that regions keep from frame to frame, because they follow from where the regions lie, (R, 3) RGB."""
    centers = [region.hull_world.mean(axis=0) for region in regions.regions]
    colors = [palette.region_color((float(center[0]), float(center[1]))) for center in centers]
    return np.array(colors, dtype=np.uint8).reshape(-1, 3)


def soles(poses: Sequence[Pose], sole: Array, colors: Sequence[palette.RGBA]) -> Triangles:
    """Filled soles whose toes are pointed, so that the heading shows."""
    if not poses:
        return Triangles(np.zeros((0, 3), np.float32), np.zeros((0, 4), np.uint8))
    toe = float(sole[:, 0].max())
    pointed = convex_hull(np.vstack((0.98 * sole, (1.12 * toe, 0.0))))
    fans = [_fan(_lifted(T_world_sole, pointed, _STEP_LIFT)) for T_world_sole in poses]
    return Triangles(
        np.concatenate(fans).astype(np.float32),
        np.repeat(np.array(colors, dtype=np.uint8), [len(fan) for fan in fans], axis=0),
    )


def swing_ways(steps: Sequence[Footstep], stance: Stance) -> list[Array]:
    """The way of each swing foot through its waypoints, from a stance on, each (K + 2, 3)."""
    strips = []
    for step in steps:
        start = stance.sole(step.side)
        strips.append(np.vstack((start.p, step.swing_waypoints_world, step.T_world_sole.p)))
        stance = stance.with_sole(step.side, step.T_world_sole)
    return strips


def side_color(side: Side, *, firm: bool) -> palette.RGBA:
    """The colour of a planned sole; one that may still change is paler."""
    if side is Side.LEFT:
        return palette.LEFT if firm else palette.LEFT_TENTATIVE
    return palette.RIGHT if firm else palette.RIGHT_TENTATIVE


def path_line(path: BodyPath, height: float) -> Array:
    """The body path as a line at one height, (N, 3)."""
    xy = path.waypoints_world[:, :2]
    return np.column_stack((xy, np.full(len(xy), height)))


def closed(points: Array) -> Array:
    """A line around a polygon, (N + 1, d)."""
    return np.vstack((points, points[:1]))


def _lifted(T_world_plane: Pose, polygon: Array, lift: float) -> Array:
    """A polygon of the plane's xy in the world, a little above the plane, (N, 3) [m]."""
    return T_world_plane @ np.column_stack((polygon, np.full(len(polygon), lift)))


def _fan(polygon: Array) -> Array:
    """A convex polygon (N, d) as the corners of its triangle fan, (3 (N - 2), d)."""
    inner = np.arange(1, len(polygon) - 1)
    return polygon[np.column_stack((np.zeros_like(inner), inner, inner + 1)).ravel()]
