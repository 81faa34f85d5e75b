"""Writes a run as it happens: the scene, what the robot saw and thought, its tree, its timing and its reasons.

Things are logged when they change. What changes with every tick is collected and sent in columns, which costs a
fiftieth of logging it row by row.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import rerun as rr

from behaviors import JobRecord, Node, Status, Tree
from lookstep import palette, shapes
from lookstep.deadlines import verdict
from lookstep.moment import Moment
from lookstep.recording import scene
from lookstep.recording.blueprint import TIMELINE, default_blueprint
from lookstep.recording.columns import Columns
from lookstep.recording.control import ControlViews
from lookstep.recording.film import Film
from lookstep.recording.perception import PerceptionViews
from sim_envs.robot import RobotDescription
from sim_envs.worlds import SimulatedWorld
from skills.body_path import BodyPath, Goal, SubGoal
from skills.footsteps import FootstepPlan, Side
from skills.geometry import Pose
from skills.height_map import HeightMap
from skills.regions import GroundUpdate, PlanarRegions, RegionExtraction
from skills.walking import StepEventKind

_APPLICATION = "lookstep"
# Links are drawn, images and maps of the ground kept at these periods; everything else when it changes [s].
_LINK_PERIOD = 0.05
_VALUE_PERIODS: dict[type, float] = {RegionExtraction: 1.0, PlanarRegions: 0.5, HeightMap: 2.0}
_FLUSH_PERIOD = 2.0
_REASON_PERIOD = 1.0
_SUB_GOAL_RADIUS = 0.05
_STATES = {
    Status.RUNNING: "running",
    Status.SUCCESS: "success",
    Status.FAILURE: "failure",
    Status.INVALID: "idle",
}
_ENDED = (Status.SUCCESS, Status.FAILURE)
_LEVELS = {"info": "INFO", "warning": "WARN", "error": "ERROR"}


class Recording:
    """An observer that writes one `.rrd` file.

    Args:
        path: the file.
        world: where the robot walks.
        tree: what drives it.
        robot: its table.
        about: a page about the run, Markdown.
        seed: of the run.
        film: pictures a second of a film from beside the robot; none where None.
    """

    def __init__(
        self,
        path: Path,
        world: SimulatedWorld,
        tree: Tree,
        robot: RobotDescription,
        about: str,
        seed: int,
        film: float | None = None,
    ) -> None:
        course = world.course
        self._stream = rr.RecordingStream(_APPLICATION, recording_id=f"{course.name}-{seed}")
        self._stream.save(
            path, default_blueprint=default_blueprint(course.start[:2], world.depth_cameras.names, film is not None)
        )
        self._course = course
        self._sole = robot.sole_corners_sole
        self._columns = Columns(self._stream)
        self._perception = PerceptionViews(self._stream, self._columns)
        self._film = None if film is None else Film(self._stream, film)
        self._control = ControlViews(self._stream, self._columns, world.joint_names)
        self._taken: list[tuple[Side, Pose]] = []
        self._seen: dict[str, Any] = {}
        self._reasons: dict[str, str] = {}
        self._next_reason: dict[str, float] = {}
        self._box_poses: dict[str, Any] = {}
        self._next_links = self._next_flush = 0.0
        self._next_value: dict[str, float] = {}
        self._deadline_lanes: set[str] = set()
        self._log_static(about)
        self._links = self._log_links(world)
        self._spec = tree.spec
        self._lanes = self._log_lanes(tree.nodes)

    def observe(self, moment: Moment) -> None:
        """Log what is new."""
        self._stream.set_time(TIMELINE, duration=moment.time)
        self._log_motion(moment)
        for key, value in moment.tree.blackboard.values().items():
            if self._seen.get(key) is not value and moment.time >= self._next_value.get(key, 0.0):
                self._seen[key] = value
                self._next_value[key] = moment.time + _VALUE_PERIODS.get(type(value), 0.0)
                self._log_value(key, value, moment)
        self._log_tree(moment)
        self._log_timing(moment)
        self._log_steps(moment)
        if self._film is not None:
            self._film.log(moment)
        if moment.time >= self._next_flush:
            self._next_flush = moment.time + _FLUSH_PERIOD
            self._flush()

    def close(self) -> None:
        """Write what is left and close the file."""
        self._flush()
        self._stream.flush()
        self._stream.disconnect()

    def _flush(self) -> None:
        self._control.flush()
        self._columns.flush()

    def _log_static(self, about: str) -> None:
        self._stream.log("world", rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        self._stream.log("about", rr.TextDocument(about, media_type="text/markdown"), static=True)
        for entity, color, name in (
            ("noise/own", palette.MEASURED, "of a pixel"),
            ("noise/shared", palette.BUDGET, "shared by neighbours"),
            ("drift/shift", palette.MEASURED, "correction of the estimate"),
            ("timing/PlanFootsteps/used", palette.MEASURED, "footstep plan"),
            ("timing/PlanFootsteps/budget", palette.BUDGET, "budget"),
            ("timing/ExtractRegions/used", palette.MEASURED, "regions"),
            ("timing/ExtractRegions/budget", palette.BUDGET, "budget"),
        ):
            self._stream.log(entity, rr.SeriesLines(colors=[color], names=[name], widths=[1.5]), static=True)

    def _log_links(self, world: SimulatedWorld) -> list[tuple[str, int]]:
        """Log the shape of each link once; returns entity and body id of each."""
        links = []
        for body, triangles in shapes.link_triangles(world.model):
            entity = f"world/robot/{world.model.body(body).name.rpartition('/')[2]}"
            self._stream.log(entity, scene.mesh(triangles, shaded=True), static=True)
            links.append((entity, body))
        return links

    def _log_motion(self, moment: Moment) -> None:
        time = moment.time
        if time >= self._next_links:
            self._next_links = time + _LINK_PERIOD
            data = moment.world.physics.data.ptr
            for entity, body in self._links:
                self._columns.transform(entity, time, data.xpos[body].copy(), data.xquat[body].copy())
        boxes = moment.world.box_poses()
        if boxes != self._box_poses:
            self._box_poses = boxes
            self._stream.log("world/course", scene.course_boxes(self._course, boxes))
        self._control.log(moment.samples)

    def _log_value(self, key: str, value: Any, moment: Moment) -> None:
        """Log a port value by its type, so that any tree's ports are shown, whatever their names."""
        log = self._stream.log
        height = float(moment.state.stance.mid_feet[2])
        match value:
            case PlanarRegions():
                log(f"world/{key}/outlines", scene.region_outlines(value))
                log(f"world/{key}/surfaces", scene.region_surfaces(value, shapes.colors_by_place(value)))
            case RegionExtraction():
                self._perception.log_extraction(value)
            case GroundUpdate():
                self._perception.log_update(value, moment.time)
            case HeightMap():
                self._perception.log_heights(value, moment.world.lidar_scan())
            case FootstepPlan():
                log(f"world/{key}/steps", scene.planned_soles(value.steps, self._sole))
                log(f"world/{key}/swings", scene.swing_ways(value.steps, moment.status.imminent_stance))
            case BodyPath():
                log(f"world/{key}", scene.path_line(value, height + 0.02))
            case SubGoal():
                x, y, _ = value.pose_world
                log(f"world/{key}", rr.Points3D([(x, y, height)], radii=_SUB_GOAL_RADIUS, colors=[palette.SUB_GOAL]))
            case Goal():
                log(f"world/{key}", scene.goal_arrow(value, height))
            case _:
                pass

    def _log_tree(self, moment: Moment) -> None:
        if moment.tree.spec is not self._spec:  # Another tree has taken over.
            self._spec = moment.tree.spec
            self._lanes = self._log_lanes(moment.tree.nodes)
        for transition in moment.tree.transitions:
            self._columns.state(self._lanes[transition.path], moment.time, _STATES[transition.after])
        for node in moment.tree.nodes:
            if not node.children and node.status in _ENDED and node.reason != self._reasons.get(node.path, ""):
                self._reasons[node.path] = node.reason
                self._log_reason(node, moment.time)
        for line in moment.log:
            self._log_line(line.path.rpartition("/")[2], line.text, _LEVELS[line.level])

    def _log_reason(self, node: Node, time: float) -> None:
        """Why a leaf ended; one that succeeds over and over with new figures is heard once in a while."""
        if node.status is Status.SUCCESS and time < self._next_reason.get(node.path, 0.0):
            return
        self._next_reason[node.path] = time + _REASON_PERIOD
        self._log_line(node.name, node.reason, "INFO")

    def _log_line(self, source: str, text: str, level: str) -> None:
        if text:
            self._stream.log("log", rr.TextLog(f"{source}: {text}", level=level))

    def _log_lanes(self, nodes: Sequence[Node]) -> dict[str, str]:
        """One lane a node, in the order of the tree: rerun sorts lanes by their entity paths."""
        states = list(palette.STATUS_COLORS)
        colors = np.array(list(palette.STATUS_COLORS.values()), dtype=np.uint8)
        lanes: dict[str, str] = {}
        for index, node in enumerate(nodes):
            lanes[node.path] = f"tree/{index:02d}_{node.name}"
            lane = rr.StateConfiguration(values=states, labels=states, colors=colors)
            self._stream.log(lanes[node.path], lane, static=True)
        return lanes

    def _log_timing(self, moment: Moment) -> None:
        for job in moment.jobs:
            self._log_deadline(job)
            kind = moment.tree.node(job.path).kind
            if job.compute_seconds is not None:
                self._columns.scalar(f"timing/{kind}/used", job.ended, 1e3 * job.compute_seconds)
                self._columns.scalar(f"timing/{kind}/budget", job.ended, 1e3 * job.budget)

    def _log_deadline(self, job: JobRecord) -> None:
        """A lane a leaf that says how its computations stand to their budgets, and the margins as plots."""
        name = job.path.rpartition("/")[2]
        lane = f"deadlines/{name}"
        if job.path not in self._deadline_lanes:
            self._deadline_lanes.add(job.path)
            states = list(palette.VERDICT_COLORS)
            colors = np.array(list(palette.VERDICT_COLORS.values()), dtype=np.uint8)
            self._stream.log(lane, rr.StateConfiguration(values=states, labels=states, colors=colors), static=True)
        self._columns.state(lane, job.submitted, verdict(job))
        if job.margin is not None:
            self._columns.scalar(f"margins/{name}", job.ended, 1e3 * job.margin)
        if job.deadline_margin is not None:
            self._columns.scalar(f"margins/{name}/before_landing", job.ended, 1e3 * job.deadline_margin)

    def _log_steps(self, moment: Moment) -> None:
        for event in moment.events:
            if event.kind is StepEventKind.COMPLETED:
                self._taken.append((event.step.side, event.T_world_sole))
                self._stream.log("world/steps_taken", scene.taken_soles(self._taken, self._sole))
