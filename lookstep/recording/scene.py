"""The solid things of a recording as rerun meshes and lines: robot links, blocks, regions, soles."""

# mujoco keeps its types in binary modules without stubs.
# pyright: reportAttributeAccessIssue=false
from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import mujoco
import numpy as np
import rerun as rr
from numpy.typing import NDArray

from lookstep.recording import palette
from sim_envs.courses import Course
from sim_envs.sensors import GeomMesh, geom_mesh, geom_rgba
from skills.body_path import BodyPath, Goal
from skills.footsteps import Footstep, Side, Stance
from skills.geometry import Array, Pose, convex_hull
from skills.regions import PlanarRegions

BoxPose = tuple[tuple[float, ...], tuple[float, ...]]

# Regions float above the blocks and footprints above the regions, or they would flicker through each other.
# Of two regions the later in the map is the newer; it lies on top.
_REGION_LIFT = 0.004
_NEWER_LIFT = 0.0001
_STEP_LIFT = 0.02
_ROUND_SEGMENTS = 24


def robot_meshes(model: mujoco.MjModel) -> Iterator[tuple[int, rr.Mesh3D]]:
    """The visible shape of each link in its own frame, links without one left out: (body id, mesh)."""
    mesh = geom_mesh(model, segments=_ROUND_SEGMENTS)
    bodies = model.geom_bodyid[mesh.geom_ids]
    for body in np.unique(bodies):
        # Boxes of the course are mocap bodies.
        if model.body_mocapid[body] < 0 and body != 0:
            yield int(body), _merged(model, mesh, np.flatnonzero(bodies == body))


def _merged(model: mujoco.MjModel, mesh: GeomMesh, members: np.ndarray) -> rr.Mesh3D:
    """Some geoms of one body as one mesh with flat shading."""
    triangles, colors = [], []
    for i in members:
        geom = int(mesh.geom_ids[i])
        T_body_geom = Pose.from_quaternion_wxyz(model.geom_quat[geom], model.geom_pos[geom])
        first = mesh.vertex_start[i]
        vertices_body = T_body_geom @ mesh.vertices_geom[first : mesh.vertex_start[i + 1]]
        faces = mesh.faces[mesh.face_start[i] : mesh.face_start[i + 1]] - first
        quads = faces[faces[:, 3] != faces[:, 2]]
        corners = vertices_body[np.concatenate((faces[:, [0, 1, 2]], quads[:, [0, 2, 3]]))]
        triangles.append(corners)
        color = np.round(255 * geom_rgba(model, geom)).astype(np.uint8)
        colors.append(np.tile(color, (3 * len(corners), 1)))
    corners = np.concatenate(triangles)
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    return rr.Mesh3D(
        vertex_positions=corners.reshape(-1, 3).astype(np.float32),
        vertex_normals=np.repeat(normals, 3, axis=0).astype(np.float32),
        vertex_colors=np.concatenate(colors),
    )


def region_outlines(regions: PlanarRegions) -> rr.LineStrips3D:
    """Outline of every region in its colour."""
    strips = [
        closed(_lifted(region.T_world_region, region.hull_region, _REGION_LIFT + _NEWER_LIFT * i))
        for i, region in enumerate(regions.regions)
    ]
    return rr.LineStrips3D(strips, colors=[palette.REGION_EDGE] * len(strips), radii=0.004)


def region_surfaces(regions: PlanarRegions, region_colors: NDArray[np.uint8]) -> rr.Mesh3D | rr.Clear:
    """The convex parts of every region as one mesh in the regions' colours, (R, 3) RGB."""
    corners, colors = [], []
    for i, region in enumerate(regions.regions):
        fans = np.concatenate([_fan(part) for part in region.convex_parts_region])
        corners.append(_lifted(region.T_world_region, fans, _REGION_LIFT + _NEWER_LIFT * i))
        colors.append(np.tile(region_colors[i], (len(fans), 1)))
    if not corners:
        return rr.Clear(recursive=False)
    return rr.Mesh3D(vertex_positions=np.concatenate(corners).astype(np.float32), vertex_colors=np.concatenate(colors))


def colors_by_place(regions: PlanarRegions) -> NDArray[np.uint8]:
    """Colours that regions keep from frame to frame, because they follow from where the regions lie, (R, 3) RGB."""
    centers = [region.hull_world.mean(axis=0) for region in regions.regions]
    colors = [palette.region_color((float(center[0]), float(center[1]))) for center in centers]
    return np.array(colors, dtype=np.uint8).reshape(-1, 3)


