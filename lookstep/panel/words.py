"""A snapshot in words: the lines, tables and lists that stand beside the scene, as Markdown or HTML."""

from __future__ import annotations

import html

from behaviors import LogLine
from behaviors.operator import ReviewRequest
from lookstep.panel.authority import AuthorityState
from lookstep.panel.snapshot import Snapshot
from skills.body_path import BodyPath, Goal
from skills.footsteps import FootstepPlan
from skills.footsteps.rejections import in_percent
from skills.height_map import HeightMap
from skills.regions import PlanarRegions, RegionExtraction

_COLORS = {"running": "#d9961a", "success": "#3c9a5a", "failure": "#b0524c", "idle": "#9a9ea6"}
_HISTORY = 25
_MOST_REASONS = 8


def headline(snapshot: Snapshot, silence: float, authority: AuthorityState) -> str:
    """What is going on, in the few lines that are always in sight.

    Args:
        snapshot: the newest.
        silence: wall time since it came [s].
        authority: who holds control.
    """
    if snapshot.outcome:
        state = f"🏁 **The run has ended:** {_plain(snapshot.outcome)}"
    elif silence > 2.0:
        state = f"⚠️ **Nothing is heard of the robot** for {silence:.0f} s"
    elif snapshot.link_lost:
        state = "⚠️ **The operator's link was lost**"
    elif snapshot.pace.halted:
        state = "⏸ **The simulation stands still**"
    else:
        state = f"**{snapshot.status.phase.value.capitalize()}**"
    waits = "; ".join(snapshot.halts) or waiting_for(snapshot)
    holder = "nobody" if authority.holder is None else f"client {authority.holder}"
    lines = [
        f"{state} · {snapshot.time:.1f} s · {snapshot.rate:.2f} times real time",
        f"{_plain(waits)}" if waits else "goes on",
        f"*Control: {holder}, {len(authority.clients)} connected*",
    ]
    if snapshot.paused:
        lines.insert(1, "⏸ **Paused by the operator**")
    return "\n\n".join(lines)


def waiting_for(snapshot: Snapshot) -> str:
    """The reason of the deepest node that runs and says something."""
    running = [node for node in snapshot.nodes if node.status == "running" and node.visited and node.reason]
    depths = snapshot.stage.depths
    return max(running, key=lambda node: depths[node.path]).reason if running else ""


def describe_request(request: ReviewRequest | None) -> str:
    """What waits for approval, and what comes of each answer."""
    if request is None:
        return "Nothing waits for approval."
    item = request.item
    if isinstance(item, BodyPath):
        x, y, yaw = item.waypoints_world[-1]
        return (
            f"### Body path {request.item_id} waits\n\n"
            f"{item.length:.2f} m to x {x:.2f} m, y {y:.2f} m, yaw {yaw:.2f} rad.\n\n"
            "**Approve**: the robot plans footsteps along it. **Reject**: the path is planned again."
        )
    if isinstance(item, FootstepPlan):
        rows = [
            f"| {step.side.value} | {step.T_world_sole.p[0]:.2f} | {step.T_world_sole.p[1]:.2f} "
            f"| {step.T_world_sole.p[2]:.2f} | {1e3 * step.margin:.0f} |"
            for step in item.steps
        ]
        return "\n".join(
            (
                f"### Footstep plan {request.item_id} waits",
                "",
                f"{item.outcome.value.replace('_', ' ')}: {_plain(item.reason) or 'as asked'}",
                "",
                "| foot | x [m] | y [m] | z [m] | margin [mm] |",
                "|---|---|---|---|---|",
                *rows,
                "",
                f"**Approve**: the robot takes {len(rows)} steps, and plans again while the first foot swings. "
                "**Reject**: it stands and plans again from here. The ghost walks the plan.",
            )
        )
    return f"### {_plain(request.checkpoint)} {request.item_id} waits"


def figures(snapshot: Snapshot) -> str:
    """What the robot knows, and how it does."""
    regions, heights, goal = snapshot.value(PlanarRegions), snapshot.value(HeightMap), snapshot.value(Goal)
    plan, extraction = snapshot.value(FootstepPlan), snapshot.value(RegionExtraction)
    error = f"{1e3 * snapshot.balance.dcm_error:.0f} mm" if snapshot.balance is not None else "-"
    rows = [
        ("steps taken", str(snapshot.steps)),
        ("DCM error", error),
        ("regions", "-" if regions is None else f"{len(regions.regions)}, {snapshot.time - regions.time:.2f} s old"),
        ("depth frame", "-" if extraction is None else f"{extraction.regions.frame_id}"),
        ("height map", "-" if heights is None else f"{snapshot.time - heights.time:.2f} s old"),
        ("goal", "none" if goal is None else str(goal)),
        ("plan", "-" if plan is None else f"{plan.plan_id}: {len(plan.steps)} steps, {_plain(plan.outcome.value)}"),
        ("plan log", f"`{snapshot.stage.plan_log}`" if snapshot.stage.plan_log else "not kept (`--plans DIR`)"),
    ]
    return "\n".join(("| | |", "|---|---|", *(f"| {name} | {value} |" for name, value in rows)))


def rejections(snapshot: Snapshot) -> str:
    """Why the newest plan's search rejected edges, in percent."""
    plan = snapshot.value(FootstepPlan)
    shares = () if plan is None else in_percent(plan.rejections)[:_MOST_REASONS]
    rows = [f"| {_plain(reason)} | {share:.3g} |" for reason, share in shares]
    return "\n".join(("| rejected edges | % |", "|---|---|", *(rows or ["| none | |"])))


def history(lines: tuple[LogLine, ...]) -> str:
    """The last lines, newest first."""
    rows = [
        f"<div{_level(line)}><b>{line.time:.2f}</b> {html.escape(_leaf(line.path) + _first_line(line.text))}</div>"
        for line in reversed(lines[-_HISTORY:])
    ]
    return f'<div style="font-size:0.75em;line-height:1.35;padding:0 0.8em">{"".join(rows)}</div>'


def tree(snapshot: Snapshot) -> str:
    """The tree with the states of its nodes, and what they say."""
    rows = []
    for node in snapshot.nodes:
        color = _COLORS[node.status if node.visited else "idle"]
        name, depth = html.escape(node.path.rpartition("/")[2]), snapshot.stage.depths[node.path]
        reason = f" <i>{html.escape(node.reason)}</i>" if node.reason and node.visited else ""
        rows.append(
            f'<div style="padding-left:{0.7 * depth:.1f}em"><b style="color:{color}">● {name}</b>{reason}</div>'
        )
    return f'<div style="font-size:0.72em;line-height:1.3;padding:0 0.8em">{"".join(rows)}</div>'


def _level(line: LogLine) -> str:
    return "" if line.level == "info" else ' style="color:#b0524c"'


def _leaf(path: str) -> str:
    name = path.rpartition("/")[2]
    return f"{name}: " if name else ""


def _first_line(text: str) -> str:
    return text.splitlines()[0] if text else ""


def _plain(text: str) -> str:
    """Text that Markdown takes for nothing else."""
    return html.escape(text).replace("|", "\\|").replace("*", "\\*").replace("_", "\\_").replace("[", "\\[")
