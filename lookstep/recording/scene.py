"""The solid things of a recording as rerun meshes and lines: robot links, blocks, regions, soles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import rerun as rr
from numpy.typing import NDArray

from lookstep import palette, shapes
from sim_envs.courses import Course
from skills.body_path import BodyPath, Goal
from skills.footsteps import Footstep, Side, Stance
from skills.geometry import Array, Pose
from skills.regions import PlanarRegions

BoxPose = tuple[tuple[float, ...], tuple[float, ...]]


def mesh(triangles: shapes.Triangles, *, shaded: bool = False) -> rr.Mesh3D:
    """Triangles as a mesh, with flat shading or none."""
    normals = triangles.normals if shaded else None
    return rr.Mesh3D(vertex_positions=triangles.corners, vertex_normals=normals, vertex_colors=triangles.colors)


def region_outlines(regions: PlanarRegions) -> rr.LineStrips3D:
    """Outline of every region."""
    strips = shapes.region_outlines(regions)
    return rr.LineStrips3D(strips, colors=[palette.REGION_EDGE] * len(strips), radii=0.004)


def region_surfaces(regions: PlanarRegions, region_colors: NDArray[np.uint8]) -> rr.Mesh3D | rr.Clear:
    """The convex parts of every region as one mesh in the regions' colours, (R, 3) RGB."""
    triangles = shapes.region_surfaces(regions, region_colors)
    return mesh(triangles) if len(triangles.corners) else rr.Clear(recursive=False)


def planned_soles(steps: Sequence[Footstep], sole: Array) -> rr.Mesh3D:
    """Soles of a plan; those after the first are paler, because they may still change."""
    colors = [shapes.side_color(step.side, firm=i == 0) for i, step in enumerate(steps)]
    return mesh(shapes.soles([step.T_world_sole for step in steps], sole, colors))


def taken_soles(steps: Sequence[tuple[Side, Pose]], sole: Array) -> rr.Mesh3D:
    """Soles where feet have landed."""
    colors = [palette.LEFT_TAKEN if side is Side.LEFT else palette.RIGHT_TAKEN for side, _ in steps]
    return mesh(shapes.soles([T_world_sole for _, T_world_sole in steps], sole, colors))


def swing_ways(steps: Sequence[Footstep], stance: Stance) -> rr.LineStrips3D:
    """The way of each swing foot through its waypoints, from a stance on."""
    colors = [shapes.side_color(step.side, firm=True) for step in steps]
    return rr.LineStrips3D(shapes.swing_ways(steps, stance), colors=colors, radii=0.005)


def path_line(path: BodyPath, height: float) -> rr.LineStrips3D:
    """The body path as a line at one height."""
    return rr.LineStrips3D([shapes.path_line(path, height)], colors=[palette.BODY_PATH], radii=0.01)


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
