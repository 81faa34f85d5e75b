"""The tab "State": figures, plots of planning times and balance, rejections, impassability and the history in words."""

from __future__ import annotations

import numpy as np
from viser import uplot

from behaviors.operator import SwitchImpassability
from lookstep.panel import words
from lookstep.panel.desk import Desk
from lookstep.panel.snapshot import Snapshot

_PERIOD = 0.5  # robot time between two updates of the plots [s]
_PLOT_HEIGHT = 150
_PLANNED = "PlanFootsteps"
_IMPASSABILITY = "impassability"


class StateTab:
    """Widgets to see how it goes; made inside the tab's context.

    Args:
        desk: where the switch puts what it says.
    """

    def __init__(self, desk: Desk) -> None:
        gui = desk.server.gui
        self._next_plots = -np.inf
        self._figures = gui.add_markdown("")
        self._halts = None
        if _IMPASSABILITY in desk.snapshot.parameters:
            hint = "Halt for what stands in the way, or leave that to the operator."
            self._halts = gui.add_checkbox("Stop for what is in the way", True, hint=hint)
            desk.on_change(self._halts, lambda halts: desk.send_event(SwitchImpassability(bool(halts))))
        empty = np.zeros(1)
        self._times = gui.add_uplot(
            (empty, empty, empty),
            (uplot.Series(label="s"), _series("plan [ms]", "#2a78d6"), _series("budget [ms]", "#dc4646")),
            title="Planning time against its budget",
            scales={"x": uplot.Scale(time=False)},
            height=_PLOT_HEIGHT,
        )
        self._errors = gui.add_uplot(
            (empty, empty),
            (uplot.Series(label="s"), _series("DCM error [mm]", "#c43cae")),
            title="DCM error",
            scales={"x": uplot.Scale(time=False)},
            height=_PLOT_HEIGHT,
        )
        self._rejections = gui.add_markdown("")
        with gui.add_folder("History"):
            self._history = gui.add_html("")

    def update(self, snapshot: Snapshot) -> None:
        """Show a moment; unchanged texts are not sent again."""
        self._figures.content = words.figures(snapshot)
        self._rejections.content = words.rejections(snapshot)
        self._history.content = words.history(snapshot.lines)
        if self._halts is not None:
            self._halts.value = bool(snapshot.parameters[_IMPASSABILITY].halts)
        if not self._next_plots - _PERIOD <= snapshot.time < self._next_plots:
            self._next_plots = snapshot.time + _PERIOD
            self._plot(snapshot)

    def _plot(self, snapshot: Snapshot) -> None:
        plans = [time for time in snapshot.times if time.kind == _PLANNED]
        if plans:
            columns = [(plan.time, 1e3 * plan.used, 1e3 * plan.budget) for plan in plans]
            self._times.data = tuple(np.array(columns).T.copy())
        if snapshot.dcm_errors:
            times, errors = np.array(snapshot.dcm_errors).T
            self._errors.data = (times.copy(), 1e3 * errors)


def _series(label: str, color: str) -> uplot.Series:
    return uplot.Series(label=label, stroke=color, width=2)
