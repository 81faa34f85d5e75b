"""What a run tells in the terminal: a progress bar while it walks, a table of figures at the end."""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from types import TracebackType

from rich.console import Console
from rich.progress import BarColumn, TextColumn, TimeElapsedColumn
from rich.progress import Progress as Bar
from rich.table import Table

from lookstep.control_health import ControlFigures
from lookstep.deadlines import LeafDeadlines
from lookstep.moment import Moment
from lookstep.options import RunOptions
from lookstep.summary import Outcome, SkillTiming, Summary
from skills.walking import StepEventKind

_NONE = "-"


class Progress:
    """An observer that shows how far the robot has come; the bar counts the way to the goal."""

    def __init__(self) -> None:
        self._console = Console(stderr=True)
        columns = (
            TextColumn("{task.description}"),
            BarColumn(),
            TextColumn("{task.fields[state]}"),
            TimeElapsedColumn(),
        )
        self._bar = Bar(*columns, console=self._console, transient=True)
        self._task = self._bar.add_task("preparing", total=None, state="compiling or loading kernels")
        self._steps = 0
        self._rest_at_start = 0.0

    def __enter__(self) -> Progress:
        self._bar.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._bar.stop()

    @contextmanager
    def aside(self) -> Iterator[None]:
        """Take the bar away while the terminal is used otherwise."""
        self._bar.stop()
        try:
            yield
        finally:
            self._bar.start()

    def observe(self, moment: Moment) -> None:
        """Move the bar."""
        self._steps += sum(event.kind is StepEventKind.COMPLETED for event in moment.events)
        goal, feet = moment.world.course.goal, moment.state.stance.mid_feet
        rest = math.hypot(goal[0] - feet[0], goal[1] - feet[1])
        self._rest_at_start = max(self._rest_at_start, rest)
        state = f"{self._steps} steps, {rest:.1f} m to go, robot time {moment.time:.0f} s  {moment.tree.root.reason}"
        done = self._rest_at_start - rest
        self._bar.update(self._task, description="walking", total=self._rest_at_start, completed=done, state=state[:90])


def print_summary(summary: Summary, options: RunOptions) -> None:
    """Print the figures of a run, and where its files are."""
    console = Console()
    color = "green" if summary.outcome is Outcome.GOAL_REACHED else "red"
    title = f"[bold {color}]{summary.outcome.value}[/]: {summary.reason}"
    table = Table(title=title, title_justify="left", show_header=False, box=None, padding=(0, 2))
    for name, value in _rows(summary):
        table.add_row(f"[dim]{name}[/]", value)
    console.print(table)
    if summary.deadlines:
        console.print(_deadlines(summary.deadlines))
    if options.out is not None:
        console.print(f"[dim]summary  [/] {options.out / 'summary.json'}")
    if options.record is not None:
        console.print(f"[dim]recording[/] {options.record}   (open it: ./run rerun {options.record})")


def _deadlines(accounts: tuple[LeafDeadlines, ...]) -> Table:
    """One line a leaf that computes: budget, use, margin, and what was left of the swing."""
    title = "[bold]deadlines[/] [dim]in ms; landing: s left of the swing, at least[/]"
    table = Table(title=title, title_justify="left", box=None)
    for column in ("leaf", "count", "budget", "median", "p99", "least margin", "missed", "landing"):
        table.add_column(
            column, justify="left" if column == "leaf" else "right", style="dim" if column == "leaf" else ""
        )
    for leaf in accounts:
        landing = _NONE if leaf.landing_s_least is None else f"{leaf.landing_s_least:.2f}"
        cells = (leaf.budget_ms, leaf.used_ms_median, leaf.used_ms_p99, leaf.margin_ms_least)
        numbers = [_NONE if cell is None else f"{cell:.1f}" for cell in cells]
        missed = f"{leaf.misses + leaf.late}"
        table.add_row(leaf.leaf.rpartition("/")[2], str(leaf.count), *numbers, missed, landing)
    return table


def _rows(summary: Summary) -> list[tuple[str, str]]:
    steps, pauses = summary.steps, summary.pauses
    causes = ", ".join(f"{cause} {count}" for cause, count in pauses.causes.items())
    return [
        ("course", f"{summary.course}, seed {summary.seed}"),
        ("walked", f"{summary.distance_m:.2f} m in {summary.duration_s:.1f} s: {summary.speed_mps:.3f} m/s"),
        ("wall time", f"{summary.wall_s:.1f} s, {summary.real_time_factor:.1f} x real time"),
        ("steps", f"{steps.total}: flat {steps.flat}, uneven flat {steps.uneven_flat}, rough {steps.rough}, "
                  f"ramp {steps.ramp}, reactive {steps.reactive}"),
        ("pauses", f"{pauses.count}, {pauses.total_s:.1f} s" + (f" ({causes})" if causes else "")),
        ("first step after", _number(summary.first_step_after_s, " s")),
        ("planning", _timing(summary.plan)),
        ("regions", _timing(summary.regions)),
        ("least support", _number(summary.min_support_fraction, " of a sole")),
        ("plans in view", _number(summary.view_fraction)),
        ("foothold error", _number(summary.foothold_error_m and 1e3 * summary.foothold_error_m, " mm")),
        ("control", _control(summary.control)),
        ("trace", summary.trace_hash),
    ]  # fmt: skip


def _control(control: ControlFigures) -> str:
    cop = "" if control.cop_error_p99_m is None else f", CoP error p99 {1e3 * control.cop_error_p99_m:.0f} mm"
    return (
        f"{control.ticks} ticks, {control.qp_failed} without a solution, {control.cop_alarms} CoP alarms{cop}, "
        f"DCM error up to {1e2 * control.dcm_error_max_m:.1f} cm, torque up to {control.torque_share_max:.0%}"
    )


def _timing(timing: SkillTiming) -> str:
    if timing.median_ms is None or timing.p99_ms is None:
        return _NONE
    return (
        f"{timing.count} x median {timing.median_ms:.1f} ms, p99 {timing.p99_ms:.1f} ms, "
        f"{timing.deadline_misses} over the budget of {timing.budget_ms:.0f} ms"
    )


def _number(value: float | None, unit: str = "") -> str:
    return _NONE if value is None else f"{value:.2f}{unit}"
