"""A recording of a footstep search: the ground, the search as it went, each rejected step with its reason.

One or two results lie side by side. The timeline `expansion` counts the nodes that the search expanded.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import rerun as rr
import rerun.blueprint as rrb
from numpy.typing import NDArray

from lookstep import palette, shapes
from lookstep.recording import scene
from skills.footsteps import FootstepPlan, PlanRequest, SearchLog, Side, whole_sole
from skills.footsteps.rejections import REASONS
from skills.geometry import Array

TIMELINE = "expansion"
# A longer search is shown in so many moments, each of several expansions.
_MOMENTS = 300
_LIFT = np.array((0.0, 0.0, 0.03))
_NODE_RADIUS, _EDGE_RADIUS = 0.006, 0.0012


def write_plans(path: Path, results: Mapping[str, tuple[PlanRequest, FootstepPlan, tuple[SearchLog, ...]]]) -> None:
    """Write one `.rrd` file with one view a result, under its name."""
    stream = rr.RecordingStream("lookstep_plan", recording_id=path.stem)
    stream.save(path, default_blueprint=_blueprint(results))
    for name, (request, plan, searches) in results.items():
        root = _entity(name)
        stream.log(root, rr.ViewCoordinates.RIGHT_HAND_Z_UP, static=True)
        _log_ground(stream, root, request)
        _log_plan(stream, root, request, plan)
        for search in searches:
            _log_search(stream, f"{root}/search_{search.first_side.value}_first", search)
        stream.log(
            f"{root}/rejections", rr.TextDocument(rejections_page(plan), media_type="text/markdown"), static=True
        )
    stream.flush()
    stream.disconnect()


def rejections_page(plan: FootstepPlan) -> str:
    """How a plan ended and why edges were rejected, as Markdown."""
    from skills.footsteps.rejections import in_percent

    rows = [f"| {reason} | {percent:.3g} % |" for reason, percent in in_percent(plan.rejections)]
    how = f"**{plan.outcome.value}**, {len(plan.steps)} steps, cost {plan.cost:.3f}, {plan.expansions} expansions"
    return "\n".join((how, "", plan.reason, "", "| rejected edges | share |", "|---|---|", *rows))


def _log_ground(stream: rr.RecordingStream, root: str, request: PlanRequest) -> None:
    colors = shapes.colors_by_place(request.ground)
    stream.log(f"{root}/ground/outlines", scene.region_outlines(request.ground), static=True)
    stream.log(f"{root}/ground/surfaces", scene.region_surfaces(request.ground, colors), static=True)
    height = float(request.stance.mid_feet[2])
    stream.log(f"{root}/path", scene.path_line(request.sub_goal.path, height), static=True)
    stances = [(side, request.stance.sole(side)) for side in Side]
    stream.log(f"{root}/stance", scene.taken_soles(stances, whole_sole(request.footsteps)), static=True)


def _log_plan(stream: rr.RecordingStream, root: str, request: PlanRequest, plan: FootstepPlan) -> None:
    if not plan.steps:
        return
    stream.log(f"{root}/plan", scene.planned_soles(plan.steps, whole_sole(request.footsteps)), static=True)
    stream.log(f"{root}/swings", scene.swing_ways(plan.steps, request.stance), static=True)
    labels = [
        f"step {i}: {step.side.value}, swing {step.swing_duration:.2f} s, margin {1e3 * step.margin:.0f} mm"
        for i, step in enumerate(plan.steps, 1)
    ]
    points = np.array([step.T_world_sole.p for step in plan.steps]) + _LIFT
    stream.log(f"{root}/labels", rr.Points3D(points, radii=_NODE_RADIUS, labels=labels, show_labels=False), static=True)


def _log_search(stream: rr.RecordingStream, root: str, search: SearchLog) -> None:
    """Expanded nodes add up; the edges of a moment are those looked at in it, rejected ones under their reasons."""
    edges = search.edges
    if not len(edges):
        return
    starts, ends = _ends(search)
    count = int(edges["expansion"].max()) + 1
    each = max(1, -(-count // _MOMENTS))
    moments = edges["expansion"] // each
    reasons = sorted({int(reason) for reason in edges["reason"][~(search.expanded | search.opened)]})
    for moment in range(int(moments.max()) + 1):
        stream.set_time(TIMELINE, sequence=moment * each)
        now = moments == moment
        past = search.expanded & (moments <= moment)
        _log_nodes(stream, f"{root}/expanded", edges[past], ends[past])
        _log_edges(stream, f"{root}/opened", edges, starts, ends, search.opened & now, palette.OPENED, "opened")
        for reason in reasons:
            chosen = now & (edges["reason"] == reason)
            entity = f"{root}/rejected/{_entity(REASONS[reason])}"
            _log_edges(stream, entity, edges, starts, ends, chosen, palette.REJECTED, REASONS[reason])
    stream.reset_time()


def _log_nodes(stream: rr.RecordingStream, entity: str, rows: NDArray[np.void], places: Array) -> None:
    """Nodes in the order in which they were expanded, the later the brighter."""
    share = np.arange(1, len(rows) + 1) / max(len(rows), 1)
    colors = (np.array(palette.EXPANDED[:3]) * (0.35 + 0.65 * share[:, None])).astype(np.uint8)
    labels = [
        f"{i}: cost {row['cost']:.3f}, to go {row['to_go']:.3f}" for i, row in enumerate(rows)
    ]  # hovering shows them
    stream.log(entity, rr.Points3D(places, colors=colors, radii=_NODE_RADIUS, labels=labels, show_labels=False))


def _log_edges(
    stream: rr.RecordingStream,
    entity: str,
    edges: NDArray[np.void],
    starts: Array,
    ends: Array,
    chosen: NDArray[np.bool_],
    color: palette.RGBA,
    what: str,
) -> None:
    strips = np.stack((starts[chosen], ends[chosen]), axis=1).astype(np.float32)
    labels = [f"{what}, cost {row['cost']:.3f}" if row["cost"] > 0.0 else what for row in edges[chosen]]
    stream.log(entity, rr.LineStrips3D(strips, colors=[color], radii=_EDGE_RADIUS, labels=labels, show_labels=False))


def _ends(search: SearchLog) -> tuple[Array, Array]:
    """Where the edges begin and end, (N, 3) each; a node without known ground lies as high as the stance foot."""
    heights: dict[int, float] = {}
    for node, z in zip(search.edges["node"].tolist(), search.edges["z"].tolist(), strict=True):
        if np.isfinite(z):
            heights[node] = z
    level = float(search.anchor_world[2])
    found = []
    for column in ("parent", "node"):
        nodes = search.edges[column]
        places, _ = search.places(nodes)
        z = np.array([heights.get(node, level) for node in nodes.tolist()])
        xyz = np.column_stack((places[:, :2], z)) + _LIFT
        # The foot that swings first has no node; its edges begin and end at the stance foot.
        xyz[np.isnan(xyz[:, 0])] = search.anchor_world + _LIFT
        found.append(xyz)
    return found[0], found[1]


def _entity(name: str) -> str:
    return name.replace(" ", "_").replace("'", "")


def _blueprint(results: Mapping[str, tuple[PlanRequest, FootstepPlan, tuple[SearchLog, ...]]]) -> rrb.Blueprint:
    columns = []
    for name, (request, _, _) in results.items():
        feet = request.stance.mid_feet
        ahead = np.array((np.cos(request.stance.yaw), np.sin(request.stance.yaw), 0.0))
        view = rrb.Spatial3DView(
            name=name,
            origin=f"/{_entity(name)}",
            background=rrb.Background(color=(208, 216, 226, 255)),
            line_grid=rrb.LineGrid3D(visible=False),
            eye_controls=rrb.EyeControls3D(
                kind=rrb.components.Eye3DKind.Orbital,
                position=tuple(feet - 0.6 * ahead + (0.0, 0.0, 1.8)),
                look_target=tuple(feet + 0.7 * ahead),
            ),
        )
        page = rrb.TextDocumentView(name=f"Rejected edges: {name}", origin=f"/{_entity(name)}/rejections")
        columns.append(rrb.Vertical(view, page, row_shares=[3, 1]))
    return rrb.Blueprint(
        rrb.Horizontal(*columns),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
        rrb.TimePanel(state="expanded", timeline=TIMELINE),
        auto_views=False,
    )