def planned_soles(steps: Sequence[Footstep], sole: Array) -> rr.Mesh3D:
    """Soles of a plan; those after the first are paler, because they may still change."""
    colors = []
    for i, step in enumerate(steps):
        left = step.side is Side.LEFT
        firm, pale = (palette.LEFT, palette.LEFT_TENTATIVE) if left else (palette.RIGHT, palette.RIGHT_TENTATIVE)
        colors.append(firm if i == 0 else pale)
    return _soles([step.T_world_sole for step in steps], sole, colors)


def taken_soles(steps: Sequence[tuple[Side, Pose]], sole: Array) -> rr.Mesh3D:
    """Soles where feet have landed."""
    colors = [palette.LEFT_TAKEN if side is Side.LEFT else palette.RIGHT_TAKEN for side, _ in steps]
    return _soles([T_world_sole for _, T_world_sole in steps], sole, colors)


def _soles(poses: Sequence[Pose], sole: Array, colors: Sequence[palette.RGBA]) -> rr.Mesh3D:
    """Filled soles whose toes are pointed, so that the heading shows."""
    toe = float(sole[:, 0].max())
    pointed = convex_hull(np.vstack((0.98 * sole, (1.12 * toe, 0.0))))
    fans = [_fan(_lifted(T_world_sole, pointed, _STEP_LIFT)) for T_world_sole in poses]
    return rr.Mesh3D(
        vertex_positions=np.concatenate(fans).astype(np.float32),
        vertex_colors=np.repeat(np.array(colors, dtype=np.uint8), [len(fan) for fan in fans], axis=0),
    )


def swing_ways(steps: Sequence[Footstep], stance: Stance) -> rr.LineStrips3D:
    """The way of each swing foot through its waypoints, from a stance on."""
    strips = []
    for step in steps:
        start = stance.sole(step.side)
        strips.append(np.vstack((start.p, step.swing_waypoints_world, step.T_world_sole.p)))
        stance = stance.with_sole(step.side, step.T_world_sole)
    colors = [palette.LEFT if step.side is Side.LEFT else palette.RIGHT for step in steps]
    return rr.LineStrips3D(strips, colors=colors, radii=0.005)


def path_line(path: BodyPath, height: float) -> rr.LineStrips3D:
    """The body path as a line at one height."""
    xy = path.waypoints_world[:, :2]
    return rr.LineStrips3D([np.column_stack((xy, np.full(len(xy), height)))], colors=[palette.BODY_PATH], radii=0.01)


def _lifted(T_world_plane: Pose, polygon: Array, lift: float) -> Array:
    """A polygon of the plane's xy in the world, a little above the plane, (N, 3) [m]."""
    return T_world_plane @ np.column_stack((polygon, np.full(len(polygon), lift)))


def closed(points: Array) -> Array:
    """A line around a polygon, (N + 1, d)."""
    return np.vstack((points, points[:1]))


def _fan(polygon: Array) -> Array:
    """A convex polygon (N, d) as the corners of its triangle fan, (3 (N - 2), d)."""
    inner = np.arange(1, len(polygon) - 1)
    return polygon[np.column_stack((np.zeros_like(inner), inner, inner + 1)).ravel()]


def course_boxes(course: Course, poses: Mapping[str, BoxPose]) -> rr.Boxes3D:
    """All boxes of a course as they lie now."""
    placed = [poses[box.name] for box in course.boxes]
    return rr.Boxes3D(
        half_sizes=[0.5 * np.array(box.size) for box in course.boxes],
        centers=[position for position, _ in placed],
        quaternions=[np.roll(wxyz, -1) for _, wxyz in placed],
        colors=[palette.BOX_COLORS.get(box.kind, palette.BLOCK) for box in course.boxes],
        fill_mode="solid",
        show_labels=False,
    )


def goal_arrow(goal: Goal, height: float) -> rr.Arrows3D:
    """The goal as an arrow along its heading."""
    vector = 0.4 * np.array((np.cos(goal.yaw), np.sin(goal.yaw), 0.0))
    return rr.Arrows3D(origins=[(goal.x, goal.y, height + 0.05)], vectors=[vector], colors=[palette.GOAL], radii=0.02)
