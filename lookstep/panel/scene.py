"""The scene: a snapshot -> what the browser draws in 3D; a thing is sent again only when it has changed."""

from __future__ import annotations

import time as wall
from collections.abc import Callable, Sequence

import numpy as np
import viser

from lookstep import palette, shapes
from lookstep.lidar_points import scan_points
from lookstep.panel.figure import Figure, by_color
from lookstep.panel.ghost import Ghost
from lookstep.panel.ghost_figure import GhostFigure
from lookstep.panel.snapshot import Snapshot
from lookstep.perception_pictures import colored
from skills.body_path import BodyPath, Goal, SubGoal
from skills.footsteps import Footstep, FootstepPlan
from skills.geometry import Array
from skills.height_map import HeightMap
from skills.regions import PlanarRegions

# What can be hidden, and what is to be seen at first.
GROUPS = {
    "Robot": True,
    "Course (simulation only)": True,
    "Lidar points": False,
    "Height map": False,
    "Planar regions": True,
    "Body path and goal": True,
    "Footsteps": True,
    "Balance": True,
    "Ghost": True,
}
_LIFT = 0.03
_PATH_PITCH = 0.1  # between two points of the path that is drawn [m]
_CUBE_CORNERS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)], np.float32)
_CUBE_FACES = np.array(
    (
        *((0, 1, 3), (0, 3, 2), (4, 6, 7), (4, 7, 5), (0, 4, 5), (0, 5, 1)),
        *((2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 5, 7), (1, 7, 3)),
    ),
    np.uint32,
)
_TENTATIVE_OPACITY, _PLANNED_OPACITY = 0.35, 0.75
_GROUND_DISTANCE = 3.0  # of the camera at first [m]


