"""The layout in which a recording opens: the walk in 3D, what the robot sees, its tree, its timing, its reasons."""

from __future__ import annotations

from collections.abc import Sequence

import rerun.blueprint as rrb

TIMELINE = "robot_time"


def default_blueprint(start: tuple[float, float], cameras: Sequence[str], film: bool = False) -> rrb.Blueprint:
    """The layout for a walk that starts at (x, y) in the world [m], with a film beside it where there is one."""
    scene = _scene(
        "Walk",
        ["/world/**", "- /world/around/**"],
        rrb.EyeControls3D(
            kind=rrb.components.Eye3DKind.Orbital,
            position=(start[0] - 0.8, start[1] - 2.0, 1.7),
            look_target=(start[0] + 0.3, start[1], 0.8),
            tracking_entity="/world/robot/pelvis",
        ),
    )
    around = _scene(
        "Heights around",
        ["/world/around/**", "/world/robot/**", "/world/path", "/world/goal"],
        rrb.EyeControls3D(
            kind=rrb.components.Eye3DKind.Orbital,
            position=(start[0] - 2.0, start[1] - 3.0, 3.0),
            look_target=(start[0] + 1.0, start[1], 0.3),
            tracking_entity="/world/robot/pelvis",
        ),
    )
    scenes: list[rrb.View] = [scene, around]
    if film:
        scenes.append(rrb.Spatial2DView(name="Film", origin="/film"))
    tree = rrb.Tabs(
        rrb.StateTimelineView(name="Behavior tree", origin="/tree"),
        rrb.StateTimelineView(name="Deadlines", origin="/deadlines"),
    )
    eyes = rrb.Horizontal(
        rrb.Tabs(*(rrb.Spatial2DView(name=f"Regions, {name}", origin=f"/camera/{name}/regions") for name in cameras)),
        rrb.Tabs(
            *(rrb.Spatial2DView(name=f"Depth, {name}", origin=f"/camera/{name}/depth") for name in cameras),
            *(rrb.TextDocumentView(name=f"Rejected, {name}", origin=f"/camera/{name}/rejected") for name in cameras),
            rrb.TextDocumentView(name="Map", origin="/map"),
            rrb.Spatial2DView(name="Height map", origin="/height_map"),
        ),
    )
    plots = rrb.Tabs(
        rrb.TimeSeriesView(name="Planning time [ms]", origin="/timing/PlanFootsteps"),
        rrb.TimeSeriesView(name="Region time [ms]", origin="/timing/ExtractRegions"),
        rrb.TimeSeriesView(name="Margins [ms]", origin="/margins"),
        rrb.TimeSeriesView(name="Noise at 1 m [mm]", origin="/noise"),
        rrb.TimeSeriesView(name="Drift [mm]", origin="/drift"),
        name="Plots",
    )
    control = rrb.Tabs(
        rrb.TimeSeriesView(name="Sideways [m]", origin="/control/lateral"),
        rrb.TimeSeriesView(name="Forward of the CoM [m]", origin="/control/forward"),
        rrb.TimeSeriesView(name="Errors of DCM and CoP [mm]", origin="/control/errors"),
        rrb.StateTimelineView(name="Contacts", origin="/contacts"),
        rrb.TimeSeriesView(name="Foot forces [N]", origin="/control/forces"),
        rrb.TimeSeriesView(name="Angular momentum [N m s]", origin="/control/momentum"),
        rrb.TimeSeriesView(name="Leg torques [% of limit]", origin="/control/torques/legs"),
        rrb.TimeSeriesView(name="Body torques [% of limit]", origin="/control/torques/body"),
        rrb.TimeSeriesView(name="Quadratic program", origin="/control/qp"),
        name="Balance",
    )
    reasons = rrb.Tabs(
        rrb.TextLogView(name="Reasons", origin="/log"),
        rrb.TextDocumentView(name="About this run", origin="/about"),
    )
    return rrb.Blueprint(
        rrb.Horizontal(
            rrb.Vertical(rrb.Tabs(*scenes, active_tab=0), tree, row_shares=[3, 2]),
            rrb.Vertical(eyes, control, plots, reasons, row_shares=[3, 3, 2, 2]),
            column_shares=[3, 2],
        ),
        rrb.BlueprintPanel(state="collapsed"),
        rrb.SelectionPanel(state="collapsed"),
        rrb.TimePanel(state="collapsed", timeline=TIMELINE),
        auto_views=False,
    )


def _scene(name: str, contents: list[str], eye_controls: rrb.EyeControls3D) -> rrb.Spatial3DView:
    return rrb.Spatial3DView(
        name=name,
        origin="/world",
        contents=contents,
        background=rrb.Background(color=(208, 216, 226, 255)),
        line_grid=rrb.LineGrid3D(visible=False),
        eye_controls=eye_controls,
    )