class Scene:
    """Draws snapshots.

    Args:
        server: whose clients see it.
        first: the first snapshot, whose robot and course are drawn from then on.
    """

    def __init__(self, server: viser.ViserServer, first: Snapshot) -> None:
        self._server, self._scene = server, server.scene
        self._drawn: dict[str, tuple[object, ...]] = {}
        self._handles: dict[str, list[viser.SceneNodeHandle]] = {}
        self._groups = {name: self._scene.add_frame(_group(name), show_axes=False) for name in GROUPS}
        for name, visible in GROUPS.items():
            self._groups[name].visible = visible
        stage = first.stage
        self._sole = stage.robot.sole_corners_sole
        self._robot = Figure(server, f"{_group('Robot')}/figure", stage.robot, stage.joint_names)
        self._ghost = GhostFigure(server, f"{_group('Ghost')}/figure", stage.robot, stage.joint_names)
        self._previewed: tuple[FootstepPlan, Ghost, float] | None = None
        self._place_camera(first)

    def show(self, group: str, visible: bool) -> None:
        """Show or hide a group."""
        self._groups[group].visible = visible

    def draw(self, snapshot: Snapshot) -> None:
        """Draw what has changed."""
        self._robot.show(snapshot.state.T_world_pelvis, snapshot.state.joint_positions)
        self._draw_course(snapshot)
        self._draw_ground(snapshot)
        self._draw_way(snapshot)
        self._draw_steps(snapshot)
        self._draw_balance(snapshot)
        self._draw_ghost(snapshot)

    def mark_place(self, position: Array, yaw: float | None) -> None:
        """A place that is being put down: a pin, and an arrow once there is a heading."""
        self.clear_place()
        at = np.asarray(position, dtype=float)
        name = "/placing"
        if yaw is None:
            handle = self._scene.add_icosphere(name, radius=0.08, color=palette.GOAL[:3], position=at)
        else:
            handle = self._arrow(name, at, yaw, palette.GOAL)
        self._handles[name] = [handle]

    def clear_place(self) -> None:
        """Take the pin away."""
        self._remove("/placing")

    def mark_waypoints(self, places: Sequence[tuple[Goal, float]]) -> None:
        """Arrows for waypoints that wait to be sent, each with its height."""
        self._remove("/waypoints")
        self._handles["/waypoints"] = [
            self._arrow(f"/waypoints/{i}", np.array((goal.x, goal.y, height)), goal.yaw, palette.SUB_GOAL)
            for i, (goal, height) in enumerate(places)
        ]

    def _draw_course(self, snapshot: Snapshot) -> None:
        boxes = snapshot.stage.boxes
        if not boxes or not self._is_new("course", snapshot.boxes):
            return
        poses = [snapshot.boxes[box.name] for box in boxes]
        self._add(
            "course",
            lambda: self._scene.add_batched_meshes_simple(
                f"{_group('Course (simulation only)')}/boxes",
                _CUBE_CORNERS,
                _CUBE_FACES,
                batched_positions=np.array([position for position, _ in poses], np.float32),
                batched_wxyzs=np.array([wxyz for _, wxyz in poses], np.float32),
                batched_scales=np.array([box.size for box in boxes], np.float32),
                batched_colors=np.array([palette.BOX_COLORS.get(b.kind, palette.BLOCK)[:3] for b in boxes], np.uint8),
                flat_shading=True,
                lod="off",
            ),
        )

    def _draw_ground(self, snapshot: Snapshot) -> None:
        regions, heights, scan = snapshot.value(PlanarRegions), snapshot.value(HeightMap), snapshot.scan
        if self._is_new("regions", regions):
            group = _group("Planar regions")
            surfaces = None if regions is None else shapes.region_surfaces(regions, shapes.colors_by_place(regions))
            self._meshes("regions", f"{group}/surfaces", surfaces, 0.85)
            outlines = [] if regions is None else shapes.region_outlines(regions)
            self._lines("region_outlines", f"{group}/outlines", outlines, palette.REGION_EDGE, 0.008)
        if self._is_new("heights", heights) and heights is not None:
            known = ~np.isnan(heights.heights)
            colors = colored(heights.heights)[known]
            self._points("heights", f"{_group('Height map')}/cells", heights.points_world, colors, heights.resolution)
        if self._is_new("scan", scan) and scan is not None:
            self._points("scan", f"{_group('Lidar points')}/scan", scan_points(scan), palette.SCAN[:3], 0.02)

    def _draw_way(self, snapshot: Snapshot) -> None:
        group, height = _group("Body path and goal"), float(snapshot.state.stance.mid_feet[2])
        path, sub_goal, goal = snapshot.value(BodyPath), snapshot.value(SubGoal), snapshot.value(Goal)
        if self._is_new("path", path):
            lines = [] if path is None else [_on_ground(path, snapshot.value(HeightMap), height)]
            self._lines("path", f"{group}/path", lines, palette.BODY_PATH, 0.025)
        if self._is_new("sub_goal", sub_goal):
            self._remove("sub_goal")
            if sub_goal is not None:
                x, y, _ = sub_goal.pose_world
                place = np.array((x, y, height + _LIFT))
                self._add("sub_goal", lambda: self._ball(f"{group}/sub_goal", place, palette.SUB_GOAL, 0.06))
        if self._is_new("goal", goal):
            self._remove("goal")
            if goal is not None:
                place = np.array((goal.x, goal.y, height + _LIFT))
                self._add("goal", lambda: self._arrow(f"{group}/goal", place, goal.yaw, palette.GOAL))

    def _draw_steps(self, snapshot: Snapshot) -> None:
        """Commanded steps are solid; planned ones see-through, fainter after the first; approved ones have a rim."""
        group, status, plan = _group("Footsteps"), snapshot.status, snapshot.value(FootstepPlan)
        commanded = tuple(filter(None, (status.current_step, *status.queue)))
        if not self._is_new("steps", plan, snapshot.approved, *commanded):
            return
        sent = {step.sequence_id for step in commanded}
        done = status.last_sequence_id
        planned = [] if plan is None else [s for s in plan.steps if s.sequence_id > done and s.sequence_id not in sent]
        for name, steps, opacity in (
            ("commanded", commanded, None),
            ("planned", planned[:1], _PLANNED_OPACITY),
            ("tentative", planned[1:], _TENTATIVE_OPACITY),
        ):
            self._meshes(name, f"{group}/{name}", self._soles(steps), opacity)
        approved = [step for step in (*commanded, *planned) if step.sequence_id in snapshot.approved]
        rims = [shapes.closed(step.T_world_sole @ _raised(1.25 * self._sole)) for step in approved]
        self._lines("approved", f"{group}/approved", rims, palette.GOAL, 0.012)
        ways = shapes.swing_ways([*commanded, *planned], snapshot.state.stance)
        self._lines("swings", f"{group}/swings", ways, palette.DCM_PLANNED, 0.01)

    def _draw_balance(self, snapshot: Snapshot) -> None:
        sample = snapshot.balance
        if sample is None or not self._is_new("balance", sample):
            return
        group, height = _group("Balance"), float(sample.cmp_world[2]) + _LIFT
        corners = np.column_stack((sample.support_world, np.full(len(sample.support_world), height)))
        self._lines("support", f"{group}/support", [shapes.closed(corners)], palette.SUPPORT, 0.015)
        points = np.array([(*sample.dcm_world[:2], height), (*sample.dcm_reference_world[:2], height)])
        colors = np.array([palette.DCM[:3], palette.DCM_PLANNED[:3]], np.uint8)
        self._points("dcm", f"{group}/dcm", points, colors, 0.05)

    def _draw_ghost(self, snapshot: Snapshot) -> None:
        """While a plan waits for approval, somebody walks it."""
        plans = [request.item for request in snapshot.reviews if isinstance(request.item, FootstepPlan)]
        if not plans or not plans[0].steps:
            self._previewed = None
            self._ghost.hide()
            return
        if self._previewed is None or self._previewed[0] is not plans[0]:
            stance = snapshot.status.imminent_stance
            self._previewed = (plans[0], Ghost(stance, plans[0].steps), wall.monotonic())
        _, ghost, since = self._previewed
        self._ghost.show(ghost.at(wall.monotonic() - since), snapshot.state)

    def _place_camera(self, first: Snapshot) -> None:
        x, y, yaw = first.stage.start
        ahead, left = np.array((np.cos(yaw), np.sin(yaw), 0.0)), np.array((-np.sin(yaw), np.cos(yaw), 0.0))
        middle = np.array((x, y, float(first.state.stance.mid_feet[2])))
        camera = self._server.initial_camera
        camera.up = (0.0, 0.0, 1.0)
        camera.look_at = middle + 1.2 * ahead + (0.0, 0.0, 0.5)
        camera.position = middle - 1.6 * ahead - _GROUND_DISTANCE * left + (0.0, 0.0, 2.4)
        self._scene.set_up_direction("+z")

    def _soles(self, steps: Sequence[Footstep]) -> shapes.Triangles:
        colors = [shapes.side_color(step.side, firm=True) for step in steps]
        return shapes.soles([step.T_world_sole for step in steps], self._sole, colors)

    def _is_new(self, name: str, *sources: object) -> bool:
        """Whether the things that a drawing shows are others than when it was drawn."""
        before = self._drawn.get(name)
        if before is not None and len(before) == len(sources) and all(map(_same, before, sources)):
            return False
        self._drawn[name] = sources
        return True

    def _add(self, name: str, make: Callable[[], viser.SceneNodeHandle]) -> None:
        self._handles[name] = [make()]

    def _remove(self, name: str) -> None:
        for handle in self._handles.pop(name, []):
            handle.remove()

    def _meshes(self, name: str, node: str, triangles: shapes.Triangles | None, opacity: float | None) -> None:
        """Replace meshes of one colour each."""
        with self._server.atomic():
            self._remove(name)
            if triangles is None or not len(triangles.corners):
                return
            self._handles[name] = [
                self._scene.add_mesh_simple(
                    f"{node}/{r:02x}{g:02x}{b:02x}",
                    corners,
                    np.arange(len(corners), dtype=np.uint32).reshape(-1, 3),
                    color=(r, g, b),
                    opacity=opacity,
                    side="double",
                    cast_shadow=False,
                    flat_shading=True,
                )
                for (r, g, b), corners in by_color(triangles)
            ]

    def _lines(self, name: str, node: str, lines: Sequence[Array], color: palette.RGBA, thickness: float) -> None:
        segments = [np.stack((line[:-1], line[1:]), axis=1) for line in lines]
        with self._server.atomic():
            self._remove(name)
            if segments:
                points = np.concatenate(segments).astype(np.float32)
                handle = self._scene.add_line_segments(node, points, colors=color[:3], thickness=thickness)
                self._handles[name] = [handle]

    def _points(self, name: str, node: str, points: np.ndarray, colors: object, size: float) -> None:
        self._add(
            name,
            lambda: self._scene.add_point_cloud(
                node, np.asarray(points, np.float32), np.asarray(colors, np.uint8), point_size=size, precision="float32"
            ),
        )

    def _ball(self, node: str, place: Array, color: palette.RGBA, radius: float) -> viser.SceneNodeHandle:
        return self._scene.add_icosphere(node, radius=radius, color=color[:3], position=place)

    def _arrow(self, node: str, place: Array, yaw: float, color: palette.RGBA) -> viser.SceneNodeHandle:
        tip = place + 0.6 * np.array((np.cos(yaw), np.sin(yaw), 0.0))
        return self._scene.add_arrows(
            node,
            np.array([[place, tip]], np.float32),
            colors=color[:3],
            shaft_radius=0.03,
            head_radius=0.08,
            head_length=0.2,
        )


def _group(name: str) -> str:
    """The node of a group."""
    return "/" + name.split(" (")[0].lower().replace(" ", "_")


def _on_ground(path: BodyPath, heights: HeightMap | None, otherwise: float) -> Array:
    """The body path over the height map, (N, 3); at another height where the map knows none [m]."""
    xy = np.array([path.at(arc)[:2] for arc in np.arange(0.0, path.length + _PATH_PITCH, _PATH_PITCH)])
    z = np.full(len(xy), np.nan) if heights is None else heights.nearest(xy)
    return np.column_stack((xy, np.where(np.isnan(z), otherwise, z) + _LIFT))


def _raised(polygon: Array) -> Array:
    return np.column_stack((polygon, np.full(len(polygon), _LIFT)))


def _same(one: object, other: object) -> bool:
    return one is other or (isinstance(one, frozenset | dict) and one == other)
